// SPDX-License-Identifier: MIT
#include "pipelines/cameras/refine_poses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <utility>

#include "datasets/types/errors.h"
#include "edges/views/recast.h"
#include "pipelines/cameras/camera_fit.h"
#include "pipelines/cameras/misfit.h"
#include "pipelines/cameras/point_prior.h"
#include "pipelines/cameras/settle.h"
#include "pipelines/options/options.h"
#include "pipelines/survey/explained.h"

namespace sketchsplat {
namespace {

constexpr double kTimesChance = 2;
constexpr double kFewEdgels = 0.01, kFewNats = 3;  // [of all, nat] of accidents, at least
constexpr double kLeastShare = 0.1;   // of strokes by stated cameras that can be mended
constexpr double kAstrayPx = 0.4;     // strokes by cameras that are right lie stiller in views
constexpr double kOnStrokePx = 0.25;  // edgels lie on strokes, by such cameras
constexpr double kHeldPx = 1e-3;      // standard deviation of cameras that strokes do not move
constexpr double kPointsOffPx = 0.1;  // points of cameras that are right lie stiller in views
// Times these edgels, for cameras to move of which strokes say that they err, and for others; none
// fewer among things, whose few strokes fit any cameras.
constexpr double kNoWorse = 0.9, kMuchBetter = 1.5;
constexpr int kFewestViews = 3;
constexpr int kEnoughViews = 8;  // where most edges are seen by as many as a point takes
constexpr double kAwry = 0.05;   // of the width of a picture: nothing but accidents fits

// The world's cameras before they move, with the scene's points.
StatedCameras stated_cameras(const EdgeWorld& world, const Scene& scene) {
  return {world.views, points_among(world.views, scene)};
}

// What tells that strokes are no accidents: the share of the edgels that they explain, or, where
// most are texture, what the views say for them [nat].
struct Agreement {
  double share, nats;
};

// Of strokes by cameras that are not these views'.
Agreement accidents(const EdgeWorld& world, std::vector<View> views, const Refit& refit) {
  Posed posed{recast(world, std::move(views))};
  refit(&posed);
  return {explained(posed.sketch, posed.world).share, posed.nats};
}

// Every view looks somewhere else, each to another side.
std::vector<View> awry_views(std::vector<View> views) {
  for (size_t v = 0; v < views.size(); ++v) {
    const double golden = M_PI * (3 - std::sqrt(5.0)), by = kAwry * views[v].camera.width;
    views[v].camera.cx += by * std::cos(golden * double(v));
    views[v].camera.cy += by * std::sin(golden * double(v));
  }
  return views;
}

// Every view stands where another one does, none where it was (Sattolo's cycle): a shift by so many
// views would only turn a ring of cameras.
std::vector<View> shuffled_views(const std::vector<View>& views) {
  std::vector<size_t> from(views.size());
  std::iota(from.begin(), from.end(), 0);
  std::mt19937 random(1);
  for (size_t v = from.size(); v-- > 1;) std::swap(from[v], from[random() % v]);
  std::vector<View> out = views;
  for (size_t v = 0; v < views.size(); ++v) out[v].cam_from_world = views[from[v]].cam_from_world;
  return out;
}

// That strokes are more than accidents, which are few as well.
void check_agreement(const Posed& posed, double share, const Refit& refit) {
  if (!(share < kLowShare) || stands_among_things(posed.world)) return;
  const Agreement awry = accidents(posed.world, awry_views(posed.world.views), refit);
  const Agreement shuffled = accidents(posed.world, shuffled_views(posed.world.views), refit);
  const double by_accident = std::max(awry.share, shuffled.share);
  if (share > std::max(kTimesChance * by_accident, kFewEdgels) ||
      posed.nats > std::max(kTimesChance * std::max(awry.nats, shuffled.nats), kFewNats))
    return;
  char found[120];
  std::snprintf(found, sizeof found,
                "%.1f %% of the edges of the images, hardly more than by accident (%.1f %%)",
                100 * share, 100 * by_accident);
  const bool few = int(posed.world.views.size()) < kEnoughViews;
  throw TooLittleError("expected poses and images that agree, found curves for " +
                       std::string(found) + ": " + (few ? "there are too few views, or " : "") +
                       "poses and images contradict each other");
}

// Names the views that do not fit; false if there are none.
bool leave_out(const Explained& shares, const RunLog& log, Posed* posed) {
  const std::vector<char> leave = unfit_views(shares);
  const auto count = std::count(leave.begin(), leave.end(), 1);
  if (count == 0 || int(leave.size()) - int(count) < kFewestViews) return false;
  std::string names;
  for (size_t v = 0; v < leave.size(); ++v)
    if (leave[v]) names += (names.empty() ? "" : ", ") + posed->world.views[v].name;
  log.warn("left out, for their poses do not fit the other views: " + names);
  log.count("views_left_out", double(count));
  posed->world = refreshed(without_views(posed->world, leave));
  return true;
}

void append(const RunReport& from, RunReport* to) {
  to->stages.insert(to->stages.end(), from.stages.begin(), from.stages.end());
  to->counts.insert(to->counts.end(), from.counts.begin(), from.counts.end());
  to->warnings.insert(to->warnings.end(), from.warnings.begin(), from.warnings.end());
}

// How far the cameras are off.
Misfit check_cameras(const Posed& posed, const StatedCameras& stated, double share,
                     const RunLog& log) {
  Stage stage("cameras", log);
  const Misfit off = misfit(posed, stated);
  char text[160];
  std::snprintf(text, sizeof text,
                "strokes explain %.0f %%, are off by %.3f px, by %.3f px for poses%s", 100 * share,
                off.offset_px, off.error_px,
                off.shared ? ", another focal length or lens fits" : "");
  stage.result(text);
  return off;
}

// Share of the edgels that lie on strokes as they do by cameras that are right, once the strokes
// have settled: where they were lifted says little of cameras.
double still_share(const Posed& posed) {
  const Observation o = look(posed, kCameraReachPx);
  if (o.matches.matches.empty()) return 0;
  CameraPrior still;
  still.pose_px = kHeldPx, still.shared = false;
  const CameraFit fit = fit_cameras(posed.sketch, o, posed.world, {posed.world.views}, still, {});
  return explained(fit.sketch, posed.world, kOnStrokePx).share;
}

// Some cameras fit any few edges: those that had to move must have shown something before, or show
// much now.
bool proves_cameras(const Posed& before, const Posed& after) {
  return explained(before.sketch, before.world).share >= kLeastShare ||
         explained(after.sketch, after.world).share >= kLowShare;
}

// Cameras that fit, where these ones do not and others explain more; true if they moved.
bool move_cameras(const StatedCameras& stated, const Misfit& off, const Refit& refit,
                  const MethodRun& run, Posed* posed) {
  const Posed first = *posed;
  Stage stage("poses", run.log);
  const double after = settle_cameras(first, stated, off, refit, posed);
  const bool things = stands_among_things(posed->world);
  const double least = (things ? 1 : off.confirmed() ? kNoWorse : kMuchBetter) * still_share(first);
  const bool better = still_share(*posed) > least && (things || proves_cameras(first, *posed));
  const bool moved = run.options.refine_poses == "on" || better;
  if (!moved) *posed = first;
  run.log.count("pose_offset_before_px", off.offset_px);
  run.log.count("pose_offset_after_px", moved ? after : off.offset_px);
  if (moved) run.log.count("pose_scale_sigma", scale_sigma(*posed, stated, off));
  stage.result(moved ? "cameras moved" : "stated cameras fit as well");
  return moved;
}

}  // namespace

PosedStrokes pose_and_fit(const Scene& scene, EdgeWorld world, const StrokeFit& fit,
                          const MethodRun& run) {
  const Refit refit = refit_by(fit, run);
  const std::string& how = run.options.refine_poses;
  Posed posed{std::move(world)};
  const StatedCameras stated = stated_cameras(posed.world, scene);
  refit(&posed);
  Explained shares = explained(posed.sketch, posed.world);
  const bool able =
      how != "off" && posed.world.views.size() >= kFewestViews && run.options.detector != "2dgs-sn";
  const Misfit off = able ? check_cameras(posed, stated, shares.share, run.log) : Misfit{};
  const bool astray = (shares.share < kLeastShare || off.offset_px > kAstrayPx) &&
                      !stands_among_things(posed.world);
  // The cameras of structure from motion err; among things few strokes are left to confirm it.
  const bool doubtful =
      stands_among_things(posed.world) && points_off_px(stated.views, stated.points) > kPointsOffPx;
  bool moved = false;
  if (able && (off.confirmed() || astray || doubtful || how == "on")) {
    moved = move_cameras(stated, off, refit, run, &posed);
    shares = explained(posed.sketch, posed.world);
  }
  if (able && shares.share > 0 && leave_out(shares, run.log, &posed)) {
    moved = true;
    refit(&posed);
    shares = explained(posed.sketch, posed.world);
  }
  check_agreement(posed, shares.share, refit_by(fit, {run.options, {}}));
  append(posed.report, run.log.report);
  if (posed.sketch.size() == 0)
    throw TooLittleError("expected edges that several views see, found none that agree");
  return {std::move(posed.world), std::move(posed.sketch), posed.odds, moved};
}

}  // namespace sketchsplat
