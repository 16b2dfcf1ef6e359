// SPDX-License-Identifier: MIT
#include "pipelines/method/close_solid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "edges/views/unexplained.h"
#include "pipelines/method/lacking_edges.h"
#include "pipelines/options/options.h"
#include "pipelines/survey/explained.h"
#include "pipelines/survey/observe.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// How far curves may be from the surfaces that they lie on: in concave corners, where light changes
// slowly, edges are off by about a pixel.
constexpr double kTolerancePx = 1.2, kLeastTolerance = 1.5e-3;
// Where no mask can contradict, how much surer the choice must be.
constexpr double kWithoutMasks = 3;
constexpr int kSightsPerStroke = 8;  // of one view
constexpr int kMaskViews = 24, kMaskGrid = 32;
constexpr int kClearPx = 3;  // [px] around a pixel that the mask must agree on
// Share of the edges that a solid may lack: the rim of a small hole is more.
constexpr double kLacking = 0.01;
constexpr int kContourLines = 600, kLeastChain = 12;

void add_sights(const Sketch& sketch, const EdgeWorld& world, SolidEvidence* evidence) {
  const Observation o = observe_places(sketch, world);
  for (int s = 0; s < sketch.size(); ++s) {
    const int first = o.layout.first[s], all = o.layout.first[s + 1] - first,
              places = std::min(all, kSightsPerStroke);
    for (int k = 0; k < places; ++k) {
      const int i = first + (2 * k + 1) * all / (2 * places);
      std::vector<bool> seen(world.views.size());
      for (int m = o.matches.first[i]; m < o.matches.first[i + 1]; ++m)
        seen[o.matches.matches[m].view] = true;
      for (size_t v = 0; v < world.views.size(); ++v) {
        Sight sight;
        sight.from = world.views[v].center_in_world();
        sight.to = o.samples.position.col(i);
        sight.seen = seen[v];
        sight.weight = 1.0 / places;
        evidence->sights.push_back(sight);
      }
    }
  }
}

// 1 or 0 if the mask is that all around a pixel, else -1.
int clear_mask(const Image<uint8_t>& mask, int x, int y) {
  if (x < kClearPx || y < kClearPx || x + kClearPx >= mask.width || y + kClearPx >= mask.height)
    return -1;
  for (int v = y - kClearPx; v <= y + kClearPx; ++v)
    for (int u = x - kClearPx; u <= x + kClearPx; ++u)
      if (mask.at(u, v) != mask.at(x, y)) return -1;
  return mask.at(x, y);
}

struct PixelBox {
  int x0, y0, x1, y1;
};

PixelBox box_of(const Image<uint8_t>& mask) {
  PixelBox box{mask.width, mask.height, -1, -1};
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.at(x, y))
        box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x), std::max(box.y1, y)};
  return box;
}

void add_rays(const View& view, const Image<uint8_t>& mask, const EdgeWorld& world,
              SolidEvidence* evidence) {
  const PixelBox box = box_of(mask);
  const Vector3d from = view.center_in_world();
  const double reach = (world.bounds.center() - from).norm() + world.bounds.diagonal().norm();
  for (int i = 0; i < kMaskGrid; ++i)
    for (int k = 0; k < kMaskGrid; ++k) {
      const int x = box.x0 + int((i + 0.5) / kMaskGrid * (box.x1 - box.x0)),
                y = box.y0 + int((k + 0.5) / kMaskGrid * (box.y1 - box.y0));
      const int object = clear_mask(mask, x, y);
      Vector2d ideal;
      if (object < 0 || !view.ideal_pixel(Vector2d(x, y), &ideal)) continue;
      const Vector3d ray = view.cam_from_world.rotation.transpose() * view.camera.ray(ideal);
      evidence->rays.push_back({from, from + ray.normalized() * reach, object == 1});
    }
}

// Every so many edgels of those that no stroke explains: as a rule, contours of round surfaces.
// With masks, those of their outlines, which are nothing else.
void add_contours(const Sketch& sketch, const EdgeWorld& world, SolidEvidence* evidence) {
  const EdgeWorld rest = unexplained(world, edgels_along(sketch, world), kLeastChain);
  const bool masked = std::any_of(world.maps.begin(), world.maps.end(),
                                  [](const EdgelMap& map) { return map.mask.width > 0; });
  size_t edgels = 0, passed = 0;
  for (const EdgelMap& map : rest.maps)
    for (const Edgel& e : map.edgels) edgels += e.outline || !masked;
  const size_t step = 1 + edgels / kContourLines;
  for (size_t v = 0; v < rest.views.size(); ++v)
    for (const Edgel& e : rest.maps[v].edgels) {
      if ((masked && !e.outline) || passed++ % step != 0) continue;
      const Vector3d ray = rest.views[v].camera.ray(Vector2d(e.x, e.y));
      evidence->contours.push_back(
          {rest.views[v].center_in_world(),
           (rest.views[v].cam_from_world.rotation.transpose() * ray).normalized()});
    }
}

// Which places of the strokes each view sees, rays through pixels well inside and well outside of
// the masks, and lines of sight through edgels that no stroke explains.
SolidEvidence solid_evidence(const Sketch& sketch, const EdgeWorld& world) {
  SolidEvidence evidence;
  add_sights(sketch, world, &evidence);
  add_contours(sketch, world, &evidence);
  const int views = int(world.views.size()), used = std::min(views, kMaskViews);
  for (int i = 0; i < used; ++i) {
    const int v = i * views / used;
    if (world.maps[v].mask.width > 0)
      add_rays(world.views[v], world.maps[v].mask, world, &evidence);
  }
  return evidence;
}

void refuse_if_edges_lack(const EdgeWorld& world, const Detector& detector, const LiftOptions& lift,
                          SolidSearch* search) {
  const LackingEdges lacking = lacking_edges(*search->solid, world, detector, lift);
  if (lacking.share <= kLacking) return;
  search->solid.reset();
  search->why = "the images show edges that no face has, about " +
                std::to_string(int(std::lround(100 * lacking.share))) + " % of all";
}

}  // namespace

SolidSearch close_solid(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                        const MethodRun& run) {
  SolidSearch search;
  if (run.options.solid == "off") {
    search.why = "it was not asked for";
    return search;
  }
  Stage stage("close solid", run.log);
  try {
    SolidOptions how;
    const double extent = largest_extent(sketch);
    if (extent > 0)
      how.tolerance = std::max(kLeastTolerance, kTolerancePx * world.footprint / extent);
    const SolidEvidence evidence = solid_evidence(sketch, world);
    if (evidence.rays.empty()) how.margin *= kWithoutMasks;
    search = find_solid(sketch, how, evidence);
    if (search.solid) refuse_if_edges_lack(world, detector, run.options.lift, &search);
  } catch (const std::runtime_error& e) {
    search.why = e.what();
  }
  stage.result(search.solid ? std::to_string(search.solid->faces.size()) + " faces"
                            : "none: " + search.why);
  return search;
}

}  // namespace sketchsplat
