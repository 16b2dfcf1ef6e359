// SPDX-License-Identifier: MIT
#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Precision.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>
#include <algorithm>
#include <cmath>

#include "topology/brep/chart.h"

namespace sketchsplat::brep {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

// (u, v) of a part's curve at a parameter, on the trace's side of every period.
class Tracer {
 public:
  Tracer(const Chart& chart, const CurvePart& part, const Matrix2Xd& uv)
      : chart_(chart), part_(part), uv_(part.forward ? uv : Matrix2Xd(uv.rowwise().reverse())) {}

  Vector2d operator()(double share) const {
    const Vector3d p = point(share);
    const double x = share * double(uv_.cols() - 1);
    const int i = std::min(int(x), int(uv_.cols()) - 2);
    const Vector2d near = uv_.col(i) + (x - i) * (uv_.col(i + 1) - uv_.col(i));
    if (chart_.pole_at(p) >= 0) return near;
    Vector2d uv = chart_.parameters(p);
    for (int k = 0; k < 2; ++k) {
      const double period = chart_.period()[k];
      if (period > 0) uv[k] += period * std::round((near[k] - uv[k]) / period);
    }
    return uv;
  }
  double parameter(double share) const { return part_.first + share * (part_.last - part_.first); }
  Vector3d point(double share) const { return to_eigen(part_.curve->Value(parameter(share))); }
  /// Largest distance of the curve from the surface, or from a curve in the chart.
  double gap(const Geom2d_Curve* curve, int steps) const {
    double most = 0;
    for (int i = 0; i <= steps; ++i) {
      const double share = double(i) / steps;
      Vector2d uv;
      if (curve) {
        const gp_Pnt2d p = curve->Value(parameter(share));
        uv = {p.X(), p.Y()};
      } else {
        uv = (*this)(share);
      }
      most = std::max(most, (chart_.point(uv) - point(share)).norm());
    }
    return most;
  }

 private:
  const Chart& chart_;
  const CurvePart& part_;
  const Matrix2Xd uv_;
};

// A line of unit speed along u or v, through the middle of the curve; null if it is not like that.
Handle(Geom2d_Line) isoline(const CurvePart& part, const Tracer& uv_at) {
  const Vector2d speed = (uv_at(1) - uv_at(0)) / (part.last - part.first);
  int k;
  speed.cwiseAbs().maxCoeff(&k);
  if (std::abs(std::abs(speed[k]) - 1) > 1e-2 || std::abs(speed[1 - k]) > 1e-2) return nullptr;
  Vector2d direction = Vector2d::Zero();
  direction[k] = speed[k] > 0 ? 1 : -1;
  constexpr int kSteps = 16;
  Vector2d origin = Vector2d::Zero();
  for (int i = 0; i <= kSteps; ++i) {
    const double share = double(i) / kSteps;
    origin += (uv_at(share) - direction * uv_at.parameter(share)) / (kSteps + 1);
  }
  return new Geom2d_Line(gp_Pnt2d(origin.x(), origin.y()), gp_Dir2d(direction.x(), direction.y()));
}

Handle(Geom2d_Curve) spline(const Tracer& uv_at, int steps) {
  const Handle(TColgp_HArray1OfPnt2d) points = new TColgp_HArray1OfPnt2d(1, steps + 1);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    const Vector2d uv = uv_at(double(i) / steps);
    points->SetValue(i + 1, gp_Pnt2d(uv.x(), uv.y()));
    parameters->SetValue(i + 1, uv_at.parameter(double(i) / steps));
  }
  Geom2dAPI_Interpolate interpolation(points, parameters, /*PeriodicFlag=*/false, 1e-12);
  interpolation.Perform();
  if (!interpolation.IsDone()) throw Refused("a curve has no image on its face");
  return Handle(Geom2d_Curve)(interpolation.Curve());
}

}  // namespace

Handle(Geom2d_Curve)
    curve_in_chart(const Chart& chart, const CurvePart& part, const Matrix2Xd& uv, double* gap) {
  const Tracer uv_at(chart, part, uv);
  constexpr int kCheck = 4 * 64 + 1;  // no multiple of the steps below: between their points, too
  const double enough = 1.5 * uv_at.gap(nullptr, kCheck) + 0.05 * Precision::Confusion();
  const Handle(Geom2d_Line) line = isoline(part, uv_at);
  double off = line.IsNull() ? 0 : uv_at.gap(line.get(), kCheck);
  if (!line.IsNull() && off <= enough) {
    *gap = std::max(*gap, off);
    return Handle(Geom2d_Curve)(line);
  }
  Handle(Geom2d_Curve) curve;
  for (int steps = 16; steps <= 512; steps *= 2) {
    curve = spline(uv_at, steps);
    off = uv_at.gap(curve.get(), kCheck);
    if (off <= enough) break;
  }
  *gap = std::max(*gap, off);
  return curve;
}

}  // namespace sketchsplat::brep
