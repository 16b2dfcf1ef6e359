// SPDX-License-Identifier: MIT
#include "datasets/readers/colmap_write.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <tuple>

namespace sketchsplat {
namespace {

constexpr double kCorner = 0.5;  // COLMAP counts pixels from the corner of the first one

auto key_of(const View& v) {
  const Camera& c = v.camera;
  const Lens::Terms& k = v.lens.terms();
  return std::make_tuple(c.width, c.height, c.fx, c.fy, c.cx, c.cy, int(v.lens.model()), k.k1, k.k2,
                         k.p1, k.p2, k.k3, k.k4, k.k5, k.k6);
}

std::string camera_line(int id, const View& view) {
  const Camera& c = view.camera;
  const Lens::Terms& k = view.lens.terms();
  const bool round = c.fx == c.fy;
  const char* name = "PINHOLE";
  std::vector<double> values = {c.fx, c.fy, c.cx + kCorner, c.cy + kCorner};
  LensModel model = view.lens.model();
  if (!round && (model == LensModel::kSimpleRadial || model == LensModel::kRadial))
    model = LensModel::kOpencv;
  const auto lens = [&](const char* what, std::vector<double> terms) {
    name = what;
    values.insert(values.end(), terms.begin(), terms.end());
  };
  switch (model) {
    case LensModel::kPinhole:
      break;
    case LensModel::kSimpleRadial:
      values.erase(values.begin());
      lens("SIMPLE_RADIAL", {k.k1});
      break;
    case LensModel::kRadial:
      values.erase(values.begin());
      lens("RADIAL", {k.k1, k.k2});
      break;
    case LensModel::kOpencv:
      lens("OPENCV", {k.k1, k.k2, k.p1, k.p2});
      break;
    case LensModel::kFullOpencv:
      lens("FULL_OPENCV", {k.k1, k.k2, k.p1, k.p2, k.k3, k.k4, k.k5, k.k6});
      break;
    case LensModel::kOpencvFisheye:
      lens("OPENCV_FISHEYE", {k.k1, k.k2, k.k3, k.k4});
      break;
  }
  std::string text = std::to_string(id) + " " + name + " " + std::to_string(c.width) + " " +
                     std::to_string(c.height);
  char number[40];
  for (const double value : values) {
    std::snprintf(number, sizeof number, " %.17g", value);
    text += number;
  }
  return text + "\n";
}

}  // namespace

std::vector<int> shared_cameras(const std::vector<View>& views) {
  std::vector<int> camera, first;  // the view that a camera was met in
  for (size_t v = 0; v < views.size(); ++v) {
    const auto same = [&](int other) { return key_of(views[other]) == key_of(views[v]); };
    const auto at = std::find_if(first.begin(), first.end(), same);
    camera.push_back(int(at - first.begin()));
    if (at == first.end()) first.push_back(int(v));
  }
  return camera;
}

ColmapText colmap_text(const std::vector<View>& views, const std::vector<std::string>& sights) {
  ColmapText out;
  out.cameras = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  out.images =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "# POINTS2D[] as (X, Y, POINT3D_ID)\n";
  out.points = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
  const std::vector<int> camera = shared_cameras(views);
  int cameras = 0;
  for (size_t k = 0; k < views.size(); ++k) {
    if (camera[k] == cameras) out.cameras += camera_line(++cameras, views[k]);
    const Eigen::Vector3d& t = views[k].cam_from_world.translation;
    Eigen::Quaterniond q(views[k].cam_from_world.rotation);
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    char pose[320];
    std::snprintf(pose, sizeof pose, "%zu %.17g %.17g %.17g %.17g %.17g %.17g %.17g %d ", k + 1,
                  q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), camera[k] + 1);
    out.images += pose + views[k].name + "\n" + (sights.empty() ? "" : sights[k]) + "\n";
  }
  return out;
}

}  // namespace sketchsplat
