// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Geom2d_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Surface.hxx>
#include <array>
#include <vector>

#include "topology/brep/geometry.h"

namespace sketchsplat::brep {

/// Parameters (u, v) of a plane, cylinder, cone, sphere or torus, or of an extrusion across its
/// profile.
class Chart {
 public:
  /// `near`: from where on a point lies in a pole.
  Chart(const Handle(Geom_Surface) & surface, double near);

  const Handle(Geom_Surface) & surface() const { return surface_; }
  /// Of the nearest point of the surface, in its own range.
  Eigen::Vector2d parameters(const Eigen::Vector3d& p) const;
  Eigen::Vector3d point(const Eigen::Vector2d& uv) const;
  const Eigen::Vector2d& period() const { return period_; }  ///< 0 where there is none
  /// v of the pole below and above, where all u are one point; NaN where there is none.
  double pole(int which) const { return poles_[which]; }
  int pole_at(const Eigen::Vector3d& p) const;  ///< 0 below, 1 above, -1 none
  bool flat() const { return adaptor_.GetType() == GeomAbs_Plane; }
  bool extruded() const { return adaptor_.GetType() == GeomAbs_SurfaceOfExtrusion; }

 private:
  Eigen::Vector2d on_extrusion(const Eigen::Vector3d& p) const;

  Handle(Geom_Surface) surface_;
  GeomAdaptor_Surface adaptor_;
  Eigen::Vector2d period_ = Eigen::Vector2d::Zero();
  std::array<double, 2> poles_;
  double near_;
};

/// A part of a curve, run as the parameter grows or the other way.
struct CurvePart {
  Handle(Geom_Curve) curve;
  double first = 0, last = 0;
  bool forward = true;
  /// Parameter at a share of the way, in [0, 1].
  double at(double share) const {
    return forward ? first + share * (last - first) : last - share * (last - first);
  }
  Eigen::Vector3d point(double share) const { return to_eigen(curve->Value(at(share))); }
};

/// A closed loop of parts in the chart, without jumps but those around a pole.
struct Trace {
  std::vector<Eigen::Matrix2Xd> uv;  ///< per part, at equal steps of its parameter, along the loop
  std::vector<int> pole;  ///< per part, that it ends in; the chart's edge there leads to the next
  Eigen::Vector2i winding = Eigen::Vector2i::Zero();  ///< in u and v
  double area = 0;  ///< that it encloses in the chart, positive if counter-clockwise
  Eigen::Vector2d end = Eigen::Vector2d::Zero();  ///< where it closes: begin + winding * period
};
/// What belongs to the face lies to the left of the parts, seen from the tip of the normal.
/// Throws Refused if a curve runs through a pole.
Trace trace(const Chart& chart, const std::vector<CurvePart>& parts);

/// The part in the chart, over the parameters of its curve, along its trace; isoparametric ones as
/// lines. `gap`: raised to the largest distance between the two.
Handle(Geom2d_Curve) curve_in_chart(const Chart& chart, const CurvePart& part,
                                    const Eigen::Matrix2Xd& uv, double* gap);

}  // namespace sketchsplat::brep
