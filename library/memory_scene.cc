// SPDX-License-Identifier: MIT
#include "library/memory_scene.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "datasets/types/errors.h"
#include "edges/image/undistort.h"

namespace sketchsplat {
namespace {

constexpr double kRotationError = 1e-3;  // of R^T R
constexpr double kStep = 1.0;            // [px] between the edgels of a polyline
constexpr double kTangentReach = 2.0;    // [px] to either side, for its direction
constexpr int kMinChain = 6;             // [px] shorter edges are dropped

std::string name_of_view(const InputView& view, size_t i) {
  return view.name.empty() ? "view_" + std::to_string(i) : view.name;
}

Lens lens_of(const InputView& v, const std::string& name) {
  const std::vector<double>& d = v.distortion;
  if (d.empty()) return Lens();
  LensTerms<double> k;
  if (v.fisheye) {
    if (d.size() != 4)
      throw std::invalid_argument(name + ": expected four parameters of a fisheye, found " +
                                  std::to_string(d.size()));
    k.k1 = d[0], k.k2 = d[1], k.k3 = d[2], k.k4 = d[3];
    return Lens(LensModel::kOpencvFisheye, k);
  }
  if (d.size() != 4 && d.size() != 5 && d.size() != 8)
    throw std::invalid_argument(name + ": expected 4, 5 or 8 parameters of a lens, found " +
                                std::to_string(d.size()));
  double* const terms[] = {&k.k1, &k.k2, &k.p1, &k.p2, &k.k3, &k.k4, &k.k5, &k.k6};
  for (size_t i = 0; i < d.size(); ++i) *terms[i] = d[i];
  return Lens(d.size() == 4 ? LensModel::kOpencv : LensModel::kFullOpencv, k);
}

Image<float> plane(const std::uint8_t* data, int width, int height, std::ptrdiff_t row_bytes,
                   int channels, int channel) {
  Image<float> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out.at(x, y) = data[y * row_bytes + x * channels + channel] / 255.0f;
  return out;
}

Image<float> mask_of(const InputView& v) {
  return plane(v.mask, v.width, v.height, v.mask_row_bytes ? v.mask_row_bytes : v.width, 1, 0);
}

Picture picture_of(const InputView& v) {
  const std::ptrdiff_t row = v.row_bytes ? v.row_bytes : std::ptrdiff_t(v.width) * v.channels;
  const auto channel = [&](int c) {
    return plane(v.pixels, v.width, v.height, row, v.channels, c);
  };
  Picture picture;
  picture.red = channel(0);
  picture.green = v.channels > 1 ? channel(1) : picture.red;
  picture.blue = v.channels > 1 ? channel(2) : picture.red;
  if (v.mask)
    picture.alpha = mask_of(v);
  else if (v.channels == 4)
    picture.alpha = channel(3);
  return picture;
}

// A point at a length along a polyline; it goes on straight beyond its ends.
class Walk {
 public:
  explicit Walk(const Eigen::Matrix2Xd& points) {
    for (int i = 0; i < points.cols(); ++i) {
      const Eigen::Vector2d p = points.col(i);
      const double step = points_.empty() ? 0 : (p - points_.back()).norm();
      if (!points_.empty() && !(step > 0)) continue;
      at_.push_back(at_.empty() ? 0 : at_.back() + step);
      points_.push_back(p);
    }
  }
  double length() const { return at_.empty() ? 0 : at_.back(); }
  Eigen::Vector2d at(double s) const {
    size_t i = size_t(std::upper_bound(at_.begin(), at_.end(), s) - at_.begin());
    i = std::clamp<size_t>(i, 1, at_.size() - 1);
    const double share = (s - at_[i - 1]) / (at_[i] - at_[i - 1]);
    return points_[i - 1] + share * (points_[i] - points_[i - 1]);
  }

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> at_;
};

class GivenEdges : public Detector {
 public:
  explicit GivenEdges(const std::vector<InputView>& views) {
    for (size_t i = 0; i < views.size(); ++i) views_[name_of_view(views[i], i)] = &views[i];
  }
  EdgelMap detect(const Scene&, const View& view) const override {
    const InputView& v = *views_.at(view.name);
    EdgelMap map;
    map.width = v.width, map.height = v.height;
    map.chain.push_back(0);
    for (const Eigen::Matrix2Xd& edge : v.edges) add(edge, &map);
    if (v.mask) {
      const Image<float> mask = mask_of(v);
      map.mask = Image<std::uint8_t>(v.width, v.height);
      for (size_t i = 0; i < mask.data.size(); ++i) map.mask.data[i] = mask.data[i] >= 0.5f;
    }
    return undistort_edgels(std::move(map), view, kMinChain);
  }

 private:
  static void add(const Eigen::Matrix2Xd& edge, EdgelMap* map) {
    if (edge.cols() < 2 || !edge.allFinite()) return;
    const Walk walk(edge);
    if (walk.length() < kMinChain) return;
    const int steps = int(walk.length() / kStep);
    for (int k = 0; k <= steps; ++k) {
      const double s = k * walk.length() / steps;
      const Eigen::Vector2d p = walk.at(s);
      const Eigen::Vector2d t = walk.at(std::min(s + kTangentReach, walk.length())) -
                                walk.at(std::max(0., s - kTangentReach));
      if (!(t.norm() > 0) || p.x() < 0 || p.y() < 0 || p.x() > map->width - 1 ||
          p.y() > map->height - 1) {
        end_chain(map);
        continue;
      }
      Edgel e;
      e.x = float(p.x()), e.y = float(p.y());
      e.nx = float(-t.y() / t.norm()), e.ny = float(t.x() / t.norm());
      e.strength = e.width = 1;
      map->edgels.push_back(e);
    }
    end_chain(map);
  }
  static void end_chain(EdgelMap* map) {
    const int begin = map->chain.back(), end = int(map->edgels.size());
    if (end - begin < kMinChain)
      map->edgels.resize(begin);
    else
      map->chain.push_back(end);
  }

  std::map<std::string, const InputView*> views_;
};

View view_of(const InputView& v, const std::string& name) {
  if (v.width <= 0 || v.height <= 0)
    throw std::invalid_argument(name + ": expected a size in pixels, found " +
                                std::to_string(v.width) + " x " + std::to_string(v.height));
  const Eigen::Matrix3d& K = v.intrinsics;
  if (!K.allFinite() || !(K(0, 0) > 0) || !(K(1, 1) > 0) || K(0, 1) != 0 || K(1, 0) != 0)
    throw std::invalid_argument(name + ": expected intrinsics fx 0 cx; 0 fy cy; 0 0 1");
  const Eigen::Matrix3d& R = v.rotation;
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off < kRotationError) || !(R.determinant() > 0) || !v.translation.allFinite())
    throw std::invalid_argument(name + ": expected a rotation and a translation, found none");
  if (v.pixels && v.channels != 1 && v.channels != 3 && v.channels != 4)
    throw std::invalid_argument(name + ": expected 1, 3 or 4 channels, found " +
                                std::to_string(v.channels));
  View view;
  view.name = view.image_path = name;
  view.camera = {v.width, v.height, K(0, 0), K(1, 1), K(0, 2), K(1, 2)};
  view.cam_from_world = {R, v.translation};
  view.lens = lens_of(v, name);
  if (v.pixels) view.make_picture = [&v] { return picture_of(v); };
  return view;
}

}  // namespace

Scene scene_of(const std::vector<InputView>& views) {
  Scene scene;
  scene.folder = "views in memory";
  scene.format = "memory";
  std::set<std::string> names;
  for (size_t i = 0; i < views.size(); ++i) {
    const std::string name = name_of_view(views[i], i);
    if (!names.insert(name).second)
      throw std::invalid_argument("expected a name for each view, found " + name + " twice");
    scene.views.push_back(view_of(views[i], name));
  }
  if (scene.views.empty()) throw std::invalid_argument("expected views, found none");
  return scene;
}

std::unique_ptr<Detector> make_given_edges(const std::vector<InputView>& views) {
  return std::make_unique<GivenEdges>(views);
}

}  // namespace sketchsplat
