// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/write_abc.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/synthetic/cad/curve_kind.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/conic.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

std::string text(double x) {
  char out[32];
  std::snprintf(out, sizeof out, "%.15g", x == 0 ? 0.0 : x);
  // YAML 1.1 takes a number for a float only if it has a point.
  if (!std::strpbrk(out, ".en")) return std::string(out) + ".0";
  return out;
}
std::string text(int x) { return std::to_string(x); }
std::string text(const Vector3d& p) {
  return "[" + text(p.x()) + ", " + text(p.y()) + ", " + text(p.z()) + "]";
}
template <typename List>
std::string list(const List& values) {
  std::string out;
  for (const auto& value : values) out += (out.empty() ? "" : ", ") + text(value);
  return "[" + out + "]";
}

// The points of all curves, numbered; ends that meet share a number.
class Vertices {
 public:
  explicit Vertices(double tolerance) : tolerance_(tolerance) {}

  std::vector<int> add(const Matrix3Xd& curve) {
    std::vector<int> numbers;
    const Eigen::Index last = curve.cols() - 1;
    for (Eigen::Index i = 0; i <= last; ++i)
      numbers.push_back(i == 0 || i == last ? end(curve.col(i)) : append(curve.col(i)));
    return numbers;
  }
  const std::vector<Vector3d>& points() const { return points_; }

 private:
  int append(const Vector3d& p) {
    points_.push_back(p);
    return int(points_.size()) - 1;
  }
  int end(const Vector3d& p) {
    for (int i : ends_)
      if ((points_[i] - p).norm() <= tolerance_) return i;
    ends_.push_back(append(p));
    return ends_.back();
  }

  double tolerance_;
  std::vector<Vector3d> points_;
  std::vector<int> ends_;
};

using Entry = std::map<std::string, std::string>;  // sorted by key, as ABC's are

Entry line_entry(const Matrix3Xd& p) {
  const Vector3d along = (p.rightCols<1>() - p.leftCols<1>()).normalized();
  std::vector<double> t;
  for (Eigen::Index i = 0; i < p.cols(); ++i) t.push_back((p.col(i) - p.col(0)).dot(along));
  return {{"direction", text(along)},
          {"location", text(Vector3d(p.col(0)))},
          {"type", "Line"},
          {"vert_parameters", list(t)}};
}

Entry conic_entry(const CurveShape& shape, const Matrix3Xd& p) {
  const double a = shape.u.norm(), b = shape.v.norm();
  std::vector<double> t;
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const Vector3d r = p.col(i) - shape.centre;
    const double angle = std::atan2(r.dot(shape.v) / (b * b), r.dot(shape.u) / (a * a));
    t.push_back(i == 0 ? angle : t.back() + std::remainder(angle - t.back(), 2 * M_PI));
  }
  Entry entry = {{"location", text(shape.centre)},
                 {"x_axis", text(Vector3d(shape.u / a))},
                 {"y_axis", text(Vector3d(shape.v / b))},
                 {"z_axis", text(Vector3d(shape.u.cross(shape.v).normalized()))},
                 {"vert_parameters", list(t)}};
  if (shape.kind == CurveShape::kCircular) {
    entry["type"] = "Circle";
    entry["radius"] = text(a);
  } else {
    const Vector3d focus = shape.u / a * std::sqrt(std::max(0.0, a * a - b * b));
    entry["type"] = "Ellipse";
    entry["x_radius"] = text(a);
    entry["y_radius"] = text(b);
    entry["focus1"] = text(Vector3d(shape.centre + focus));
    entry["focus2"] = text(Vector3d(shape.centre - focus));
  }
  return entry;
}

// Cubics one after another are one B-spline whose inner knots count three times.
Entry spline_entry(const Sketch& sketch, const std::vector<int>& strokes, const TruthCurve& curve) {
  std::string poles;
  std::vector<double> knots = {0, 0, 0, 0}, weights(3 * strokes.size() + 1, 1.0), t;
  for (size_t k = 0; k < strokes.size(); ++k) {
    const ControlPoints c = control_points(sketch, strokes[k]);
    for (int i = k == 0 ? 0 : 1; i < 4; ++i) poles += (poles.empty() ? "" : ", ") + text(c.p[i]);
    knots.insert(knots.end(), 3, double(k + 1));
  }
  knots.push_back(double(strokes.size()));
  size_t at = 0;
  for (Eigen::Index i = 0; i < curve.points.cols(); ++i) {
    const auto near = [&](size_t k) {
      return distance_to_stroke(sketch, strokes[k], curve.points.col(i));
    };
    ClosestPoint best = near(at);
    for (; at + 1 < strokes.size(); ++at) {
      const ClosestPoint next = near(at + 1);
      if (!(next.distance < best.distance)) break;
      best = next;
    }
    t.push_back(double(at) + best.t);
  }
  // The ends of a closed curve are as near to one another as to themselves.
  t.front() = 0, t.back() = double(strokes.size());
  return {{"closed", curve.closed ? "true" : "false"},
          {"continuity", "'C0'"},
          {"degree", "3"},
          {"knots", list(knots)},
          {"poles", "[" + poles + "]"},
          {"rational", "false"},
          {"type", "BSpline"},
          {"vert_parameters", list(t)},
          {"weights", list(weights)}};
}

CurveShape shape_of(const Sketch& sketch, int stroke, const TruthCurve& curve) {
  const ControlPoints c = control_points(sketch, stroke);
  CurveShape shape;
  if (sketch.strokes[stroke].kind == StrokeKind::kEllipse) {
    shape.kind = CurveShape::kElliptic;
    shape.centre = c.p[0], shape.u = c.p[1], shape.v = c.p[2];
    return shape;
  }
  if (sketch.strokes[stroke].kind == StrokeKind::kEllipticArc) {
    const EllipticArcParameters e = elliptic_arc_parameters(c);
    const EllipseAxes axes = principal_axes(e.p, e.q);
    shape.kind = CurveShape::kElliptic;
    shape.centre = e.centre, shape.u = axes.major, shape.v = axes.minor;
    return shape;
  }
  // Points of a mesh lie beside their circle: what the stroke says counts, not what they do.
  Vector3d axis;
  if (sketch.strokes[stroke].kind == StrokeKind::kCircle) {
    shape.centre = c.p[0], axis = c.p[1];
    shape.u = (curve.points.col(0) - shape.centre).normalized() * axis.norm();
  } else {
    const Vector3d u = c.p[1] - c.p[0], v = c.p[2] - c.p[0];
    axis = u.cross(v);
    shape.centre = c.p[0] + (u.squaredNorm() * v.cross(axis) + v.squaredNorm() * axis.cross(u)) /
                                (2 * axis.squaredNorm());
    shape.u = c.p[0] - shape.centre;
  }
  shape.kind = CurveShape::kCircular;
  shape.v = axis.normalized().cross(shape.u);
  return shape;
}

Entry entry_of(const Truth& truth, int index, const std::vector<int>& strokes, double tolerance) {
  const TruthCurve& curve = truth.curves[index];
  const StrokeKind kind = truth.sketch.strokes[strokes[0]].kind;
  if (kind == StrokeKind::kLine) return line_entry(curve.points);
  if (kind != StrokeKind::kBezier)
    return conic_entry(shape_of(truth.sketch, strokes[0], curve), curve.points);
  if (curve.type == "Ellipse") {
    const CurveShape shape = recognise(curve.points, tolerance, 0);
    if (shape.kind == CurveShape::kElliptic) return conic_entry(shape, curve.points);
  }
  return spline_entry(truth.sketch, strokes, curve);
}

std::string yaml(const Entry& entry) {
  std::string out;
  for (const auto& [key, value] : entry)
    out += (out.empty() ? "- " : "  ") + key + ": " + value + "\n";
  return out;
}

class Writer {
 public:
  explicit Writer(const SyntheticScene& scene)
      : longest_(1 / scene.cad->frame.scale), vertices_(1e-9 * longest_) {
    const UnitFrame& frame = scene.cad->frame;
    const double extent = scene.options.extent;
    // The middle of the world's box lies at half an extent.
    const Vector3d shift = frame.centre - Vector3d::Constant(0.5 * longest_);
    add(transformed(scene.truth, longest_ / extent, shift), true);
    add(transformed(scene.cad->smooth, longest_, frame.centre), false);
    add_mesh(scene.cad->mesh, frame);
  }

  std::string features() const { return "curves:\n" + curves_ + "surfaces:\n" + surfaces_; }
  std::string obj() const { return obj_; }
  nlohmann::json stats(const SyntheticScene& scene) const {
    const UnitFrame& frame = scene.cad->frame;
    const Vector3d low = frame.centre - frame.size / 2, high = frame.centre + frame.size / 2;
    std::vector<double> box;
    for (const Vector3d& p : {low, high, frame.size}) box.insert(box.end(), p.data(), p.data() + 3);
    return {{"#edges", int(curve_types_.size())},
            {"#faces", triangles_},
            {"#parts", 1},
            {"#sharp", sharp_},
            {"#surfs", int(surface_types_.size())},
            {"#verts", verts_},
            {"bbox", box},
            {"curves", curve_types_},
            {"model", scene.options.part},
            {"surfs", surface_types_}};
  }

 private:
  void add(const Truth& truth, bool sharp) {
    std::vector<std::vector<int>> strokes(truth.curves.size());
    for (int s = 0; s < truth.sketch.size(); ++s) strokes[truth.curve_of_stroke[s]].push_back(s);
    for (size_t c = 0; c < strokes.size(); ++c) {
      if (strokes[c].empty()) continue;
      Entry entry = entry_of(truth, int(c), strokes[c], 1e-6 * longest_);
      entry["sharp"] = sharp ? "true" : "false";
      entry["vert_indices"] = list(vertices_.add(truth.curves[c].points));
      curve_types_.push_back(entry["type"]);
      sharp_ += sharp;
      curves_ += yaml(entry);
    }
  }

  void add_mesh(const SurfaceMesh& mesh, const UnitFrame& frame) {
    const int first = int(vertices_.points().size());
    const auto vertex = [&](const Vector3d& p) {
      obj_ += "v " + text(p.x()) + " " + text(p.y()) + " " + text(p.z()) + "\n";
    };
    for (const Vector3d& p : vertices_.points()) vertex(p);
    for (const Eigen::Vector3f& p : mesh.points)
      vertex(p.cast<double>() / frame.scale + frame.centre);
    verts_ = first + int(mesh.points.size());
    triangles_ = int(mesh.corners.size());
    std::map<int, std::vector<int>> triangles_of;
    for (int i = 0; i < triangles_; ++i) {
      triangles_of[mesh.face[i]].push_back(i);
      obj_ += "f";
      for (unsigned k : mesh.corners[i]) obj_ += " " + std::to_string(first + int(k) + 1);
      obj_ += "\n";
    }
    for (const auto& [face, triangles] : triangles_of) {
      surface_types_.push_back(mesh.types.empty() ? "Other" : mesh.types[face]);
      std::set<int> corners;
      for (int i : triangles)
        for (unsigned k : mesh.corners[i]) corners.insert(first + int(k));
      surfaces_ += yaml({{"face_indices", list(triangles)},
                         {"type", surface_types_.back()},
                         {"vert_indices", list(corners)}});
    }
  }

  double longest_;  // side of the box, units of the CAD file
  Vertices vertices_;
  std::string curves_, surfaces_, obj_;
  std::vector<std::string> curve_types_, surface_types_;
  int sharp_ = 0, triangles_ = 0, verts_ = 0;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> abc_files(const SyntheticScene& scene) {
  const Writer writer(scene);
  return {{"feat/model_features_000.yml", writer.features()},
          {"obj/model_trimesh_000.obj", writer.obj()},
          {"chunk_0000_stats.json", json_text(nlohmann::json{{"model", writer.stats(scene)}}, 1)}};
}

}  // namespace sketchsplat
