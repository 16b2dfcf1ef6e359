// SPDX-License-Identifier: MIT
#include "pipelines/refine_poses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "datasets/errors.h"
#include "edges/recast.h"
#include "pipelines/camera_fit.h"
#include "pipelines/stages.h"

namespace sketchsplat {
namespace {

constexpr double kReachPx = 2, kSpacingPx = 6;
constexpr double kOffPx = 0.15;      // strokes of exact cameras have offsets of 0.03 to 0.09 px
constexpr double kOfScatter = 0.75;  // where edgels are vague, offsets are larger
constexpr double kSure = 4;          // standard deviations of a focal length that is wrong
constexpr double kLoose = 3;         // times the offsets, which do not reach beyond the matches
constexpr double kLowShare = 0.4;    // of the edgels: strokes that explain less may be accidents
constexpr double kChanceShare = 0.2;  // and these are compared with accidents
constexpr double kTimesChance = 2;
constexpr double kNoWorse = 0.9;     // times the edgels that are explained, for cameras to move;
constexpr double kBetter = 1.1;  // among things, whose few strokes fit any cameras, more must be
constexpr double kUnfit = 0.3;       // times what strokes explain of the usual view
constexpr double kMovedPx = 0.3;     // strokes are lifted again
constexpr int kFewestViews = 3;
constexpr double kAwry = 0.05;       // of the width of a picture: nothing but accidents fits

struct Posed {
  EdgeWorld world;
  Sketch sketch;
};

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
  const bool masked = std::any_of(world.maps.begin(), world.maps.end(),
                                  [](const EdgelMap& m) { return !m.mask.empty(); });
  if (!masked) return world;
  const ObjectRegion object = world.object;
  EdgeWorld out = make_edge_world(std::move(world.views), std::move(world.maps));
  out.object = object;
  if (!object.box.isEmpty()) out.bounds = object.box;
  return out;
}

Sketch strokes_of(const EdgeWorld& world, const ReconstructOptions& options, RunReport* report,
                  Progress* progress) {
  try {
    return fit_strokes(lift_scene(world, options, report, progress), world, options, report,
                       progress);
  } catch (const TooLittleError&) {
    return {};
  }
}

// How much of each view the strokes explain, and of all.
struct Explained {
  std::vector<double> edgels, samples;  // shares, of each view
  double share = 0;                     // of all edgels
};

Explained explained(const Posed& posed) {
  const int n = int(posed.world.views.size());
  Explained out{std::vector<double>(n), std::vector<double>(n)};
  if (posed.sketch.size() == 0) return out;
  const Observation o = look(posed, kReachPx);
  std::vector<double> rows(n);
  for (const SampleMatch& m : o.matches.matches) ++rows[m.view];
  double all = 0, edgels = 0;
  for (int v = 0; v < n; ++v) {
    const View& view = posed.world.views[v];
    double shown = 0, depth;
    for (int i = 0; i < o.samples.position.cols(); ++i)
      shown += view.camera.contains(view.project(o.samples.position.col(i), &depth)) && depth > 0;
    const double here = double(posed.world.maps[v].edgels.size());
    out.edgels[v] = kSpacingPx * rows[v] / std::max(1.0, here);
    out.samples[v] = rows[v] / std::max(1.0, shown);
    all += kSpacingPx * rows[v], edgels += here;
  }
  out.share = all / std::max(1.0, edgels);
  return out;
}

double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

std::vector<char> unfit_views(const Explained& shares) {
  const double edgels = kUnfit * median_of(shares.edgels);
  const double samples = kUnfit * median_of(shares.samples);
  std::vector<char> out;
  for (size_t v = 0; v < shares.edgels.size(); ++v)
    out.push_back(shares.edgels[v] < edgels && shares.samples[v] < samples);
  return out;
}

// What the first strokes say of the cameras.
struct Misfit {
  double offset_px = 0;
  bool poses = false, focal = false;
  int rows = 0;
};

Misfit misfit(const Posed& posed) {
  Misfit out;
  if (posed.sketch.size() == 0) return out;
  const Observation o = look(posed, kReachPx);
  out.rows = int(o.matches.matches.size());
  if (out.rows == 0) return out;
  const std::vector<View>& stated = posed.world.views;
  CameraPrior prior;
  const CameraFit as_stated = fit_cameras(posed.sketch, o, posed.world, stated, prior, 0);
  out.offset_px = as_stated.before_px;
  out.poses = out.offset_px > std::max(kOffPx, kOfScatter * as_stated.scatter_px);
  prior.pose_px = std::max(0.02, out.offset_px);
  const CameraFit fit = fit_cameras(posed.sketch, o, posed.world, stated, prior, 3);
  for (size_t k = 0; k < fit.focal.size(); ++k)
    out.focal |= std::abs(fit.focal[k]) > kSure * fit.focal_sigma[k];
  return out;
}

CameraPrior prior_of(const Misfit& misfit) {
  CameraPrior prior;
  prior.pose_px = std::max(0.02, (misfit.poses ? kLoose : 1) * misfit.offset_px);
  return prior;
}

// Match, move cameras and strokes, and match again with a reach that shrinks.
double refine(const std::vector<View>& stated, const CameraPrior& prior, Posed* posed) {
  const EdgeWorld first = posed->world;
  double offset = 0;
  for (const double reach : {kReachPx, kReachPx, 1.5, 1.0}) {
    if (posed->sketch.size() == 0) break;
    const Observation o = look(*posed, reach);
    if (o.matches.matches.empty()) break;
    CameraFit fit = fit_cameras(posed->sketch, o, posed->world, stated, prior, 3);
    posed->world = recast(first, std::move(fit.views));
    posed->sketch = std::move(fit.sketch);
    offset = fit.after_px;
  }
  return offset;
}

// How far the cameras have moved what the strokes show [px], median over views.
double moved_px(const Sketch& sketch, const std::vector<View>& a, const std::vector<View>& b,
                double spacing) {
  const Samples samples = evaluate_samples(sketch, plan_samples(sketch, spacing));
  std::vector<double> moved;
  for (size_t v = 0; v < a.size(); ++v) {
    double sum = 0, depth;
    for (int i = 0; i < samples.position.cols(); ++i)
      sum += (a[v].project(samples.position.col(i), &depth) -
              b[v].project(samples.position.col(i), &depth))
                 .squaredNorm();
    moved.push_back(std::sqrt(sum / std::max<int>(1, int(samples.position.cols()))));
  }
  return median_of(moved);
}

// Cameras that pictures of 1 / factor the size make, for those of full size.
std::vector<View> enlarged(const std::vector<View>& coarse, std::vector<View> fine, int factor) {
  for (size_t v = 0; v < fine.size(); ++v) {
    const Camera& from = coarse[v].camera;
    Camera& to = fine[v].camera;
    to.fx = factor * from.fx, to.fy = factor * from.fy;
    to.cx = factor * (from.cx + 0.5) - 0.5, to.cy = factor * (from.cy + 0.5) - 0.5;
    fine[v].cam_from_world = coarse[v].cam_from_world;
    fine[v].lens = coarse[v].lens;
  }
  return fine;
}

std::vector<View> shrunk(std::vector<View> views, int factor) {
  for (View& v : views) v.camera = v.camera.shrunk(factor);
  return views;
}

// The world by cameras that pictures of 1 / factor the size agree on.
EdgeWorld coarse_to_fine(const EdgeWorld& world, int factor, const std::vector<View>& stated,
                         const ReconstructOptions& options, CameraPrior* prior,
                         Progress* progress) {
  RunReport aside;
  Posed posed{coarser(world, factor), {}};
  posed.sketch = strokes_of(posed.world, options, &aside, progress);
  const Misfit off = misfit(posed);
  if (off.rows == 0) return world;
  CameraPrior here = prior_of(off);
  here.pose_px = std::max(here.pose_px, prior->pose_px / factor);
  here.lens_px /= factor;
  prior->pose_px = here.pose_px * factor;
  refine(shrunk(stated, factor), here, &posed);
  return refreshed(recast(world, enlarged(posed.world.views, stated, factor)));
}

EdgeWorld without(const EdgeWorld& world, const std::vector<char>& leave) {
  EdgeWorld out = world;
  out.views.clear(), out.maps.clear(), out.plane_normal.clear();
  for (size_t v = 0; v < leave.size(); ++v) {
    if (leave[v]) continue;
    out.views.push_back(world.views[v]);
    out.maps.push_back(world.maps[v]);
    out.plane_normal.push_back(world.plane_normal[v]);
  }
  return refreshed(std::move(out));
}

// What strokes explain if every view looks somewhere else, each to another side.
double chance_share(const EdgeWorld& world, const ReconstructOptions& options) {
  std::vector<View> views = world.views;
  for (size_t v = 0; v < views.size(); ++v) {
    const double golden = M_PI * (3 - std::sqrt(5.0)), by = kAwry * views[v].camera.width;
    views[v].camera.cx += by * std::cos(golden * double(v));
    views[v].camera.cy += by * std::sin(golden * double(v));
  }
  RunReport aside;
  Posed awry{recast(world, std::move(views)), {}};
  awry.sketch = strokes_of(awry.world, options, &aside, nullptr);
  return explained(awry).share;
}

void check_agreement(const Posed& posed, double share, const ReconstructOptions& options) {
  if (!(share < kLowShare) || stands_among_things(posed.world)) return;
  const double chance = chance_share(posed.world, options);
  if (share > kTimesChance * chance) return;
  char text[240];
  std::snprintf(
      text, sizeof text,
      "expected poses and images that agree, found curves for %.1f %% of the edges of the "
      "images, as many as by accident (%.1f %%): poses and images contradict each other",
      100 * share, 100 * chance);
  throw TooLittleError(text);
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
  posed->world = without(posed->world, leave);
  return true;
}

// Moves the cameras, and lifts again while that moves them.
void refine_all(const Misfit& off, double share, const ReconstructOptions& options,
                RunReport* report, Progress* progress, Posed* posed) {
  const std::vector<View> stated = posed->world.views;
  CameraPrior prior = prior_of(off);
  RunReport aside;
  if (share < kLowShare && !stands_among_things(posed->world)) {
    for (const int factor : {4, 2})
      posed->world = coarse_to_fine(posed->world, factor, stated, options, &prior, progress);
    posed->sketch = strokes_of(posed->world, options, &aside, progress);
  }
  double after = 0;
  for (int round = 0; round < 3; ++round) {
    const std::vector<View> before = posed->world.views;
    after = refine(stated, prior, posed);
    const double moved =
        moved_px(posed->sketch, before, posed->world.views, posed->world.footprint * kSpacingPx);
    if (round > 0 && moved < kMovedPx) break;
    if (round == 2) break;
    posed->world = refreshed(std::move(posed->world));
    posed->sketch = strokes_of(posed->world, options, &aside, progress);
  }
  report->counts.push_back({"pose_offset_before_px", off.offset_px});
  report->counts.push_back({"pose_offset_after_px", after});
}

}  // namespace

PosedStrokes pose_and_fit(EdgeWorld world, const ReconstructOptions& options, RunReport* report,
                          Progress* progress) {
  RunReport first = *report;
  Posed posed{std::move(world), {}};
  posed.sketch = strokes_of(posed.world, options, &first, progress);
  Explained shares = explained(posed);
  const bool able = options.refine_poses != "off" && posed.world.views.size() >= kFewestViews &&
                    options.detector != "2dgs-sn";
  const Misfit off = able ? misfit(posed) : Misfit{};
  if (progress) {
    char text[160];
    std::snprintf(text, sizeof text, "cameras: strokes explain %.0f %%, are off by %.3f px%s",
                  100 * shares.share, off.offset_px,
                  off.focal ? ", another focal length fits" : "");
    progress->note(text);
  }
  const bool low = shares.share < kChanceShare && !stands_among_things(posed.world);
  const bool refining = able && (off.poses || off.focal || low || options.refine_poses == "on");
  bool again = false;
  if (refining) {
    const Posed stated = posed;
    const double before = shares.share;
    Stage stage("poses", 0, report, progress);
    refine_all(off, shares.share, options, report, progress, &posed);
    shares = explained(posed);
    again = options.refine_poses == "on" ||
            shares.share > (stands_among_things(posed.world) ? kBetter : kNoWorse) * before;
    if (!again) posed = stated, shares = explained(posed);
    stage.result(again ? "cameras moved" : "stated cameras fit as well");
  }
  if (able && shares.share > 0) again |= leave_out(shares, report, progress, &posed);
  if (again) {
    first = *report;
    posed.world = refreshed(std::move(posed.world));
    posed.sketch = strokes_of(posed.world, options, &first, progress);
    shares = explained(posed);
  }
  check_agreement(posed, shares.share, options);
  *report = std::move(first);
  if (posed.sketch.size() == 0)
    throw TooLittleError("expected edges that several views see, found none that agree");
  return {std::move(posed.world), std::move(posed.sketch), again};
}

}  // namespace sketchsplat
