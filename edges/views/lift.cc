// SPDX-License-Identifier: MIT
// Space sweep over edges: Collins, R.: A space-sweep approach to true multi-image matching, CVPR
// 1996; here with the direction of the edge as one more dimension of the vote.
#include "edges/views/lift.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"
#include "edges/views/far_cells.h"

namespace sketchsplat {
namespace {

constexpr int kBins = 8;  // directions of the tangent inside the plane of its edgel, over 180 deg

constexpr double kMatchPx = 1.5;  // largest distance of an edgel that supports a depth
constexpr double kInlierPx = 1;   // the same after the point was refined
// Cells of the hull about what it holds of a ray: silhouettes are coarser than masks.
constexpr double kAroundMasks = 2.5, kAroundSilhouettes = 8;
constexpr double kAngleDeg = 12;    // largest angle of its plane to the tangent
constexpr double kFollowed = 0.8;   // of the views of one point that see the next on its edge
constexpr double kLeastSine = 0.1;  // of a line of sight and the edge along which one goes on
constexpr int kEvery = 3;           // edgels of a chain, one of which is tried at all depths anyway

using Matrix34f = Eigen::Matrix<float, 3, 4>;

Matrix34f projection(const View& view) {
  Eigen::Matrix3d K;
  K << view.camera.fx, 0, view.camera.cx, 0, view.camera.fy, view.camera.cy, 0, 0, 1;
  Eigen::Matrix<double, 3, 4> Rt;
  Rt << view.cam_from_world.rotation, view.cam_from_world.translation;
  return (K * Rt).cast<float>();
}

// Interval of s for which center + s * direction lies in the box; false if there is none.
bool clip(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& center,
          const Eigen::Vector3d& direction, double* s0, double* s1) {
  *s0 = 1e-9, *s1 = 1e300;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) < 1e-12) {
      if (center[k] < box.min()[k] || center[k] > box.max()[k]) return false;
      continue;
    }
    double a = (box.min()[k] - center[k]) / direction[k];
    double b = (box.max()[k] - center[k]) / direction[k];
    if (a > b) std::swap(a, b);
    *s0 = std::max(*s0, a), *s1 = std::min(*s1, b);
  }
  return *s0 < *s1;
}

// One edgel that agrees with a point.
struct Match {
  int view, edgel;
  float weight;
};

class Sweeper {
 public:
  Sweeper(const EdgeWorld& world, const LiftOptions& options) : world_(world), options_(options) {
    for (const View& v : world.views) {
      projection_.push_back(projection(v));
      center_.push_back(v.center_in_world());
    }
    choose_neighbours();
    far_.resize(world.views.size());
    parallel_for(int(far_.size()), 1, [&](int v) { far_[v] = FarCells(world.maps[v]); });
  }

  bool is_sure(const EdgePoint& point) const { return point.views >= 2 * options_.min_views; }
  // The best point on the ray of an edgel; false if too few views agree. Matches: after refinement.
  bool lift(int view, int index, EdgePoint* point, std::vector<Match>* matches) const;
  // The point of an edgel on the edge that goes on from a neighbour's; false if it does not.
  bool follow(const EdgePoint& from, int view, int index, EdgePoint* point,
              std::vector<Match>* matches) const;

 private:
  struct Ray {
    Eigen::Vector3d center, direction, e1, e2;  // plane of the edgel: e1 along the edge, e2 = ray
    double s0, step;
    int count;
  };

  void choose_neighbours();
  bool make_ray(int view, const Edgel& e, Ray* ray) const;
  void vote(int view, int index, int other, const Ray& ray, std::vector<float>* score) const;
  bool refine(int view, int index, Eigen::Vector3d x, Eigen::Vector3d t, EdgePoint* point,
              std::vector<Match>* matches) const;
  void collect(int view, int index, const Eigen::Vector3d& x, const Eigen::Vector3d& t,
               double reach_px, double max_sine, std::vector<Match>* matches) const;

  const EdgeWorld& world_;
  const LiftOptions& options_;
  std::vector<Matrix34f> projection_;
  std::vector<Eigen::Vector3d> center_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<FarCells> far_;
};

void Sweeper::choose_neighbours() {
  const int n = int(world_.views.size());
  const Eigen::Vector3d middle = world_.bounds.center();
  neighbours_.resize(n);
  for (int i = 0; i < n; ++i) {
    std::vector<std::pair<double, int>> by_angle;
    for (int j = 0; j < n; ++j) {
      if (j == i || world_.maps[j].edgels.empty()) continue;
      const double c = (center_[i] - middle).normalized().dot((center_[j] - middle).normalized());
      by_angle.push_back({-c, j});
    }
    std::sort(by_angle.begin(), by_angle.end());
    for (const auto& a : by_angle)
      if (int(neighbours_[i].size()) < options_.sweep_views) neighbours_[i].push_back(a.second);
  }
}

bool Sweeper::make_ray(int view, const Edgel& e, Ray* ray) const {
  const View& v = world_.views[view];
  const Eigen::Matrix3d world_from_cam = v.cam_from_world.rotation.transpose();
  ray->center = center_[view];
  ray->direction = (world_from_cam * v.camera.ray({e.x, e.y})).normalized();
  const Eigen::Vector3d along =
      world_from_cam * Eigen::Vector3d(-e.ny / v.camera.fx, e.nx / v.camera.fy, 0);
  ray->e2 = ray->direction;
  ray->e1 = (along - ray->e2 * ray->e2.dot(along)).normalized();
  double s1;
  if (!clip(world_.bounds, ray->center, ray->direction, &ray->s0, &s1)) return false;
  const double around = world_.silhouettes ? kAroundSilhouettes : kAroundMasks;
  if (!world_.hull.clip(ray->center, ray->direction, around, &ray->s0, &s1)) return false;
  ray->step = world_.footprint;
  ray->count = int(std::min(4095.0, (s1 - ray->s0) / ray->step)) + 1;
  return true;
}

// The first k after this one at which a + k b (homogeneous) lies more than `reach` pixels
// (chessboard) from (u, v), where it is now.
int step_over(const Eigen::Vector3f& a, const Eigen::Vector3f& b, int k, float u, float v,
              float reach) {
  if (reach < 1) return k + 1;
  float next = 1e9f;
  for (const float way : {-reach, reach}) {
    const float at_u = ((u + way) * a.z() - a.x()) / (b.x() - (u + way) * b.z());
    const float at_v = ((v + way) * a.z() - a.y()) / (b.y() - (v + way) * b.z());
    if (at_u > k) next = std::min(next, at_u);
    if (at_v > k) next = std::min(next, at_v);
  }
  return std::max(k + 1, int(next));
}

void Sweeper::vote(int view, int index, int other, const Ray& ray,
                   std::vector<float>* score) const {
  const EdgelMap& map = world_.maps[other];
  const Matrix34f& P = projection_[other];
  const Eigen::Vector3f a =
      P.leftCols<3>() * (ray.center + ray.s0 * ray.direction).cast<float>() + P.col(3);
  const Eigen::Vector3f b = P.leftCols<3>() * (ray.step * ray.direction).cast<float>();
  const Eigen::Vector3f own = world_.plane_normal[view].col(index);
  const Eigen::Vector3f e1 = ray.e1.cast<float>(), e2 = ray.e2.cast<float>();
  const float reach = float(kMatchPx), inv = 1.f / (reach * reach);
  int last = -1;
  float bin = 0, gain = 0;
  for (int k = 0; k < ray.count; ++k) {
    const float z = a.z() + k * b.z();
    if (z <= 0) continue;
    const float u = (a.x() + k * b.x()) / z, v = (a.y() + k * b.y()) / z;
    int j = -far_[other].least_px(u, v) - 1;
    if (j == -1) j = map.nearest_or_far(u, v);
    if (j < 0) {
      k = step_over(a, b, k, u, v, float(-j - 1)) - 1;
      continue;
    }
    const Edgel& e = map.edgels[j];
    const float d = (u - e.x) * e.nx + (v - e.y) * e.ny;
    if (std::abs(d) > reach) continue;
    if (j != last) {  // direction of the line in which the planes of both edgels meet
      last = j;
      const Eigen::Vector3f t = own.cross(Eigen::Vector3f(world_.plane_normal[other].col(j)));
      const float sine = t.norm();
      gain = std::min(1.f, std::max(0.f, (sine - 0.05f) / 0.2f));
      const float angle = std::atan2(t.dot(e2), t.dot(e1));
      bin = (angle < 0 ? angle + float(M_PI) : angle) * float(kBins / M_PI);
    }
    if (gain <= 0) continue;
    const float w = gain * (1 - d * d * inv);
    const int b0 = int(bin) % kBins, b1 = (b0 + 1) % kBins;
    const float f = bin - std::floor(bin);
    (*score)[size_t(k) * kBins + b0] += w * (1 - f);
    (*score)[size_t(k) * kBins + b1] += w * f;
  }
}

void Sweeper::collect(int view, int index, const Eigen::Vector3d& x, const Eigen::Vector3d& t,
                      double reach_px, double max_sine, std::vector<Match>* matches) const {
  matches->clear();
  const Eigen::Vector3f xf = x.cast<float>(), tf = t.cast<float>();
  for (int j = 0; j < int(world_.views.size()); ++j) {
    if (j == view) {
      matches->push_back({view, index, 1.f});
      continue;
    }
    const Eigen::Vector3f q = projection_[j].leftCols<3>() * xf + projection_[j].col(3);
    if (q.z() <= 0) continue;
    const float u = q.x() / q.z(), v = q.y() / q.z();
    const int k = world_.maps[j].nearest_at(u, v);
    if (k < 0) continue;
    const Edgel& e = world_.maps[j].edgels[k];
    const float d = (u - e.x) * e.nx + (v - e.y) * e.ny;
    const float along = -(u - e.x) * e.ny + (v - e.y) * e.nx;
    if (std::abs(d) > reach_px || std::abs(along) > 2.f) continue;
    if (std::abs(tf.dot(Eigen::Vector3f(world_.plane_normal[j].col(k)))) > max_sine) continue;
    const float r = d / float(reach_px);
    matches->push_back({j, k, (1 - r * r) * (1 - r * r)});
  }
}

bool Sweeper::refine(int view, int index, Eigen::Vector3d x, Eigen::Vector3d t, EdgePoint* point,
                     std::vector<Match>* matches) const {
  const double reach[4] = {kMatchPx, kMatchPx, kInlierPx, kInlierPx};
  const double tight = std::sin(kAngleDeg * M_PI / 180);
  const double sine[4] = {std::max(0.45, tight), std::max(0.3, tight), tight, tight};
  for (int it = 0; it < 4; ++it) {
    collect(view, index, x, t, reach[it], sine[it], matches);
    if (int(matches->size()) < options_.min_views) return false;
    // Tangent: least squares, perpendicular to the planes of all edgels. Position: on all of them.
    Eigen::Matrix3d planes = Eigen::Matrix3d::Zero(), H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const Match& m : *matches) {
      const Eigen::Vector3d n = world_.plane_normal[m.view].col(m.edgel).cast<double>();
      planes += m.weight * n * n.transpose();
      const double depth = (x - center_[m.view]).norm();
      const double w = m.weight / (depth * depth);
      H += w * n * n.transpose();
      g += w * n * n.dot(center_[m.view] - x);
    }
    const auto es = eigen_symmetric(planes);
    t = es.vectors.col(0);
    if (es.values[1] < 1e-3 * es.values[2]) return false;  // all planes alike: no depth
    H += t * t.transpose() * (H.trace() + 1e-300);         // stay: nothing is known along the edge
    x += solve_symmetric(H, g);
  }
  collect(view, index, x, t, kInlierPx, tight, matches);
  if (int(matches->size()) < options_.min_views) return false;
  double sum = 0;
  for (const Match& m : *matches) {
    const Edgel& e = world_.maps[m.view].edgels[m.edgel];
    double depth;
    const Eigen::Vector2d p = world_.views[m.view].project(x, &depth);
    const double d = (p.x() - e.x) * e.nx + (p.y() - e.y) * e.ny;
    if (m.view == view && std::abs(d) > kInlierPx) return false;  // left its own edgel
    sum += d * d;
  }
  point->position = x;
  point->tangent = t;
  point->views = int(matches->size());
  point->rms_px = float(std::sqrt(sum / matches->size()));
  point->view = view;
  point->edgel = index;
  return true;
}

bool Sweeper::lift(int view, int index, EdgePoint* point, std::vector<Match>* matches) const {
  Ray ray;
  if (!make_ray(view, world_.maps[view].edgels[index], &ray)) return false;
  std::vector<float> score(size_t(ray.count) * kBins, 0.f);
  for (int other : neighbours_[view]) vote(view, index, other, ray, &score);
  const size_t best = std::max_element(score.begin(), score.end()) - score.begin();
  if (score[best] < 1.0f) return false;
  const double s = ray.s0 + double(best / kBins) * ray.step;
  const double angle = double(best % kBins) * M_PI / kBins;
  const Eigen::Vector3d t = std::cos(angle) * ray.e1 + std::sin(angle) * ray.e2;
  return refine(view, index, ray.center + s * ray.direction, t, point, matches);
}

bool Sweeper::follow(const EdgePoint& from, int view, int index, EdgePoint* point,
                     std::vector<Match>* matches) const {
  const View& v = world_.views[view];
  const Edgel& e = world_.maps[view].edgels[index];
  const Eigen::Vector3d ray =
      (v.cam_from_world.rotation.transpose() * v.camera.ray({e.x, e.y})).normalized();
  // Where the line along the edge is nearest to the ray.
  const Eigen::Vector3d to = from.position - center_[view];
  const double along = ray.dot(from.tangent), sine2 = 1 - along * along;
  if (sine2 < kLeastSine * kLeastSine) return false;
  const double s = (to.dot(ray) - along * to.dot(from.tangent)) / sine2;
  return refine(view, index, center_[view] + s * ray, from.tangent, point, matches) &&
         point->views >= kFollowed * from.views;
}

// Edgels that are lifted, chain after chain.
struct Seeds {
  std::vector<int> edgel;
  std::vector<int> first = {0};  // of chain c: first[c] .. first[c + 1] - 1
};

// Every stride-th edgel of the chains that nothing explains yet.
Seeds pick(const EdgelMap& map, const std::vector<char>& explained, double stride) {
  Seeds out;
  for (int c = 0; c < map.num_chains(); ++c) {
    double since = stride / 2;
    for (int i = map.chain[c]; i < map.chain[c + 1]; ++i) {
      since += 1;
      if (explained[i] || since < stride) continue;
      out.edgel.push_back(i);
      since = 0;
    }
    out.first.push_back(int(out.edgel.size()));
  }
  return out;
}

struct Lifted {
  EdgePoint point;
  std::vector<Match> matches;  // none: it is not
};

// The edgels of a chain: the first of kEvery by itself, the others only if the edge of the one
// before them, that many views see, does not go on to them; and then, to both sides, where the edge
// of a neighbour that many views see goes on, if more views agree there.
void lift_chain(const Sweeper& sweeper, int view, bool along, const int* seeds, int count,
                Lifted* out) {
  const auto follow = [&](int from, int k) {
    if (out[from].matches.empty() || !sweeper.is_sure(out[from].point)) return false;
    Lifted l;
    if (!sweeper.follow(out[from].point, view, seeds[k], &l.point, &l.matches)) return false;
    if (out[k].matches.empty() || l.point.views > out[k].point.views) out[k] = std::move(l);
    return true;
  };
  for (int k = 0; k < count; ++k) {
    if (along && k % kEvery != 0 && follow(k - 1, k)) continue;
    if (!sweeper.lift(view, seeds[k], &out[k].point, &out[k].matches)) out[k].matches.clear();
  }
  if (!along) return;
  for (int k = 1; k < count; ++k) follow(k - 1, k);
  for (int k = count - 2; k >= 0; --k) follow(k + 1, k);
}

}  // namespace

std::vector<EdgePoint> lift_edges(const EdgeWorld& world, const LiftOptions& options) {
  std::vector<EdgePoint> points;
  if (world.bounds.isEmpty() || !(world.footprint > 0)) return points;
  const Sweeper sweeper(world, options);
  const int n = int(world.views.size());
  std::vector<std::vector<char>> explained(n);
  for (int i = 0; i < n; ++i) explained[i].assign(world.maps[i].edgels.size(), 0);
  const int margin = int(options.stride_px);
  for (int view = 0; view < n; ++view) {
    const Seeds seeds = pick(world.maps[view], explained[view], options.stride_px);
    std::vector<Lifted> lifted(seeds.edgel.size());
    parallel_for(int(seeds.first.size()) - 1, 1, [&](int c) {
      const int first = seeds.first[c];
      lift_chain(sweeper, view, options.follow, seeds.edgel.data() + first,
                 seeds.first[c + 1] - first, lifted.data() + first);
    });
    for (const Lifted& l : lifted) {
      if (l.matches.empty()) continue;
      if (world.object.contains(l.point.position)) points.push_back(l.point);
      if (!sweeper.is_sure(l.point)) continue;
      for (const Match& m : l.matches) {
        const int size = int(explained[m.view].size());
        for (int i = std::max(0, m.edgel - margin); i <= std::min(size - 1, m.edgel + margin); ++i)
          explained[m.view][i] = 1;
      }
    }
  }
  return points;
}

}  // namespace sketchsplat
