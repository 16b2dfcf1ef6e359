// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "sketches/graph/solid.h"

namespace sketchsplat::brep {

/// Why a solid cannot be built, in one clause. Nobody outside of this folder sees it.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Does what asks OpenCASCADE, whose failures become Refused; std::bad_alloc where memory runs out.
template <typename Work>
auto with_refusals(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const std::string what = failure.GetMessageString() ? failure.GetMessageString() : "";
    throw Refused("OpenCASCADE gives up" + (what.empty() ? "" : ": " + what));
  }
}

inline gp_Pnt to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
inline gp_Dir to_direction(const Eigen::Vector3d& d) { return {d.x(), d.y(), d.z()}; }
inline Eigen::Vector3d to_eigen(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// A stroke between two parameters of an unbounded curve; it runs as the parameter grows.
struct EdgeCurve {
  Handle(Geom_Curve) curve;
  double first = 0, last = 0;
  bool closed = false;  ///< any parameter may be the first one, last - first is the period
};
/// Lines, circles and ellipses as such, cubics as B-splines. Arcs with a sagitta below `flat` are
/// lines. Throws Refused if the stroke has no length.
EdgeCurve curve_of(const Sketch& sketch, int stroke, double flat);

/// Where two surfaces meet, along a stroke that lies beside them: a B-spline through many places of
/// it. Nothing is changed if the stroke is closed, lies on both up to `near`, or is far from there.
void trace(const Sketch& sketch, int stroke, double near, const Surface& a, const Surface& b,
           EdgeCurve* curve);

/// The surface as OpenCASCADE has it, its normal as Surface has it. A cone has its apex below its
/// boundary, whose points are given; a sphere's poles keep away from them.
/// Throws Refused if there is no such surface.
Handle(Geom_Surface) surface_of(const Surface& surface, const std::vector<Eigen::Vector3d>& border);

}  // namespace sketchsplat::brep
