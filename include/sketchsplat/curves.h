// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sketchsplat {

/// Kinds of curve. Their control points (columns of Curve::controls):
///   line          begin, end
///   arc           begin, the point half-way, end; circular, less than a turn
///   circle        centre, unit normal times radius
///   ellipse       centre, u, v: centre + cos(t) u + sin(t) v
///   bezier        begin, two inner control points, end; cubic
///   elliptic_arc  begin, the point half-way, a quarter point, end (docs/formats.md)
enum class CurveKind { kLine, kArc, kCircle, kEllipse, kBezier, kEllipticArc };
const char* name_of(CurveKind kind);  ///< "line", "arc", ...

/// One curve, and what the images say about it. Lengths are the scene's own.
struct Curve {
  CurveKind kind = CurveKind::kLine;
  int begin = -1, end = -1;  ///< columns of CurveSketch::nodes; -1 if it is closed
  Eigen::Matrix3Xd controls;
  double length = 0;
  /// Of arcs and circles, and the normal of ellipses and elliptic arcs; NaN where it means nothing.
  Eigen::Vector3d center = nan(), normal = nan();
  double radius = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d major = nan(), minor = nan();  ///< semi-axes of ellipses and elliptic arcs
  std::vector<int> views;                        ///< that see it: indices into CurveSketch::views
  double confidence = 0;  ///< probability that it is an edge, in [0, 1]; NaN if unknown
  bool inferred = false;  ///< no view sees it: the solid, or siblings of the part, imply it
  double rms_px = 0;      ///< [px] root mean square distance to the edges in the images
  double sigma = 0;       ///< largest standard deviation of a point of it, across it
  /// 3n x 3n of the n control points, x y z each; empty if unknown.
  Eigen::MatrixXd covariance;

  static Eigen::Vector3d nan() {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
};

/// How a reconstruction ended.
enum class Ending {
  kDone,
  kTooLittle,  ///< the images hold too little: no curve on which the views agree
  kCancelled,  ///< by Options::progress
};

/// How files for CAD programs are written.
struct WriteOptions {
  double scale = 1;         ///< units of the file per world unit; STEP, DXF, OBJ
  std::string unit = "mm";  ///< "mm", "cm", "m" or "inch"; STEP, DXF
  bool faces = false;       ///< closed planar loops as faces; STEP
};

/// The solid that curves bound. Copies share what is below.
class CurveSolid {
 public:
  /// How many lie on each kind of surface: "plane", "cylinder", "cone", "sphere", "torus".
  std::map<std::string, int> faces;
  double volume = 0, area = 0;  ///< the scene's own units

  /// Writes its exact boundary as .step; whole or not at all. Throws std::invalid_argument (ending,
  /// unit, scale) or std::runtime_error (cannot be written).
  void write(const std::string& path, const WriteOptions& options = {}) const;

 private:
  friend struct CurveSketchAccess;
  struct Inside;
  std::shared_ptr<const Inside> inside_;
};

/// The result: curves over shared nodes. Copies share what is below.
class CurveSketch {
 public:
  Eigen::Matrix3Xd nodes;  ///< 3 x N: ends of curves; curves that meet share a column
  std::vector<Curve> curves;
  /// Absent if the curves tell none (docs/solid.md), or {"solid", "off"} is among
  /// Options::expert.
  std::optional<CurveSolid> solid;
  std::vector<std::string> views;     ///< names of those that Curve::views counts
  std::vector<std::string> warnings;  ///< a line each, of views that were left out
  Ending ending = Ending::kDone;
  std::string message;  ///< why, if it is not kDone

  /// Points of a curve, uniform in arc length, both ends included, at most `spacing` apart; 3 x N.
  /// Throws std::invalid_argument if there is no such curve, or the spacing is not positive.
  Eigen::Matrix3Xd sample(int curve, double spacing) const;

  /// Writes a file in the format of its ending: .step, .dxf, .obj, .ply (points), .json (as
  /// sketch.json); whole or not at all. Throws std::invalid_argument (ending, unit) or
  /// std::runtime_error (cannot be written).
  void write(const std::string& path, const WriteOptions& options = {}) const;

 private:
  friend struct CurveSketchAccess;
  struct Inside;
  std::shared_ptr<const Inside> inside_;
};

/// Reads a sketch.json, or that of the folder which `sketchsplat reconstruct` wrote, and the solid
/// beside it. Throws std::runtime_error.
CurveSketch read_curves(const std::string& path);

}  // namespace sketchsplat
