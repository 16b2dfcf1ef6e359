// SPDX-License-Identifier: MIT
#include "pipelines/method/detect_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "edges/views/find_object.h"
#include "edges/views/focus.h"
#include "edges/views/outlines.h"
#include "edges/views/silhouettes.h"
#include "pipelines/options/options.h"

namespace sketchsplat {
namespace {

constexpr int kFewestViews = 3;
constexpr double kCoarseSides = 6;  // of the picture: edgels among which the object is looked for
constexpr double kCoarser = 4;      // times the stride at which they are lifted
constexpr int kCoarseViews = 16;    // that score their depths
constexpr double kBeyond = 1.5;     // times what a view sees: bounds without masks
constexpr double kAbout = 0.5;      // diagonals of the object's box that are looked at around it

double most_edgels(const EdgelMap& map, const DetectOptions& options) {
  const double sides = options.meaning.most_sides;
  return sides > 0 ? sides * std::sqrt(double(map.width) * map.height) : INFINITY;
}

}  // namespace

EdgeWorld detect_scene(const Scene& scene, Detector* detector, const std::vector<TagSquare>& tags,
                       const MethodRun& run) {
  std::vector<Detection> found = detect_all(scene, detector, run.log);
  std::vector<View> views;
  std::vector<EdgelMap> maps;
  size_t edgels = 0, with_edges = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    if (!found[i].complaint.empty()) continue;
    edgels += found[i].map.edgels.size();
    with_edges += !found[i].map.edgels.empty();
    views.push_back(scene.views[i]);
    maps.push_back(without_tags(found[i].map, scene.views[i], tags));
  }
  if (with_edges < kFewestViews)
    throw TooLittleError(scene.folder + ": expected edges in at least " +
                         std::to_string(kFewestViews) + " views, found them in " +
                         std::to_string(with_edges));
  run.log.count("views", double(views.size()));
  run.log.count("edgels", double(edgels));
  Stage stage("hull", run.log);
  for (EdgelMap& map : maps)
    if (!map.mask.empty()) map = most_meaningful(map, most_edgels(map, run.options.detect));
  return make_edge_world(std::move(views), std::move(maps));
}

namespace {

// `points`: on edges, in a world without bounds of the object.
ObjectRegion find_object_in(const EdgeWorld& coarse, const std::vector<EdgePoint>& points,
                            const RegionOptions& look) {
  std::vector<Eigen::Vector3d> cameras;
  for (const View& v : coarse.views) cameras.push_back(v.center_in_world());
  const double reach = 0.5 * coarse.bounds.sizes().maxCoeff() / kBeyond;
  return find_object(points, cameras, meeting_point(coarse.views), reach, coarse.footprint, look);
}

}  // namespace

EdgeWorld focus_on_object(EdgeWorld world, const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  if (!options.box.isEmpty()) {
    ObjectRegion region;
    region.box = options.box;
    return focused(std::move(world), region, options.detect.meaning.most_sides);
  }
  if (world.has_masks()) return world;
  Stage stage("object", run.log);
  const EdgeWorld coarse = focused(world, {}, kCoarseSides);
  LiftOptions lift = options.lift;
  lift.stride_px *= kCoarser;
  lift.sweep_views = std::min(lift.sweep_views, kCoarseViews);
  std::vector<EdgePoint> points = lift_edges(coarse, lift);
  RegionOptions look;
  look.min_views = lift.min_views;
  look.seed = options.seed;
  ObjectRegion object = find_object_in(coarse, points, look);
  if (object.table) {
    // Most of these edges were of other things: those about the object alone tell more of it.
    const ObjectRegion about = wider(object, kAbout * object.box.diagonal().norm());
    const std::vector<EdgePoint> more = lift_edges(focused(world, about, kCoarseSides), lift);
    points.insert(points.end(), more.begin(), more.end());
    look.known = object.edges;
    const ObjectRegion again = find_object_in(coarse, points, look);
    if (again.table) object = again;  // few of these may lie on it
  }
  stage.result(object.table ? "on a table" : "no table");
  return focused(std::move(world), object, options.detect.meaning.most_sides);
}

namespace {

// Edges of the object alone: noise and texture of what lies around it tell nothing about it; and
// its outlines, where its colours tell them. They also tell where a silhouette ends.
EdgelMap detect_on_silhouette(const Scene& scene, const Detector& detector, const View& view,
                              int min_chain, Image<uint8_t>* mask, double* slack_px) {
  constexpr double kAround = 6;  // [px] so that no edge of the object is one of the alpha's
  const Picture seen = read_picture(view);
  Picture odds = odds_by_colours(seen, sides_of(*mask, *slack_px));
  const bool told = !odds.red.empty();
  if (told) trim_silhouette(odds, mask, slack_px);
  const auto edgels_in = [&](Picture picture) {
    picture.alpha = alpha_around(*mask, kAround);
    picture.beyond_px = kAround + *slack_px;
    View looking = view;
    looking.make_picture = [&] { return picture; };
    return detector.detect(scene, looking);
  };
  EdgelMap map = edgels_in(seen);
  if (told) add_outlines(edgels_in(std::move(odds)), view, *mask, *slack_px, min_chain, &map);
  map.mask = {};
  return map;
}

void detect_on_silhouettes(const Scene& scene, const Detector& detector,
                           const DetectOptions& options, Silhouettes* found, EdgeWorld* world) {
  parallel_for(int(world->views.size()), 1, [&](int v) {
    if (found->mask[v].empty()) return;
    try {
      EdgelMap map = detect_on_silhouette(scene, detector, world->views[v], options.min_chain,
                                          &found->mask[v], &found->slack_px[v]);
      map.grey = world->maps[v].grey;
      if (options.meaning.most_sides > 0) map = most_meaningful(map, most_edgels(map, options));
      world->maps[v] = std::move(map);
    } catch (const InputError&) {
      return;  // it was read before: what was found then stays
    }
  });
}

}  // namespace

EdgeWorld add_silhouettes(const Scene& scene, const Detector& detector, EdgeWorld world,
                          const MethodRun& run) {
  const ReconstructOptions& options = run.options;
  const bool known = world.object.table || (!options.box.isEmpty() && !world.has_masks());
  if (!options.silhouettes || !known) return world;
  Stage stage("silhouettes", run.log);
  Silhouettes found = find_silhouettes(world.views, world.object, [&](int view, int denominator) {
    return read_picture(world.views[view], denominator);
  });
  const bool kept = !found.mask.empty();
  stage.result(kept ? std::to_string(found.trusted) + " of " + std::to_string(world.views.size()) +
                          " views agree"
                    : "views do not agree");
  run.log.count("silhouettes", kept ? found.trusted : 0);
  if (kept && detector.takes_smaller_pictures())
    detect_on_silhouettes(scene, detector, options.detect, &found, &world);
  return with_silhouettes(std::move(world), found);
}

}  // namespace sketchsplat
