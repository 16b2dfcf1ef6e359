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

/// A face as STEP files of the solid call it: kind and index, "plane_0".
std::string face_name(const Solid& solid, int face);

/// One face and its surface. Lengths in the unit of the table, area in its square, angles in
/// degrees; NaN where the kind has no such number or nobody knows it.
struct SurfaceRow {
  std::string face;
  int surface = -1;  ///< equal for faces on one surface
  SurfaceKind kind = SurfaceKind::kPlane;
  double area = 0;
  double radius, radius_sigma, minor_radius, minor_radius_sigma;
  double half_angle, half_angle_sigma;  ///< of a cone
  Eigen::Vector3d axis;                 ///< of a plane: out of the material
  double axis_sigma;                    ///< largest in any direction
  Eigen::Vector3d origin;               ///< as Surface has it, near the middle of the curves
  /// Largest of the origin: of a plane along its axis, of others across it, of spheres and tori in
  /// any direction.
  double position_sigma;
  int views = 0;  ///< that see any edge of it
};

/// A dimension with the faces on its surfaces.
struct DimensionRow {
  std::string kind;
  double value = 0, sigma = 0;
  std::string unit;  ///< that of the table, or "deg"
  std::vector<std::string> faces;
};

struct SolidTables {
  std::string unit;
  std::vector<SurfaceRow> surfaces;
  std::vector<DimensionRow> dimensions;
};

/// `areas`: of the faces, world units. Standard deviations are those of SurfaceErrors.
SolidTables solid_tables(const Solid& solid, const std::vector<double>& areas,
                         const SigmaModel& sigma, const TableScale& scale);

/// surfaces.csv and dimensions.csv: a heading and a row each; empty where nobody knows.
std::string surfaces_csv(const SolidTables& tables);
std::string dimensions_csv(const SolidTables& tables);

/// The same as JSON arrays of objects; null where nobody knows, no member where the kind has none.
std::string surfaces_json(const SolidTables& tables);
std::string dimensions_json(const SolidTables& tables);

}  // namespace sketchsplat
