// SPDX-License-Identifier: MIT
#include "edges/depth/edgel_support.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/depth/geometry_places.h"
#include "edges/depth/geometry_sides.h"

namespace sketchsplat {
namespace {

constexpr int kFewest = 4;  // pixels of a side that says where the surface is

double sureness(double value, double threshold) {
  return value * value / (value * value + threshold * threshold);
}

EdgelSupport support_at(const GeometryFields& f, const Edgel& e, double depth,
                        const GeometryOptions& options) {
  const Place p{e.x, e.y, e.nx, e.ny};
  const Side a = fit_side(f, p, -1), b = fit_side(f, p, +1);
  const double unit = focal(f.camera);
  const auto off = [&](const Side& side) {
    return side.samples < kFewest ? 1e3 : std::abs(unit * (1 / (side.inverse * depth) - 1));
  };
  EdgelSupport out;
  out.off_px = float(std::min(off(a), off(b)));
  if (e.outline) {
    out = {1, 0};  // the mask says so, wherever the surface is
  } else if (a.extent >= kLinear && b.extent >= kLinear) {
    const double jump = sureness(jump_of(a, b, unit), options.jump_px + bend_of(a, b, unit));
    const double turn = std::max(0.0, turn_of(a, b) - steady_turn(a, b));
    out.edge = float(std::max(jump, sureness(turn, options.crease_deg * M_PI / 180)));
  }
  return out;
}

}  // namespace

ObjectMaps object_maps(const GeometryMaps& maps, const Camera& camera) {
  const cv::Rect box = object_box(maps);
  if (box.empty()) return {};
  return {cut_maps(maps, box), camera.cut(box.x, box.y, box.width, box.height), box.x, box.y};
}

std::vector<EdgelSupport> edgel_support(const ObjectMaps& object, const EdgelMap& edgels,
                                        const std::vector<EdgelPlace>& places,
                                        const GeometryOptions& options) {
  std::vector<EdgelSupport> out(places.size());
  if (object.maps.depth.empty() || places.empty()) return out;
  GeometryFields f = make_fields(object.maps, object.camera);
  if (cv::countNonZero(f.valid) == 0) return out;
  measure_activity(depth_slopes(f, options.sigma_px), normal_slopes(f, options.sigma_px),
                   options.jump_px, options.crease_deg * M_PI / 180, &f);
  for (size_t i = 0; i < places.size(); ++i) {
    Edgel e = edgels.edgels[places[i].edgel];
    e.x -= float(object.x0), e.y -= float(object.y0);
    out[i] = support_at(f, e, places[i].depth, options);
  }
  return out;
}

}  // namespace sketchsplat
