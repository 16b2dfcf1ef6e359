// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "eval/inspect/sigma_model.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// The ways in which a surface can move within its kind.
enum class SurfaceMove {
  kAcrossX,  ///< shifts along two directions across the axis, and along it
  kAcrossY,
  kAlong,
  kTiltX,  ///< of the axis, towards these two
  kTiltY,
  kRadius,
  kSlope,
  kMinorRadius
};
const std::vector<SurfaceMove>& moves_of(SurfaceKind kind);

/// A surface moved; `by` as many numbers as its kind has moves, world units: tilts and slopes by
/// what they do at a distance of `reach`.
Surface moved(const Surface& surface, const Eigen::VectorXd& by, double reach);

/// How well the surfaces of a solid are known from its curves. Each surface is the least-squares
/// one through places along the seen curves of its faces, weighted by length; all surfaces
/// together, with axes that are exactly parallel or square held so. To first order their moves x
/// then follow from those of the curves,
///   x = -Z (Z^T A^T W A Z)^-1 Z^T A^T W d,
/// A: derivatives of the places' distances by the moves; d: distances by which errors of the curves
/// push the places off; Z: moves that keep what is held. The errors are those that `inspect` takes
/// (StrokeErrors): independent from stroke to stroke, counted once where two surfaces share one;
/// and, because edges in images err to one side of the material, what they err by as a whole
/// (SigmaModel::place) once more, across the surface, alike for all strokes of one surface.
class SurfaceErrors {
 public:
  /// Strokes that are inferred, of which nobody knows how well they are known, or which edgels
  /// leave open tell nothing.
  SurfaceErrors(const Solid& solid, const SigmaModel& sigma);

  /// Those of the solid; origins as near to the middle of their curves as the axes allow.
  const std::vector<Surface>& surfaces() const { return surfaces_; }
  double reach() const { return reach_; }  ///< of moves, see moved()

  /// Standard deviation of a number that these surfaces determine: value(surfaces()). NaN if the
  /// curves leave it open.
  using Value = std::function<double(const std::vector<Surface>&)>;
  double sigma(const Value& value, const std::vector<int>& of) const;

  /// Largest standard deviation in any direction of some moves of a surface (those that its kind
  /// has) together; NaN if one of them is open.
  double sigma(int surface, const std::vector<SurfaceMove>& moves) const;

 private:
  void centre(const Solid& solid);
  Eigen::MatrixXd held() const;  // rows: what is held, by all moves
  void solve(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& push);
  bool open(const Eigen::VectorXd& gradient) const;  // does it depend on what nobody knows?

  std::vector<Surface> surfaces_;
  std::vector<int> first_;  // of a surface's moves; one more at the end
  double reach_;
  Eigen::MatrixXd free_;    // columns: moves that keep what is held and no place tells of
  Eigen::MatrixXd kept_;    // columns: moves that keep what is held
  Eigen::MatrixXd errors_;  // moves x errors, one standard deviation each
};

}  // namespace sketchsplat
