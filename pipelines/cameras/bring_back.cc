// SPDX-License-Identifier: MIT
#include "pipelines/cameras/bring_back.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "datasets/types/median.h"
#include "edges/views/recast.h"
#include "pipelines/survey/explained.h"

namespace sketchsplat {
namespace {

constexpr double kSpacingPx = 6;
constexpr double kReachPx = 2, kNearPx = 1;  // of edgels, in the search and of what is explained
constexpr double kStepPx = 3, kFarthestPx = 9;
constexpr int kFits = 4;           // at each reach
constexpr double kUsual = 0.75;    // quantile of views, of these shares of their edgels
constexpr double kPoor = 0.85;     // times what strokes explain of the usual view
constexpr double kFarMore = 1.2;   // times what they have explained
constexpr double kAsUsual = 0.75;  // times what they explain of the usual view

// Turned so that what it shows moves by so many pixels.
View turned(View v, const Eigen::Vector2d& px) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(px.x() / v.camera.fx, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(-px.y() / v.camera.fy, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  v.cam_from_world.rotation = turn * v.cam_from_world.rotation;
  v.cam_from_world.translation = turn * v.cam_from_world.translation;
  return v;
}

// Every view turned to where it sees most of the strokes.
EdgeWorld searched(const Sketch& sketch, EdgeWorld world) {
  const std::vector<View> from = world.views;
  std::vector<View> best = from;
  std::vector<double> most = explained(sketch, world, kReachPx).edgels;
  const int steps = int(kFarthestPx / kStepPx);
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j) {
      const Eigen::Vector2d by(i * kStepPx, j * kStepPx);
      if (by.norm() > kFarthestPx) continue;
      std::vector<View> there;
      for (const View& v : from) there.push_back(turned(v, by));
      world = recast(std::move(world), there);
      const std::vector<double> now = explained(sketch, world, kReachPx).edgels;
      for (size_t v = 0; v < from.size(); ++v)
        if (now[v] > most[v]) most[v] = now[v], best[v] = there[v];
    }
  return recast(std::move(world), std::move(best));
}

// Poses by strokes that stay, from where they are.
EdgeWorld resected(const Sketch& sketch, const CameraPrior& prior, EdgeWorld world) {
  const StatedCameras begin{world.views};
  CameraFitOptions options;
  options.strokes_move = false;
  for (const double reach : {kReachPx, kNearPx})
    for (int fit = 0; fit < kFits; ++fit) {
      MatchOptions match;
      match.reach_px = reach;
      match.quadratics = false;
      const Observation o = observe(sketch, world, match, kSpacingPx);
      if (o.matches.matches.empty()) return world;
      CameraFit fitted = fit_cameras(sketch, o, world, begin, prior, options);
      world = recast(std::move(world), std::move(fitted.views));
    }
  return world;
}

}  // namespace

int bring_back(const Sketch& sketch, const StatedCameras& stated, const CameraPrior& prior,
               EdgeWorld* world) {
  if (sketch.size() == 0) return 0;
  std::vector<double> share = explained(sketch, *world, kNearPx).edgels;
  const double usual = quantile(share, kUsual);
  std::vector<char> good;
  for (const double s : share) good.push_back(s >= kPoor * usual);
  CameraPrior poses = prior;
  poses.shared = false;
  std::vector<View> views = world->views;
  std::vector<char> moved(views.size());
  for (const std::vector<View>& from : {world->views, stated.views}) {
    EdgeWorld poor = without_views(recast(*world, from), good);
    if (poor.views.empty()) return 0;
    poor = resected(sketch, poses, searched(sketch, std::move(poor)));
    const std::vector<double> now = explained(sketch, poor, kNearPx).edgels;
    for (size_t v = 0, k = 0; v < views.size(); ++v) {
      if (good[v]) continue;
      if (now[k] > std::max(kFarMore * share[v], kAsUsual * usual))
        views[v] = poor.views[k], share[v] = now[k], moved[v] = 1;
      ++k;
    }
  }
  const int count = int(std::count(moved.begin(), moved.end(), 1));
  if (count > 0) *world = recast(std::move(*world), std::move(views));
  return count;
}

}  // namespace sketchsplat
