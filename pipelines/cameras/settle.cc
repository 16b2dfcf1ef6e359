// SPDX-License-Identifier: MIT
#include "pipelines/cameras/settle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "edges/views/recast.h"
#include "pipelines/cameras/bring_back.h"
#include "pipelines/cameras/gauge.h"
#include "pipelines/cameras/point_prior.h"
#include "pipelines/survey/explained.h"

namespace sketchsplat {
namespace {

constexpr double kStillPx = 0.1;  // strokes stay as they were lifted
constexpr double kMovedPx = 0.2;  // they are lifted, and cameras are fitted again
constexpr int kMostLifts = 5, kMostReturns = 3;

// Match, move cameras and strokes, and match again with a reach that shrinks.
double refine(const StatedCameras& stated, const CameraPrior& prior, Posed* posed) {
  double offset = 0;
  for (const double reach : {kCameraReachPx, kCameraReachPx, 1.5, 1.0}) {
    if (posed->sketch.size() == 0) break;
    const Observation o = look(*posed, reach);
    if (o.matches.matches.empty()) break;
    CameraFit fit = fit_cameras(posed->sketch, o, posed->world, stated, prior, {});
    posed->world = recast(std::move(posed->world), std::move(fit.views));
    posed->sketch = std::move(fit.sketch);
    offset = fit.after_px;
  }
  return offset;
}

// Strokes, and the cameras that they were fitted with.
struct Shown {
  const Sketch& sketch;
  const std::vector<View>& views;
};

// How far the cameras have moved against one another what the strokes show [px], median over views:
// of what they and the strokes moved together, as a similarity, a lift would find the same.
double moved_px(const Shown& a, const Shown& b, double spacing) {
  const SampleLayout layout = plan_samples(a.sketch, spacing);
  const Eigen::Matrix3Xd before = evaluate_samples(a.sketch, layout).position;
  const Eigen::Matrix3Xd after = evaluate_samples(b.sketch, layout).position;
  if (before.cols() == 0) return 0;
  const Eigen::Matrix4d together = similarity_between(before, after);
  const Eigen::Matrix3Xd there = (together * before.colwise().homogeneous()).topRows<3>();
  std::vector<double> moved;
  for (size_t v = 0; v < a.views.size(); ++v) {
    double sum = 0, depth;
    for (int i = 0; i < before.cols(); ++i)
      sum += (a.views[v].project(before.col(i), &depth) - b.views[v].project(there.col(i), &depth))
                 .squaredNorm();
    moved.push_back(std::sqrt(sum / double(before.cols())));
  }
  return median(moved);
}

StatedCameras shrunk(StatedCameras stated, int factor) {
  for (View& v : stated.views) v.camera = v.camera.shrunk(factor);
  stated.points = shrunk(std::move(stated.points), factor);
  return stated;
}

// Cameras that pictures of 1 / factor the size make, for those of full size.
std::vector<View> enlarged(const std::vector<View>& coarse, std::vector<View> fine, int factor) {
  for (size_t v = 0; v < fine.size(); ++v) {
    fine[v].camera = coarse[v].camera.enlarged(factor, fine[v].camera.width, fine[v].camera.height);
    fine[v].cam_from_world = coarse[v].cam_from_world;
    fine[v].lens = coarse[v].lens;
  }
  return fine;
}

// The world by cameras that pictures of 1 / factor the size agree on.
EdgeWorld coarse_to_fine(const EdgeWorld& world, int factor, const StatedCameras& stated,
                         const Refit& refit, CameraPrior* prior) {
  Posed posed{coarser(world, factor)};
  refit(&posed);
  const StatedCameras small = shrunk(stated, factor);
  const Misfit off = misfit(posed, {posed.world.views, small.points});
  if (off.rows == 0) return world;
  CameraPrior here = prior_of(off);
  here.pose_px = std::max(here.pose_px, prior->pose_px / factor);
  here.shared = prior->shared;
  here.lens_px /= factor;
  prior->pose_px = here.pose_px * factor;
  refine(small, here, &posed);
  return refreshed(recast(world, enlarged(posed.world.views, stated.views, factor)));
}

// Whether the strokes, once the poses fit, are sure that what views share is wrong.
bool shared_is_wrong(const Posed& posed, const StatedCameras& stated, CameraPrior prior) {
  if (posed.sketch.size() == 0) return false;
  const Observation o = look(posed, kCameraReachPx);
  if (o.matches.matches.empty()) return false;
  prior.shared = true;
  return camera_evidence(posed.sketch, o, posed.world, stated, prior).shared > kSureOfShared;
}

// Moves cameras and strokes, and lifts again while that moves them; the offsets that are left.
double settle(const StatedCameras& stated, const CameraPrior& prior, const Refit& refit,
              Posed* posed) {
  for (int round = 0;; ++round) {
    const std::vector<View> before = posed->world.views;
    const Sketch lifted = posed->sketch;
    const double after = refine(stated, prior, posed);
    const double moved = moved_px({lifted, before}, {posed->sketch, posed->world.views},
                                  posed->world.footprint * kCameraSpacingPx);
    posed->world = refreshed(std::move(posed->world));
    if (moved < kStillPx) {
      posed->sketch = lifted;
      return after;
    }
    refit(posed);
    if (round == kMostLifts || moved < kMovedPx) return after;
  }
}

// Poses first; focal length, centre and lens if these do not do it.
double refine_from(const StatedCameras& stated, CameraPrior prior, const Refit& refit,
                   Posed* posed) {
  double after = settle(stated, prior, refit, posed);
  for (int k = 0; k < kMostReturns && bring_back(posed->sketch, stated, prior, &posed->world);
       ++k) {
    refit(posed);
    after = settle(stated, prior, refit, posed);
  }
  if (prior.shared || !shared_is_wrong(*posed, stated, prior)) return after;
  prior.shared = true;
  return settle(stated, prior, refit, posed);
}

// From where the cameras are, or, if strokes explain little then, from where smaller pictures say.
double settle_best(const Posed& first, const StatedCameras& stated, const Misfit& off,
                   const Refit& refit, Posed* posed) {
  CameraPrior prior = prior_of(off);
  const double after = refine_from(stated, prior, refit, posed);
  const double share = explained(posed->sketch, posed->world).share;
  if (!(share < kLowShare) || stands_among_things(first.world)) return after;
  Posed other = first;
  for (const int factor : {4, 2})
    other.world = coarse_to_fine(other.world, factor, stated, refit, &prior);
  refit(&other);
  const double after_other = refine_from(stated, prior, refit, &other);
  if (!(explained(other.sketch, other.world).share > share)) return after;
  *posed = std::move(other);
  return after_other;
}

// Moves all to where the points of structure from motion say, or the stated cameras are likeliest.
void hold_gauge(const StatedCameras& stated, Posed* posed) {
  if (posed->sketch.size() == 0) return;
  const Observation o = look(*posed, kCameraReachPx);
  if (o.matches.matches.empty()) return;
  const Eigen::Vector3d middle = o.samples.position.rowwise().mean();
  std::vector<View> views = posed->world.views;
  const Similarity to =
      stated.points.empty()
          ? likeliest_gauge(views, stated.views, middle, image_radii(o, posed->world, middle))
          : gauge_of_points(views, stated.points);
  for (View& v : views) v = moved(std::move(v), to);
  posed->world = refreshed(recast(std::move(posed->world), std::move(views)));
  posed->sketch = moved(posed->sketch, to);
}

}  // namespace

double settle_cameras(const Posed& first, const StatedCameras& stated, const Misfit& off,
                      const Refit& refit, Posed* posed) {
  const double after = settle_best(first, stated, off, refit, posed);
  hold_gauge(stated, posed);
  return after;
}

double scale_sigma(const Posed& posed, const StatedCameras& stated, const Misfit& off) {
  if (posed.sketch.size() == 0) return 0;
  CameraPrior prior = prior_of(off);
  for (size_t v = 0; v < stated.views.size(); ++v)
    if (posed.world.views[v].camera.fx != stated.views[v].camera.fx) prior.shared = true;
  const Observation o = look(posed, kCameraReachPx);
  if (o.matches.matches.empty()) return 0;
  return fit_cameras(posed.sketch, o, posed.world, stated, prior, {0}).scale_sigma;
}

}  // namespace sketchsplat
