// SPDX-License-Identifier: MIT
#include "edges/views/match.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/image/pull_of_blur.h"

namespace sketchsplat {
namespace {

// Edgels say next to nothing on moves along the curve; what a few slanted ones say must not make
// the whole curve slide. So a hundredth of what they say across it holds every sample where it is.
constexpr double kSlide = 1e-2;

// [px] by which blur moves the edge of a sample along an edgel's normal.
double pull(const View& view, const EdgelMap& map, const Edgel& e, const CurvePoints& samples,
            int i) {
  if (samples.curvature.cols() == 0 || !(map.blur > 0)) return 0;
  const Eigen::Vector3d bend = samples.curvature.col(i);
  if (bend.isZero(0)) return 0;
  const Eigen::Vector3d q = view.cam_from_world * samples.position.col(i);
  const Eigen::Matrix<double, 2, 3> J =
      view.camera.project_jacobian(q) * view.cam_from_world.rotation;
  // Lines stay lines: what projection itself bends lies along the curve.
  const double speed2 = (J * samples.tangent.col(i)).squaredNorm();
  const double across = e.nx * J.row(0).dot(bend) + e.ny * J.row(1).dot(bend);
  const double towards = pull_of_blur(std::abs(across) / std::max(speed2, 1e-300), map.blur);
  return across > 0 ? towards : -towards;
}

// Matches of all samples in one view, in the order of the samples.
std::vector<SampleMatch> match_view(const EdgeWorld& world, int view, const CurvePoints& samples,
                                    const MatchOptions& options) {
  std::vector<SampleMatch> out;
  const View& v = world.views[view];
  const EdgelMap& map = world.maps[view];
  const double max_sine = std::sin(options.angle_deg * M_PI / 180);
  for (int i = 0; i < samples.position.cols(); ++i) {
    double depth;
    const Eigen::Vector2d p = v.project(samples.position.col(i), &depth);
    if (!(depth > 0) || !(std::abs(p.x()) < 1e6) || !(std::abs(p.y()) < 1e6)) continue;
    const int k = map.nearest_at(p.x(), p.y());
    if (k < 0) continue;
    const Edgel& e = map.edgels[k];
    const double d = (p.x() - e.x) * e.nx + (p.y() - e.y) * e.ny + pull(v, map, e, samples, i);
    const double along = -(p.x() - e.x) * e.ny + (p.y() - e.y) * e.nx;
    if (std::abs(d) > options.reach_px || std::abs(along) > 2) continue;
    const Eigen::Vector3d n = world.plane_normal[view].col(k).cast<double>();
    if (std::abs(n.dot(samples.tangent.col(i))) > max_sine) continue;
    const double r = d / options.reach_px;
    out.push_back({i, view, k, float(d), float(std::max(1e-3, (1 - r * r) * (1 - r * r)))});
  }
  return out;
}

// Drops what a curve matches by accident in this view: too few samples, or all to one side.
void drop_accidents(const CurvePoints& samples, const MatchOptions& options,
                    std::vector<SampleMatch>* matches) {
  std::vector<SampleMatch> kept;
  size_t m = 0;
  for (size_t c = 0; c + 1 < samples.first.size(); ++c) {
    const size_t begin = m;
    while (m < matches->size() && (*matches)[m].sample < samples.first[c + 1]) ++m;
    const int n = samples.first[c + 1] - samples.first[c];
    const int count = int(m - begin);
    if (count == 0 || count < std::max(std::min(n, 3), int(options.min_run * n))) continue;
    if (options.max_bias > 0) {
      std::vector<float> d;
      for (size_t k = begin; k < m; ++k) d.push_back((*matches)[k].distance_px);
      if (std::abs(median(std::move(d))) > options.max_bias) continue;
    }
    kept.insert(kept.end(), matches->begin() + begin, matches->begin() + m);
  }
  matches->swap(kept);
}

// Leaves every edgel to the curve that lies nearest to it.
void make_exclusive(const CurvePoints& samples, size_t num_edgels, bool between,
                    std::vector<SampleMatch>* matches) {
  constexpr int kFarthest = 6;  // edgels from sample to sample: more is another chain
  std::vector<int> curve_of(samples.position.cols());
  for (size_t c = 0; c + 1 < samples.first.size(); ++c)
    for (int i = samples.first[c]; i < samples.first[c + 1]; ++i) curve_of[i] = int(c);
  std::vector<int> owner(num_edgels, -1);
  std::vector<float> best(num_edgels, 1e9f);
  for (size_t k = 0; k < matches->size(); ++k) {
    const SampleMatch& m = (*matches)[k];
    const int curve = curve_of[m.sample];
    int low = m.edgel, high = m.edgel;
    if (between && k + 1 < matches->size()) {
      const SampleMatch& next = (*matches)[k + 1];
      if (next.sample == m.sample + 1 && curve_of[next.sample] == curve &&
          std::abs(next.edgel - m.edgel) <= kFarthest)
        low = std::min(low, next.edgel), high = std::max(high, next.edgel);
    }
    const float d = std::abs(m.distance_px);
    for (int e = low; e <= high; ++e)
      if (d < best[e]) best[e] = d, owner[e] = curve;
  }
  matches->erase(
      std::remove_if(matches->begin(), matches->end(),
                     [&](const SampleMatch& m) { return owner[m.edgel] != curve_of[m.sample]; }),
      matches->end());
}

double robust_sigma(const std::vector<SampleMatch>& matches) {
  std::vector<float> d;
  for (const SampleMatch& m : matches) d.push_back(std::abs(m.distance_px));
  return normal_sigma(std::move(d));
}

}  // namespace

bool closes(const CurvePoints& curve) {
  const Eigen::Matrix3Xd& p = curve.position;
  return (p.col(0) - p.col(p.cols() - 1)).norm() < 2 * (p.col(1) - p.col(0)).norm();
}

Eigen::Vector3d distance_gradient(const EdgeWorld& world, const SampleMatch& match,
                                  const Eigen::Vector3d& position) {
  const View& v = world.views[match.view];
  const Edgel& e = world.maps[match.view].edgels[match.edgel];
  const Eigen::Vector3d q = v.cam_from_world * position;
  return (Eigen::RowVector2d(e.nx, e.ny) * v.camera.project_jacobian(q) * v.cam_from_world.rotation)
      .transpose();
}

namespace {

void add_quadratics(const EdgeWorld& world, const CurvePoints& samples, Matches* out) {
  const int n = int(samples.position.cols());
  out->information.assign(n, Eigen::Matrix3d::Zero());
  out->slope = Eigen::Matrix3Xd::Zero(3, n);
  parallel_for(n, [&](int i) {
    for (int k = out->first[i]; k < out->first[i + 1]; ++k) {
      const SampleMatch& m = out->matches[k];
      const Eigen::Vector3d a = distance_gradient(world, m, samples.position.col(i));
      out->information[i] += m.weight * a * a.transpose();
      out->slope.col(i) += m.weight * a * double(m.distance_px);
    }
    const Eigen::Vector3d t = samples.tangent.col(i);
    out->information[i] += kSlide * out->information[i].trace() * t * t.transpose();
  });
}

}  // namespace

Matches match_samples(const EdgeWorld& world, const CurvePoints& samples,
                      const MatchOptions& options) {
  const int n = int(samples.position.cols()), views = int(world.views.size());
  std::vector<std::vector<SampleMatch>> by_view(views);
  parallel_for(views, 1, [&](int v) {
    by_view[v] = match_view(world, v, samples, options);
    drop_accidents(samples, options, &by_view[v]);
    if (options.exclusive)
      make_exclusive(samples, world.maps[v].edgels.size(), options.exclusive_between, &by_view[v]);
  });
  Matches out;
  out.first.assign(n + 1, 0);
  for (const auto& list : by_view)
    for (const SampleMatch& m : list) ++out.first[m.sample + 1];
  for (int i = 0; i < n; ++i) out.first[i + 1] += out.first[i];
  out.matches.resize(out.first[n]);
  std::vector<int> next(out.first.begin(), out.first.end() - 1);
  for (const auto& list : by_view)
    for (const SampleMatch& m : list) out.matches[next[m.sample]++] = m;
  if (options.quadratics) add_quadratics(world, samples, &out);
  out.sigma_px = robust_sigma(out.matches);
  return out;
}

}  // namespace sketchsplat
