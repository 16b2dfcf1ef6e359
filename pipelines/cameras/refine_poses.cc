// SPDX-License-Identifier: MIT
#include "pipelines/cameras/refine_poses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "datasets/types/errors.h"
#include "datasets/types/median.h"
#include "edges/views/recast.h"
#include "pipelines/cameras/camera_fit.h"
#include "pipelines/cameras/point_prior.h"
#include "pipelines/stages/stages.h"
#include "pipelines/survey/explained.h"

namespace sketchsplat {
namespace {

constexpr double kReachPx = 2, kSpacingPx = 6;
constexpr double kErrPx = 0.075;      // what poses that err less make of strokes is no matter
constexpr double kRare = 1.645;       // exact poses in one scene of eight to twenty
constexpr double kSure = 4;           // of what views share, which changes scale and place
constexpr double kExactPx = 0.02;     // poses err at least by this
constexpr double kLoose = 3;          // times the offsets, which do not reach beyond the matches
constexpr double kLowShare = 0.4;     // of the edgels: strokes that explain less may be accidents
constexpr double kChanceShare = 0.2;  // and these are compared with accidents
constexpr double kTimesChance = 2;
constexpr double kLeastShare = 0.1;  // of strokes by stated cameras that can be mended
constexpr double kNoWorse = 0.9;     // times the edgels that are explained, for cameras to move;
                                     // none fewer among things, whose few strokes fit any cameras
constexpr double kStillPx = 0.1;     // strokes stay as they were lifted
constexpr double kMovedPx = 0.2;     // they are lifted, and cameras are fitted again
constexpr int kFewestViews = 3, kMostLifts = 5;
constexpr int kEnoughViews = 8;  // where most edges are seen by as many as a point takes
constexpr double kAwry = 0.05;   // of the width of a picture: nothing but accidents fits

struct Posed {
  EdgeWorld world;
  Sketch sketch;
  RunReport report;  // of how the strokes were found, alone
};

// The world's cameras before they move, with the scene's points.
StatedCameras stated_cameras(const EdgeWorld& world, const Scene& scene) {
  return {world.views, points_among(world.views, scene)};
}

// Then most edges in the images are no object's, and the share that strokes explain tells nothing.
bool stands_among_things(const EdgeWorld& world) { return bool(world.object.table); }

Observation look(const Posed& posed, double reach_px) {
  MatchOptions match;
  match.reach_px = reach_px;
  match.quadratics = false;
  return observe(posed.sketch, posed.world, match, kSpacingPx);
}

// Hull and bounds follow the cameras where masks tell.
EdgeWorld refreshed(EdgeWorld world) {
  if (world.silhouettes) world.hull = hull_of(world);
  if (!world.has_masks()) return world;
  const ObjectRegion object = world.object;
  EdgeWorld out = make_edge_world(std::move(world.views), std::move(world.maps));
  out.object = object;
  if (!object.box.isEmpty()) out.bounds = object.box;
  return out;
}

// Strokes anew, in the world as it is.
void find_strokes(const ReconstructOptions& options, Progress* progress, Posed* posed) {
  posed->report = {};
  try {
    posed->sketch = fit_strokes(lift_scene(posed->world, options, &posed->report, progress),
                                posed->world, options, &posed->report, progress);
  } catch (const TooLittleError&) {
    posed->sketch = {};
  }
}

// What the first strokes say of the cameras.
struct Misfit {
  double offset_px = 0, pose_px = 0;   // of strokes in views; and without what views share
  double error_px = 0;                 // of the poses, in these offsets
  bool poses = false, shared = false;  // shared: focal length, centre or lens
  int rows = 0;
};

Misfit misfit(const Posed& posed, const StatedCameras& stated) {
  Misfit out;
  if (posed.sketch.size() == 0) return out;
  const Observation o = look(posed, kReachPx);
  out.rows = int(o.matches.matches.size());
  if (out.rows == 0) return out;
  const CameraEvidence evidence = camera_evidence(posed.sketch, o, posed.world, stated, {});
  out.offset_px = out.pose_px = evidence.offset_px, out.error_px = evidence.error_px;
  // Cameras that structure from motion found are never exact.
  const double least = stated.points.empty() ? kErrPx : kExactPx;
  out.poses = evidence.poses > kRare && evidence.error_px > least;
  CameraPrior held;
  held.pose_px = kExactPx;
  // Poses that nothing contradicts do not take up what another focal length or lens explains.
  out.shared =
      (out.poses ? evidence : camera_evidence(posed.sketch, o, posed.world, stated, held)).shared >
      kSure;
  if (!out.shared) return out;
  out.pose_px = fit_cameras(posed.sketch, o, posed.world, stated, held, 3).after_px;
  return out;
}

// What the views of a camera share moves only if the strokes are sure of it: where a flat object
// does not tell, a wrong focal length would change the scale, a wrong centre the place.
CameraPrior prior_of(const Misfit& misfit) {
  CameraPrior prior;
  prior.shared = misfit.shared;
  prior.pose_px = std::max(kExactPx, (misfit.poses ? kLoose : 1) * misfit.pose_px);
  return prior;
}

// Match, move cameras and strokes, and match again with a reach that shrinks.
double refine(const StatedCameras& stated, const CameraPrior& prior, Posed* posed) {
  double offset = 0;
  for (const double reach : {kReachPx, kReachPx, 1.5, 1.0}) {
    if (posed->sketch.size() == 0) break;
    const Observation o = look(*posed, reach);
    if (o.matches.matches.empty()) break;
    CameraFit fit = fit_cameras(posed->sketch, o, posed->world, stated, prior, 3);
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
  const Eigen::Matrix4d together = Eigen::umeyama(before, after);
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

// Cameras that pictures of 1 / factor the size make, for those of full size.
std::vector<View> enlarged(const std::vector<View>& coarse, std::vector<View> fine, int factor) {
  for (size_t v = 0; v < fine.size(); ++v) {
    fine[v].camera = coarse[v].camera.enlarged(factor, fine[v].camera.width, fine[v].camera.height);
    fine[v].cam_from_world = coarse[v].cam_from_world;
    fine[v].lens = coarse[v].lens;
  }
  return fine;
}

StatedCameras shrunk(StatedCameras stated, int factor) {
  for (View& v : stated.views) v.camera = v.camera.shrunk(factor);
  stated.points = shrunk(std::move(stated.points), factor);
  return stated;
}

// The world by cameras that pictures of 1 / factor the size agree on.
EdgeWorld coarse_to_fine(const EdgeWorld& world, int factor, const StatedCameras& stated,
                         const ReconstructOptions& options, CameraPrior* prior,
                         Progress* progress) {
  Posed posed{coarser(world, factor), {}, {}};
  find_strokes(options, progress, &posed);
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

// What strokes explain if every view looks somewhere else, each to another side.
double chance_share(const EdgeWorld& world, const ReconstructOptions& options) {
  std::vector<View> views = world.views;
  for (size_t v = 0; v < views.size(); ++v) {
    const double golden = M_PI * (3 - std::sqrt(5.0)), by = kAwry * views[v].camera.width;
    views[v].camera.cx += by * std::cos(golden * double(v));
    views[v].camera.cy += by * std::sin(golden * double(v));
  }
  Posed awry{recast(world, std::move(views)), {}, {}};
  find_strokes(options, nullptr, &awry);
  return explained(awry.sketch, awry.world).share;
}

// Of what strokes explain now, and explained of the cameras as stated: cameras that had to move
// must have shown something before, or show much now, for some cameras fit any few edges.
void check_agreement(const Posed& posed, double share, bool moved, double as_stated,
                     const ReconstructOptions& options) {
  if (!(share < kLowShare) || stands_among_things(posed.world)) return;
  char found[120];
  if (moved && as_stated < kLeastShare) {
    std::snprintf(found, sizeof found,
                  "%.1f %% of the edges of the images, %.1f %% if cameras move", 100 * as_stated,
                  100 * share);
  } else {
    const double chance = chance_share(posed.world, options);
    if (share > kTimesChance * chance) return;
    std::snprintf(found, sizeof found,
                  "%.1f %% of the edges of the images, as many as by accident (%.1f %%)",
                  100 * share, 100 * chance);
  }
  const bool few = int(posed.world.views.size()) < kEnoughViews;
  throw TooLittleError("expected poses and images that agree, found curves for " +
                       std::string(found) + ": " + (few ? "there are too few views, or " : "") +
                       "poses and images contradict each other");
}

// Names the views that do not fit; false if there are none.
bool leave_out(const Explained& shares, RunReport* report, Progress* progress, Posed* posed) {
  const std::vector<char> leave = unfit_views(shares);
  const auto count = std::count(leave.begin(), leave.end(), 1);
  if (count == 0 || int(leave.size()) - int(count) < kFewestViews) return false;
  std::string names;
  for (size_t v = 0; v < leave.size(); ++v)
    if (leave[v]) names += (names.empty() ? "" : ", ") + posed->world.views[v].name;
  warn("left out, for their poses do not fit the other views: " + names, report, progress);
  report->counts.push_back({"views_left_out", double(count)});
  posed->world = refreshed(without_views(posed->world, leave));
  return true;
}

// Whether the strokes, once the poses fit, are sure that what views share is wrong.
bool shared_is_wrong(const Posed& posed, const StatedCameras& stated, CameraPrior prior) {
  if (posed.sketch.size() == 0) return false;
  const Observation o = look(posed, kReachPx);
  if (o.matches.matches.empty()) return false;
  prior.shared = true;
  return camera_evidence(posed.sketch, o, posed.world, stated, prior).shared > kSure;
}

// Moves cameras and strokes, and lifts again while that moves them; the offsets that are left.
double settle(const StatedCameras& stated, const CameraPrior& prior,
              const ReconstructOptions& options, Progress* progress, Posed* posed) {
  for (int round = 0;; ++round) {
    const std::vector<View> before = posed->world.views;
    const Sketch lifted = posed->sketch;
    const double after = refine(stated, prior, posed);
    const double moved = moved_px({lifted, before}, {posed->sketch, posed->world.views},
                                  posed->world.footprint * kSpacingPx);
    posed->world = refreshed(std::move(posed->world));
    if (moved < kStillPx) {
      posed->sketch = lifted;
      return after;
    }
    find_strokes(options, progress, posed);
    if (round == kMostLifts || moved < kMovedPx) return after;
  }
}

// Poses first; focal length, centre and lens if these do not do it.
double refine_from(const StatedCameras& stated, CameraPrior prior,
                   const ReconstructOptions& options, Progress* progress, Posed* posed) {
  const double after = settle(stated, prior, options, progress, posed);
  if (prior.shared || !shared_is_wrong(*posed, stated, prior)) return after;
  prior.shared = true;
  return settle(stated, prior, options, progress, posed);
}

// From the first strokes; where these explain little, from those of small pictures, too. The
// offsets that are left.
double refine_all(const Posed& first, const StatedCameras& stated, const Misfit& off,
                  const ReconstructOptions& options, Progress* progress, Posed* posed) {
  CameraPrior prior = prior_of(off);
  const double after = refine_from(stated, prior, options, progress, posed);
  const double share = explained(posed->sketch, posed->world).share;
  if (!(share < kLowShare) || stands_among_things(first.world)) return after;
  Posed other = first;
  for (const int factor : {4, 2})
    other.world = coarse_to_fine(other.world, factor, stated, options, &prior, progress);
  find_strokes(options, progress, &other);
  const double after_other = refine_from(stated, prior, options, progress, &other);
  if (!(explained(other.sketch, other.world).share > share)) return after;
  *posed = std::move(other);
  return after_other;
}

// Relative standard deviation of the size of what the moved cameras show.
double scale_sigma(const Posed& posed, const StatedCameras& stated, const Misfit& off) {
  if (posed.sketch.size() == 0) return 0;
  CameraPrior prior = prior_of(off);
  for (size_t v = 0; v < stated.views.size(); ++v)
    if (posed.world.views[v].camera.fx != stated.views[v].camera.fx) prior.shared = true;
  const Observation o = look(posed, kReachPx);
  if (o.matches.matches.empty()) return 0;
  return fit_cameras(posed.sketch, o, posed.world, stated, prior, 0).scale_sigma;
}

// Cameras that fit, where these ones do not and others explain more; true if they moved.
bool move_cameras(const StatedCameras& stated, const Misfit& off, double share,
                  const ReconstructOptions& options, RunReport* report, Progress* progress,
                  Posed* posed) {
  const Posed first = *posed;
  Stage stage("poses", 0, report, progress);
  const double after = refine_all(first, stated, off, options, progress, posed);
  const double least = (stands_among_things(posed->world) ? 1 : kNoWorse) * share;
  const bool moved =
      options.refine_poses == "on" || explained(posed->sketch, posed->world).share > least;
  if (!moved) *posed = first;
  report->counts.push_back({"pose_offset_before_px", off.offset_px});
  report->counts.push_back({"pose_offset_after_px", moved ? after : off.offset_px});
  if (moved) report->counts.push_back({"pose_scale_sigma", scale_sigma(*posed, stated, off)});
  stage.result(moved ? "cameras moved" : "stated cameras fit as well");
  return moved;
}

void append(const RunReport& from, RunReport* to) {
  to->stages.insert(to->stages.end(), from.stages.begin(), from.stages.end());
  to->counts.insert(to->counts.end(), from.counts.begin(), from.counts.end());
  to->warnings.insert(to->warnings.end(), from.warnings.begin(), from.warnings.end());
}

// How far the cameras are off.
Misfit check_cameras(const Posed& posed, const StatedCameras& stated, double share,
                     RunReport* report, Progress* progress) {
  Stage stage("cameras", 0, report, progress);
  const Misfit off = misfit(posed, stated);
  char text[160];
  std::snprintf(text, sizeof text,
                "strokes explain %.0f %%, are off by %.3f px, by %.3f px for poses%s", 100 * share,
                off.offset_px, off.error_px,
                off.shared ? ", another focal length or lens fits" : "");
  stage.result(text);
  return off;
}

}  // namespace

PosedStrokes pose_and_fit(const Scene& scene, EdgeWorld world, const ReconstructOptions& options,
                          RunReport* report, Progress* progress) {
  Posed posed{std::move(world), {}, {}};
  const StatedCameras stated = stated_cameras(posed.world, scene);
  find_strokes(options, progress, &posed);
  Explained shares = explained(posed.sketch, posed.world);
  const bool able = options.refine_poses != "off" && posed.world.views.size() >= kFewestViews &&
                    options.detector != "2dgs-sn";
  const Misfit off = able ? check_cameras(posed, stated, shares.share, report, progress) : Misfit{};
  const bool low = shares.share < kChanceShare && !stands_among_things(posed.world);
  const double as_stated = shares.share;
  bool moved = false;
  if (able && (off.poses || off.shared || low || options.refine_poses == "on")) {
    moved = move_cameras(stated, off, shares.share, options, report, progress, &posed);
    shares = explained(posed.sketch, posed.world);
  }
  if (able && shares.share > 0 && leave_out(shares, report, progress, &posed)) {
    moved = true;
    find_strokes(options, progress, &posed);
    shares = explained(posed.sketch, posed.world);
  }
  check_agreement(posed, shares.share, moved, as_stated, options);
  append(posed.report, report);
  if (posed.sketch.size() == 0)
    throw TooLittleError("expected edges that several views see, found none that agree");
  return {std::move(posed.world), std::move(posed.sketch), moved};
}

}  // namespace sketchsplat
