// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "eval/inspect/sigma_model.h"
#include "sketches/graph/solid.h"

namespace sketchsplat {

/// How large a world unit is in tables.
struct TableScale {
  std::string unit = "world";  ///< name of the unit
  double units_per_world = 1;
  /// Relative standard deviation, which that of lengths contains; NaN if nobody knows.
  double sigma_relative = std::numeric_limits<double>::quiet_NaN();
};

/// What a drawing would say of a solid, with standard deviations as SurfaceErrors has them: JSON
/// arrays of objects, and the same as CSV, a heading and a row each. Lengths in `unit`, areas in
/// its square, angles in degrees to nine digits. What nobody knows is null, or empty in CSV; what a
/// kind does not have is no member, or empty.
///   surfaces    of every face: face, surface (equal where faces share one), kind, unit, area;
///               radius, minor_radius, half_angle_deg (of a cone), each with its sigma; axis (of a
///               plane out of the material) with axis_sigma_deg, the largest in any direction;
///               origin (as Surface has it, near the middle of the curves) with position_sigma: of
///               a plane along its axis, of others across it, of spheres and tori in any direction;
///               views that see any edge of it
///   dimensions  kind, value, sigma, unit ("deg" of angles), faces on its surfaces
/// Faces are called as in STEP files of the solid, by kind and index: "plane_0".
struct SolidTables {
  std::string unit;
  std::string surfaces_json, dimensions_json, surfaces_csv, dimensions_csv;
};

/// `areas`: of the faces, world units.
SolidTables solid_tables(const Solid& solid, const std::vector<double>& areas,
                         const SigmaModel& sigma, const TableScale& scale);

}  // namespace sketchsplat
