// SPDX-License-Identifier: MIT
#include "pipelines/results/known_scale.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "eval/inspect/sigma_model.h"
#include "pipelines/base/sketch_input.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

using Kind = ScaleReference::Kind;

constexpr double kTagsDiffer = 5;      // standard deviations, and
constexpr double kTagsMayVary = 5e-3;  // of their size: printers stretch so much

struct Length {
  double value = 0, sigma = 0;  // world units
};

std::string option_text(const CadOptions& o) { return "--scale-by " + o.scale_by; }

// Standard deviations of strokes, as `inspect` has them.
class Errors {
 public:
  Errors(const Sketch& sketch, double footprint) : sketch_(sketch), footprint_(footprint) {
    sigma_.footprint = footprint;
    sigma_.bias_px = typical_bias_px(sketch);
  }

  // By the control points, and by the pull of blur towards the centre.
  double radius(int stroke) const {
    const double r = circle_parameters(sketch_, stroke).radius;
    const ControlPoints c = control_points(sketch_, stroke);
    Eigen::VectorXd by(3 * c.count);
    const double step = 1e-6 * r;
    for (int k = 0; k < by.size(); ++k)
      by[k] = (radius_with(stroke, k, step) - radius_with(stroke, k, -step)) / (2 * step);
    const double own = by.dot(calibrated_covariance(sketch_, stroke, sigma_) * by);
    const double bend = sigma_.radial_errors(sketch_, stroke, 0.5).norm();
    return std::sqrt(std::max(0.0, own) + bend * bend);
  }
  // As a whole across itself.
  double aside(int stroke) const {
    const Stroke& s = sketch_.strokes[stroke];
    const Evidence& e = sketch_.evidence[stroke];
    return std::hypot(sigma_.factor(s, e) * e.sigma, sigma_.place(s, e));
  }
  // Other strokes locate an end; without one, its edgels do, to a pixel.
  double node(int node) const {
    double most = 0;
    int held = 0;
    for (int i = 0; i < sketch_.size(); ++i)
      if (sketch_.strokes[i].begin == node || sketch_.strokes[i].end == node)
        most = std::max(most, aside(i)), ++held;
    return held > 1 ? most : std::max(most, footprint_);
  }

 private:
  double radius_with(int stroke, int coordinate, double step) const {
    Sketch s = sketch_;
    const Stroke& at = s.strokes[stroke];
    const int point = coordinate / 3, row = coordinate % 3;
    if (is_closed(at.kind))
      s.handles(row, at.handle + point) += step;
    else if (point == 1)
      s.handles(row, at.handle) += step;
    else
      s.nodes(row, point == 0 ? at.begin : at.end) += step;
    return circle_parameters(s, stroke).radius;
  }

  const Sketch& sketch_;
  double footprint_;
  SigmaModel sigma_;
};

Length longest_side(const Sketch& sketch, const Errors& errors) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  Eigen::Vector3i at_low = Eigen::Vector3i::Zero(), at_high = at_low;
  for (int i = 0; i < sketch.size(); ++i) {
    const double length = stroke_length(sketch, i);
    if (!(length > 0)) continue;
    const Eigen::Matrix3Xd p = sample_stroke(sketch, i, length / 256);
    for (int k = 0; k < 3; ++k) {
      if (p.row(k).minCoeff() < low[k]) low[k] = p.row(k).minCoeff(), at_low[k] = i;
      if (p.row(k).maxCoeff() > high[k]) high[k] = p.row(k).maxCoeff(), at_high[k] = i;
    }
  }
  int k = 0;
  const double value = (high - low).maxCoeff(&k);
  return {value, std::hypot(errors.aside(at_low[k]), errors.aside(at_high[k]))};
}

Length diameter_of(const Sketch& sketch, int stroke, const Errors& errors) {
  return {2 * circle_parameters(sketch, stroke).radius, 2 * errors.radius(stroke)};
}

int largest_circle(const Sketch& sketch) {
  int best = -1;
  for (int i = 0; i < sketch.size(); ++i)
    if (sketch.strokes[i].kind == StrokeKind::kCircle &&
        (best < 0 || circle_parameters(sketch, i).radius > circle_parameters(sketch, best).radius))
      best = i;
  return best;
}

// The stroke that is a curve of one of two kinds.
int stroke_of(const Sketch& sketch, int curve, StrokeKind kind, StrokeKind other,
              const std::string& where) {
  const std::vector<CurveChain> chains = curve_chains(sketch);
  const std::string wanted = std::string(kind == other ? "a " : "a circle or ") +
                             (kind == other ? "" : "an ") + kind_name(kind) + " as curve " +
                             std::to_string(curve);
  if (curve >= int(chains.size()))
    throw InputError(where, wanted, std::to_string(chains.size()) + " curves");
  const int s = chains[curve].strokes[0];
  const StrokeKind found = sketch.strokes[s].kind;
  if (found != kind && found != other) throw InputError(where, wanted, kind_name(found));
  if (found == StrokeKind::kArc && circle_parameters(sketch, s).straight)
    throw InputError(where, wanted, "an arc without bend");
  return s;
}

Length node_distance(const Sketch& sketch, int a, int b, const Errors& errors,
                     const std::string& where) {
  if (std::max(a, b) >= sketch.nodes.cols())
    throw InputError(where, "nodes " + std::to_string(a) + " and " + std::to_string(b),
                     std::to_string(sketch.nodes.cols()) + " nodes");
  return {(sketch.nodes.col(a) - sketch.nodes.col(b)).norm(),
          std::hypot(errors.node(a), errors.node(b))};
}

// The tags that are meant.
std::vector<TagSquare> tags_meant(const std::vector<TagSquare>& tags, int id,
                                  const std::string& where) {
  std::vector<TagSquare> out;
  for (const TagSquare& t : tags)
    if (id < 0 || t.id == id) out.push_back(t);
  if (out.empty()) {
    std::string found = tags.empty() ? "none" : "tags";
    for (const TagSquare& t : tags) found += " " + std::to_string(t.id);
    const std::string what = id < 0 ? "an AprilTag 36h11" : "the tag " + std::to_string(id);
    throw InputError(where, what + " in at least three pictures", found);
  }
  const TagSide all = common_side(out);
  for (const TagSquare& t : out) {
    const double off = std::abs(t.side - all.side);
    if (off > kTagsDiffer * t.sigma && off > kTagsMayVary * all.side)
      throw InputError(where, "tags of one size; tag:ID= takes one of them",
                       "tag " + std::to_string(t.id) + " that is " +
                           std::to_string(t.side / all.side) + " times as large as all");
  }
  return out;
}

Length length_of(const ScaleReference& r, const Sketch& sketch, double footprint,
                 const std::vector<TagSquare>& tags, const std::string& where) {
  if (r.kind == Kind::kTag) {
    const TagSide side = common_side(tags);
    return {side.side, side.sigma};
  }
  const Errors errors(sketch, footprint);
  switch (r.kind) {
    case Kind::kDiameter: {
      const int circle = largest_circle(sketch);
      if (circle < 0) throw InputError(where, "a full circle", "none");
      return diameter_of(sketch, circle, errors);
    }
    case Kind::kCircle:
      return diameter_of(
          sketch, stroke_of(sketch, r.first, StrokeKind::kArc, StrokeKind::kCircle, where), errors);
    case Kind::kLine: {
      const Stroke& s =
          sketch.strokes[stroke_of(sketch, r.first, StrokeKind::kLine, StrokeKind::kLine, where)];
      return node_distance(sketch, s.begin, s.end, errors, where);
    }
    case Kind::kNodes:
      return node_distance(sketch, r.first, r.second, errors, where);
    default:
      return longest_side(sketch, errors);
  }
}

}  // namespace

bool has_reference(const CadOptions& options) { return options.scale_by != "none"; }

bool wants_tags(const CadOptions& options) {
  return has_reference(options) && parse_scale_reference(options.scale_by).kind == Kind::kTag;
}

void check_scale(const CadOptions& options) {
  if (options.scale_given && has_reference(options))
    throw UsageError("--scale and --scale-by state the same thing: one of them, please");
}

KnownScale known_scale(const CadOptions& options, const Sketch& sketch, double footprint,
                       const std::vector<TagSquare>& tags) {
  KnownScale out;
  out.unit = options.unit;
  if (!has_reference(options)) {
    out.units_per_world = options.scale;
    if (options.scale_given) out.source = "--scale";
    return out;
  }
  const ScaleReference r = parse_scale_reference(options.scale_by);
  const std::string where = option_text(options);
  if (r.kind == Kind::kTag) out.tags = tags_meant(tags, r.first, where);
  const Length world = length_of(r, sketch, footprint, out.tags, where);
  if (!(world.value > 0)) throw InputError(where, "a length in the sketch", "none");
  const double length =
      r.unit ? r.length * millimetres(*r.unit) / millimetres(options.unit) : r.length;
  out.source = where;
  out.units_per_world = length / world.value;
  if (world.sigma > 0) out.sigma_relative = world.sigma / world.value;
  return out;
}

KnownScale stated_scale(const CadOptions& options, const std::string& sketch_json) {
  KnownScale out;
  out.unit = options.unit;
  std::ifstream in(sketch_json);
  const Json j = parse_json<Json>(in, sketch_json);
  if (!j.contains("scale") || !j["scale"].is_object()) return out;
  const Json& s = j["scale"];
  const std::vector<std::string> names = length_unit_names();
  const auto unit = std::find(names.begin(), names.end(), s.value("unit", std::string()));
  const bool has = s.contains("units_per_world") && s["units_per_world"].is_number();
  const double scale = has ? s["units_per_world"].get<double>() : 0;
  if (unit == names.end() || !(scale > 0) || !std::isfinite(scale))
    throw InputError(sketch_json, "a unit and units_per_world as \"scale\"",
                     json_text(s).substr(0, 60));
  const LengthUnit stated = LengthUnit(unit - names.begin());
  if (!options.unit_given) out.unit = stated;
  out.units_per_world = scale * millimetres(stated) / millimetres(out.unit);
  out.source = sketch_json;
  if (s.contains("sigma_relative") && s["sigma_relative"].is_number())
    out.sigma_relative = s["sigma_relative"].get<double>();
  return out;
}

CadOptions at_scale(CadOptions options, const KnownScale& scale) {
  options.scale = scale.units_per_world;
  options.unit = scale.unit;
  return options;
}

std::string scale_json(const KnownScale& scale) {
  Json out = {{"source", scale.source},
              {"unit", length_unit_names()[int(scale.unit)]},
              {"units_per_world", scale.units_per_world},
              {"world_per_unit", 1 / scale.units_per_world}};
  out["sigma_relative"] = std::isnan(scale.sigma_relative) ? Json() : Json(scale.sigma_relative);
  for (const TagSquare& t : scale.tags)
    out["tags"].push_back({{"id", t.id},
                           {"side", t.side},
                           {"sigma", t.sigma},
                           {"views", t.views},
                           {"rms_px", t.rms_px}});
  return json_text(out);
}

}  // namespace sketchsplat
