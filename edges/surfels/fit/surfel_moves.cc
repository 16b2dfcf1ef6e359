// SPDX-License-Identifier: MIT
#include "edges/surfels/fit/surfel_moves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "datasets/types/degree.h"
#include "datasets/types/parallel.h"
#include "edges/surfels/model/surfel_shading.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kHalf = 3, kSide = 2 * kHalf + 1, kPixels = kSide * kSide;  // of a patch
constexpr double kSteps[] = {1, 2, 4};  // [px] between its samples; the first that show something
constexpr double kContrast = 0.02;      // standard deviation of greys that is something
constexpr double kNoise = 0.01;         // of a grey
constexpr double kNearest = 3 * kDegree, kFarthest = 60 * kDegree;  // between views compared
constexpr double kGrazing = 0.15;              // cosine below which a view says nothing of a plane
constexpr int kFewest = 3;                     // views that agree
constexpr float kInside = 0.9f;                // alpha of a patch's pixels
constexpr float kShown = 0.5f;                 // [px] of a surfel in the view that shows most of it
constexpr double kSamePx = 0.5, kSameDeg = 5;  // within which two planes need not both be tried

struct Plane {
  Vector3d point, normal;
};

using Greys = std::array<float, kPixels>;

struct Patch {
  Greys grey;
  std::array<Vector3d, kPixels> ray;  // in the world, of one step along the axis
};

bool sample(const Image<float>& image, double px, double py, float* value) {
  if (!(px >= 0 && py >= 0 && px < image.width - 1 && py < image.height - 1)) return false;
  const int x = int(px), y = int(py);
  const float u = float(px - x), v = float(py - y);
  const float *a = image.row(y) + x, *b = image.row(y + 1) + x;
  *value = (1 - v) * ((1 - u) * a[0] + u * a[1]) + v * ((1 - u) * b[0] + u * b[1]);
  return true;
}

double correlation(const Greys& a, const Greys& b) {
  double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (int k = 0; k < kPixels; ++k) {
    ma += a[k], mb += b[k];
    aa += a[k] * a[k], bb += b[k] * b[k], ab += a[k] * b[k];
  }
  ma /= kPixels, mb /= kPixels;
  constexpr double floor = kNoise * kNoise;
  const double va = aa / kPixels - ma * ma + floor, vb = bb / kPixels - mb * mb + floor;
  return (ab / kPixels - ma * mb) / std::sqrt(va * vb);
}

// Compares the pictures on planes.
class Judge {
 public:
  explicit Judge(const std::vector<SurfelTarget>& targets) : targets_(targets) {
    for (const SurfelTarget& t : targets) {
      Image<float> grey = t.view.color[0];
      for (size_t i = 0; i < grey.data.size(); ++i)
        grey.data[i] = (grey.data[i] + t.view.color[1].data[i] + t.view.color[2].data[i]) / 3;
      grey_.push_back(std::move(grey));
      eye_.push_back(t.view.view.center_in_world());
      const Camera& c = t.view.view.camera;
      Matrix3d K;
      K << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
      pixel_from_world_.push_back(K * t.view.view.cam_from_world.rotation);
    }
  }

  // About the surfel, as the view `home` shows it; false if there is nothing to see.
  bool take_patch(int home, const Vector3d& point, Patch* patch) const {
    const View& view = targets_[home].view.view;
    double z;
    const Vector2d q = view.project(point, &z);
    const Matrix3d back = view.cam_from_world.rotation.transpose();
    for (const double step : kSteps) {
      double sum = 0, squares = 0;
      for (int k = 0; k < kPixels; ++k) {
        const Vector2d at = q + step * Vector2d(k % kSide - kHalf, k / kSide - kHalf);
        float alpha;
        if (!sample(targets_[home].view.alpha, at.x(), at.y(), &alpha) || alpha < kInside)
          return false;  // an outline is contrast of another kind
        sample(grey_[home], at.x(), at.y(), &patch->grey[k]);
        patch->ray[k] = back * view.camera.ray(at);
        sum += patch->grey[k], squares += patch->grey[k] * patch->grey[k];
      }
      const double mean = sum / kPixels;
      if (squares / kPixels - mean * mean > kContrast * kContrast) return true;
    }
    return false;
  }

  // The views beside `home`, the nearest first.
  std::vector<int> beside(int home, const Vector3d& point, int count) const {
    std::vector<std::pair<double, int>> near;
    const Vector3d a = (eye_[home] - point).normalized();
    for (int v = 0; v < int(eye_.size()); ++v) {
      const double angle = std::acos(std::min(1.0, a.dot((eye_[v] - point).normalized())));
      if (angle > kNearest && angle < kFarthest) near.push_back({angle, v});
    }
    std::sort(near.begin(), near.end());
    if (int(near.size()) > count) near.resize(count);
    std::vector<int> views;
    for (const auto& [angle, v] : near) views.push_back(v);
    return views;
  }

  // Where the ray to the surfel meets the plane of another; false if that is nowhere it may lie.
  bool meet(int home, const Vector3d& point, const Plane& other, Plane* there) const {
    const Vector3d ray = point - eye_[home];
    const double down = ray.dot(other.normal);
    if (!(down < -kGrazing * ray.norm())) return false;
    const double t = (other.point - eye_[home]).dot(other.normal) / down;
    *there = {eye_[home] + t * ray, other.normal};
    return t > 0;
  }

  bool in_all_masks(const Vector3d& p) const {
    for (const SurfelTarget& t : targets_) {
      double z;
      float alpha;
      const Vector2d q = t.view.view.project(p, &z);
      if (!(z > 0) || !sample(t.view.alpha, q.x(), q.y(), &alpha) || alpha < 0.5f) return false;
    }
    return true;
  }

  // In [-1, 1]; -1 if too few views can tell.
  double agreement(int home, const Patch& patch, const Plane& plane,
                   const std::vector<int>& views) const {
    const double off = (plane.point - eye_[home]).dot(plane.normal);
    for (const Vector3d& ray : patch.ray)
      if (!(plane.normal.dot(ray) < 0)) return -1;
    std::vector<double> each;
    for (const int v : views) {
      const Vector3d to = eye_[v] - plane.point;
      if (to.dot(plane.normal) < kGrazing * to.norm()) continue;
      // The homography that the plane makes of both pictures, from rays: its third row is < 0
      // before the camera, for normals face the rays.
      const Matrix3d H = pixel_from_world_[v] * ((eye_[home] - eye_[v]) * plane.normal.transpose() +
                                                 off * Matrix3d::Identity());
      Greys seen;
      bool all = true;
      for (int k = 0; k < kPixels && all; ++k) {
        const Vector3d q = H * patch.ray[k];
        all = q.z() < 0 && sample(grey_[v], q.x() / q.z(), q.y() / q.z(), &seen[k]);
      }
      if (all) each.push_back(correlation(patch.grey, seen));
    }
    if (int(each.size()) < kFewest) return -1;
    const int half = std::max(kFewest, int(each.size() + 1) / 2);
    std::partial_sort(each.begin(), each.begin() + half, each.end(), std::greater<double>());
    double sum = 0;
    for (int k = 0; k < half; ++k) sum += each[k];
    return sum / half;
  }

 private:
  const std::vector<SurfelTarget>& targets_;
  std::vector<Image<float>> grey_;
  std::vector<Vector3d> eye_;
  std::vector<Matrix3d> pixel_from_world_;  // of directions
};

// Per surfel the view that shows most of it, or -1.
std::vector<int> homes_of(const std::vector<SurfelTarget>& targets, const SurfelOptions& drawing,
                          const SurfelSet& set) {
  const SurfelCloud cloud = set.cloud(Eigen::Matrix3Xd::Zero(3, set.size()));
  std::vector<std::vector<float>> shown(targets.size());
  parallel_for(int(targets.size()), 1, [&](int v) {
    SurfelRenderer renderer(drawing);
    const View& view = targets[v].view.view;
    std::vector<int> facing;
    renderer.forward(facing_surfels(cloud, view, &facing), view, targets[v].mask);
    const SurfelInfluence influence = renderer.influence();
    shown[v].assign(set.size(), 0);
    for (size_t f = 0; f < facing.size(); ++f)
      for (int k = influence.first[f]; k < influence.first[f + 1]; ++k)
        shown[v][facing[f]] += influence.weight[k];
  });
  std::vector<int> home(set.size(), -1);
  for (int i = 0; i < set.size(); ++i) {
    float most = kShown;
    for (int v = 0; v < int(targets.size()); ++v)
      if (shown[v][i] > most) most = shown[v][i], home[i] = v;
  }
  return home;
}

// Is a plane, at the same ray, as good as one of these? `footprint`: of a pixel there.
bool known(const Plane& plane, const std::vector<Plane>& tried, double footprint) {
  static const double cosine = std::cos(kSameDeg * kDegree);
  return std::any_of(tried.begin(), tried.end(), [&](const Plane& t) {
    return t.normal.dot(plane.normal) > cosine &&
           (t.point - plane.point).norm() < kSamePx * footprint;
  });
}

// The plane of `others` on which the pictures agree better than on the surfel's own, if any.
bool best_plane(const Judge& judge, int home, const Plane& own, const std::vector<Plane>& others,
                double footprint, const MoveOptions& options, Plane* best) {
  Patch patch;
  if (!judge.take_patch(home, own.point, &patch)) return false;
  const std::vector<int> views = judge.beside(home, own.point, options.sources);
  double most = std::max(0.0, judge.agreement(home, patch, own, views)) + options.gain;
  if (most >= 1) return false;
  bool found = false;
  std::vector<Plane> tried = {own};
  for (const Plane& other : others) {
    Plane there;
    if (!judge.meet(home, own.point, other, &there) || known(there, tried, footprint) ||
        !judge.in_all_masks(there.point))
      continue;
    tried.push_back(there);
    const double agreement = judge.agreement(home, patch, there, views);
    if (agreement > most) most = agreement, *best = there, found = true;
  }
  return found;
}

Plane plane_of(const SurfelSet& set, int i) {
  return {set.center(i), set.normal(i)};
}

}  // namespace

std::vector<int> move_surfels(const std::vector<SurfelTarget>& targets,
                              const SurfelOptions& drawing, double spacing,
                              const MoveOptions& options, SurfelSet* set) {
  const Judge judge(targets);
  const std::vector<int> home = homes_of(targets, drawing, *set);
  const int n = set->size();
  std::vector<char> moved(n, 0), fresh(n, 1);  // at all; in the last round
  for (int round = 0; round < options.rounds; ++round) {
    std::vector<std::vector<int>> near(n);
    for (const auto& [i, j] :
         neighbour_pairs(*set, options.neighbours, options.reach * spacing, 180)) {
      // What has not moved has seen the planes that have not.
      if (fresh[i] || fresh[j]) near[i].push_back(j), near[j].push_back(i);
    }
    std::vector<Plane> plane(n);
    std::vector<char> now(n, 0);
    parallel_for(n, 16, [&](int i) {
      if (home[i] < 0 || near[i].empty()) return;
      std::vector<Plane> others;
      for (const int j : near[i]) others.push_back(plane_of(*set, j));
      now[i] = best_plane(judge, home[i], plane_of(*set, i), others, targets[home[i]].footprint,
                          options, &plane[i]);
    });
    for (int i = 0; i < n; ++i) {
      if (!now[i]) continue;
      moved[i] = 1;
      set->values.col(i).segment<3>(SurfelSet::kCenter) = plane[i].point;
      set->values.col(i).segment<4>(SurfelSet::kRotation) = rotation_to(plane[i].normal);
    }
    if (std::find(now.begin(), now.end(), 1) == now.end()) break;
    fresh = std::move(now);
  }
  std::vector<int> out;
  for (int i = 0; i < n; ++i)
    if (moved[i]) out.push_back(i);
  return out;
}

}  // namespace sketchsplat
