// SPDX-License-Identifier: MIT
#include "topology/brep/chart.h"

#include <ElSLib.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <cmath>
#include <limits>

namespace sketchsplat::brep {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSteps = 64;  // of a part: turns by less than half a period each

// By whole periods as near as can be.
Vector2d beside(const Vector2d& there, const Vector2d& period, Vector2d uv) {
  for (int k = 0; k < 2; ++k)
    if (period[k] > 0) uv[k] += period[k] * std::round((there[k] - uv[k]) / period[k]);
  return uv;
}

// A part in the chart without jumps, wherever its beginning lies. In a pole u goes on as before it.
Matrix2Xd trace_part(const Chart& chart, const CurvePart& part) {
  Matrix2Xd uv(2, kSteps + 1);
  std::vector<bool> singular(kSteps + 1);
  int first = -1;
  for (int i = 0; i <= kSteps; ++i) {
    const Vector3d p = part.point(double(i) / kSteps);
    singular[i] = chart.pole_at(p) >= 0;
    uv.col(i) = chart.parameters(p);
    if (singular[i]) continue;
    if (first >= 0) uv.col(i) = beside(uv.col(i - 1), chart.period(), uv.col(i));
    if (first < 0) first = i;
    if (i > first && singular[i - 1]) throw Refused("a curve runs through a pole");
  }
  if (first < 0) throw Refused("a curve is as small as a point");
  // Poles are ends of v's range, so only u needs help.
  for (int i = first - 1; i >= 0; --i) uv(0, i) = 2 * uv(0, i + 1) - uv(0, i + 2);
  for (int i = first + 1; i <= kSteps; ++i)
    if (singular[i]) uv(0, i) = i > 1 ? 2 * uv(0, i - 1) - uv(0, i - 2) : uv(0, i - 1);
  return uv;
}

// u where the chart's edge along a pole ends, begun at `from`, such that it differs from `to` by
// whole periods. The face lies to the left: above the lower pole, below the upper one.
double around_pole(int pole, double from, double to, double period) {
  constexpr double kSame = 1e-6;
  const double sense = pole == 0 ? 1 : -1;
  double turn = std::fmod(sense * (to - from), period);
  if (turn < kSame) turn += period;
  if (turn < kSame) turn += period;
  return from + sense * turn;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

Chart::Chart(const Handle(Geom_Surface) & surface, double near)
    : surface_(surface), adaptor_(surface), near_(near) {
  poles_.fill(std::numeric_limits<double>::quiet_NaN());
  const GeomAbs_SurfaceType type = adaptor_.GetType();
  if (surface->IsUPeriodic()) period_[0] = surface->UPeriod();
  if (type == GeomAbs_Torus) period_[1] = 2 * M_PI;
  if (type == GeomAbs_Sphere) poles_ = {-M_PI / 2, M_PI / 2};
  if (type == GeomAbs_Cone)
    poles_[0] = -adaptor_.Cone().RefRadius() / std::sin(adaptor_.Cone().SemiAngle());
}

Vector2d Chart::on_extrusion(const Vector3d& p) const {
  const auto surface = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface_);
  const Handle(Geom_Curve) profile = surface->BasisCurve();
  const gp_Dir along = surface->Direction();
  const Vector3d axis(along.X(), along.Y(), along.Z());
  const double low = profile->FirstParameter(), high = profile->LastParameter();
  const double up = (p - to_eigen(profile->Value(low))).dot(axis);
  const gp_Pnt foot = to_point(p - up * axis);
  double u = low, least = foot.Distance(profile->Value(low));
  const auto offer = [&](double at, double distance) {
    if (distance < least) u = at, least = distance;
  };
  offer(high, foot.Distance(profile->Value(high)));
  const GeomAPI_ProjectPointOnCurve projection(foot, profile, low, high);
  if (projection.NbPoints() > 0)
    offer(projection.LowerDistanceParameter(), projection.LowerDistance());
  return {u, (p - to_eigen(profile->Value(u))).dot(axis)};
}

Vector2d Chart::parameters(const Vector3d& p) const {
  if (extruded()) return on_extrusion(p);
  double u = 0, v = 0;
  switch (adaptor_.GetType()) {
    case GeomAbs_Plane:
      ElSLib::Parameters(adaptor_.Plane(), to_point(p), u, v);
      break;
    case GeomAbs_Cylinder:
      ElSLib::Parameters(adaptor_.Cylinder(), to_point(p), u, v);
      break;
    case GeomAbs_Cone:
      ElSLib::Parameters(adaptor_.Cone(), to_point(p), u, v);
      break;
    case GeomAbs_Sphere:
      ElSLib::Parameters(adaptor_.Sphere(), to_point(p), u, v);
      break;
    default:
      ElSLib::Parameters(adaptor_.Torus(), to_point(p), u, v);
  }
  return {u, v};
}

Vector3d Chart::point(const Vector2d& uv) const {
  return to_eigen(surface_->Value(uv.x(), uv.y()));
}

int Chart::pole_at(const Vector3d& p) const {
  for (int k = 0; k < 2; ++k)
    if (!std::isnan(poles_[k]) && (point({0, poles_[k]}) - p).norm() < near_) return k;
  return -1;
}

Trace trace(const Chart& chart, const std::vector<CurvePart>& parts) {
  Trace out;
  const Vector2d& period = chart.period();
  for (const CurvePart& part : parts) {
    out.uv.push_back(trace_part(chart, part));
    out.pole.push_back(chart.pole_at(part.point(1)));
  }
  const auto next_begin = [&](size_t i) -> Vector2d {
    const Vector2d end = out.uv[i].rightCols<1>(), begin = out.uv[(i + 1) % parts.size()].col(0);
    if (out.pole[i] < 0) return beside(end, period, begin);
    return {around_pole(out.pole[i], end[0], begin[0], period[0]), begin[1]};
  };
  for (size_t i = 0; i < parts.size(); ++i) {
    const Vector2d begin = next_begin(i);
    if (i + 1 == parts.size()) {
      out.end = begin;
      continue;
    }
    const Vector2d shift = begin - out.uv[i + 1].col(0);
    out.uv[i + 1].colwise() += shift;
  }
  const Vector2d start = out.uv[0].col(0);
  for (int k = 0; k < 2; ++k)
    if (period[k] > 0) out.winding[k] = int(std::lround((out.end[k] - start[k]) / period[k]));
  Vector2d last = start;
  for (const Matrix2Xd& uv : out.uv)
    for (int i = 0; i < uv.cols(); ++i) {
      out.area += cross(last - start, uv.col(i) - start) / 2;
      last = uv.col(i);
    }
  out.area += cross(last - start, out.end - start) / 2;
  return out;
}

}  // namespace sketchsplat::brep
