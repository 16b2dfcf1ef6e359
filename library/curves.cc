// SPDX-License-Identifier: MIT
#include "sketchsplat/curves.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "library/access.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/sketch_input.h"
#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/graph/inferred.h"
#include "sketches/io/io.h"
#include "sketches/solve/covariance.h"
#include "topology/faces/planar_faces.h"

namespace sketchsplat {
namespace {

constexpr double kPointSpacing = 0.005;  // of the extent, in PLY

void describe_conic(const Sketch& sketch, int i, const ControlPoints& control, Curve* c) {
  if (c->kind == CurveKind::kArc || c->kind == CurveKind::kCircle) {
    const CircleParameters circle = circle_parameters(sketch, i);
    if (circle.straight) return;
    c->center = circle.centre, c->normal = circle.normal, c->radius = circle.radius;
    return;
  }
  EllipseAxes axes;
  if (c->kind == CurveKind::kEllipse) {
    c->center = control.p[0], axes = principal_axes(control.p[1], control.p[2]);
  } else {
    const EllipticArcParameters arc = elliptic_arc_parameters(control);
    if (arc.straight) return;
    c->center = arc.centre, axes = principal_axes(arc.p, arc.q);
  }
  c->major = axes.major, c->minor = axes.minor;
  c->normal = axes.major.cross(axes.minor).normalized();
}

Curve curve_of(const Sketch& sketch, int i) {
  const Stroke& s = sketch.strokes[i];
  const ControlPoints control = control_points(sketch, i);
  Curve c;
  c.kind = CurveKind(s.kind);
  c.begin = s.begin, c.end = s.end;
  c.controls.resize(3, control.count);
  for (int k = 0; k < control.count; ++k) c.controls.col(k) = control.p[k];
  c.length = stroke_length(sketch, i);
  if (s.kind != StrokeKind::kLine && s.kind != StrokeKind::kBezier)
    describe_conic(sketch, i, control, &c);
  const Evidence& e = sketch.evidence[i];
  c.views = e.views;
  c.confidence = e.confidence, c.rms_px = e.rms_px, c.sigma = e.sigma;
  c.inferred = is_inferred(e);
  if (!e.covariance.empty()) c.covariance = from_upper_triangle(e.covariance);
  return c;
}

void write_as(const std::string& ending, const std::string& name, const Sketch& sketch,
              const WriteOptions& options, std::ostream& out) {
  const LengthUnit unit = unit_of(options.unit);
  const double extent = largest_extent(sketch);
  if (ending == ".step") {
    StepOptions step;
    step.name = name, step.scale = options.scale, step.unit = unit;
    if (options.faces) step.faces = planar_faces(sketch);
    write_step(out, sketch, step);
  } else if (ending == ".dxf") {
    write_dxf(out, sketch, {options.scale, unit});
  } else if (ending == ".obj") {
    write_obj(out, sketch, 1e-4, options.scale);
  } else if (ending == ".ply") {
    write_edge_points(out, sketch, kPointSpacing * (extent > 0 ? extent : 1));
  } else {
    write_sketch_json(out, sketch);
  }
}

}  // namespace

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".stp" ? ".step" : ending;
}

LengthUnit unit_of(const std::string& name) {
  const std::vector<std::string> names = length_unit_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw std::invalid_argument("unit: expected mm, cm, m or inch, found " + name);
  return LengthUnit(at - names.begin());
}

const char* name_of(CurveKind kind) { return kind_name(StrokeKind(kind)); }

CurveSketch CurveSketchAccess::make(Sketch sketch) {
  static_assert(int(CurveKind::kEllipticArc) == int(StrokeKind::kEllipticArc) &&
                int(CurveKind::kBezier) == int(StrokeKind::kBezier));
  CurveSketch out;
  out.nodes = sketch.nodes;
  for (int i = 0; i < sketch.size(); ++i) out.curves.push_back(curve_of(sketch, i));
  out.inside_ = std::make_shared<const CurveSketch::Inside>(CurveSketch::Inside{std::move(sketch)});
  return out;
}

const Sketch& CurveSketchAccess::sketch(const CurveSketch& curves) {
  static const Sketch none;
  return curves.inside_ ? curves.inside_->sketch : none;
}

Eigen::Matrix3Xd CurveSketch::sample(int curve, double spacing) const {
  const Sketch& sketch = CurveSketchAccess::sketch(*this);
  if (curve < 0 || curve >= sketch.size())
    throw std::invalid_argument("sample: expected a curve below " + std::to_string(sketch.size()) +
                                ", found " + std::to_string(curve));
  if (!(spacing > 0)) throw std::invalid_argument("sample: expected a positive spacing");
  return sample_stroke(sketch, curve, spacing);
}

void CurveSketch::write(const std::string& path, const WriteOptions& options) const {
  const std::string ending = ending_of(path);
  const char* const known[] = {".step", ".dxf", ".obj", ".ply", ".json"};
  if (std::find(std::begin(known), std::end(known), ending) == std::end(known))
    throw std::invalid_argument(path + ": expected .step, .dxf, .obj, .ply or .json");
  if (!(options.scale > 0)) throw std::invalid_argument("scale: expected a positive number");
  const std::string name = std::filesystem::path(path).stem().string();
  write_atomically(path, [&](std::ostream& out) {
    write_as(ending, name, CurveSketchAccess::sketch(*this), options, out);
  });
}

CurveSketch read_curves(const std::string& path) {
  CurveSketch out = CurveSketchAccess::make(read_sketch(path));
  std::error_code none;
  if (!std::filesystem::exists(solid_file(path), none)) return out;
  std::string why;
  out.solid = CurveSketchAccess::make(read_solid(path), &why);
  if (!out.solid) out.warnings.push_back(solid_file(path) + ": " + why);
  return out;
}

}  // namespace sketchsplat
