// SPDX-License-Identifier: MIT
#include "eval/solids/solid_tables.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "eval/inspect/csv_row.h"
#include "eval/solids/solid_dimensions.h"
#include "eval/solids/surface_errors.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

using Move = SurfaceMove;

constexpr double kDegrees = 180 / M_PI;

// A length in the table's unit, whose own error adds to that of the length.
double scaled_sigma(double sigma, double value, const TableScale& scale) {
  const double of_scale = std::isfinite(scale.sigma_relative) ? scale.sigma_relative * value : 0;
  return scale.units_per_world * std::hypot(sigma, of_scale);
}

int views_of(const Solid& solid, const SolidFace& face) {
  std::set<int> views;
  for (const Loop& loop : face.loops)
    for (const LoopStroke& s : loop) {
      const std::vector<int>& own = solid.edges.evidence[s.stroke].views;
      views.insert(own.begin(), own.end());
    }
  return int(views.size());
}

std::string face_name(const Solid& solid, int face) {
  return std::string(surface_name(solid.surfaces[solid.faces[face].surface].kind)) + "_" +
         std::to_string(face);
}

Json number(double x) { return std::isfinite(x) ? Json(nine_digits(x)) : Json(); }

Json json_of(const Eigen::Vector3d& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

Json row_of(const Solid& solid, int f, double area, const SurfaceErrors& errors,
            const TableScale& scale) {
  const SolidFace& face = solid.faces[f];
  const Surface& s = errors.surfaces()[face.surface];
  const auto sigma = [&](const std::vector<Move>& moves) {
    return errors.sigma(face.surface, moves);
  };
  const double k = scale.units_per_world;
  Json row = {{"face", face_name(solid, f)}, {"surface", face.surface}};
  row["kind"] = surface_name(s.kind);
  row["unit"] = scale.unit;
  row["area"] = number(k * k * area);
  if (s.kind != SurfaceKind::kPlane && s.kind != SurfaceKind::kExtrusion) {
    row["radius"] = number(k * s.radius);
    row["radius_sigma"] = number(scaled_sigma(sigma({Move::kRadius}), s.radius, scale));
  }
  if (s.kind == SurfaceKind::kTorus) {
    row["minor_radius"] = number(k * s.minor_radius);
    row["minor_radius_sigma"] =
        number(scaled_sigma(sigma({Move::kMinorRadius}), s.minor_radius, scale));
  }
  if (s.kind == SurfaceKind::kCone) {
    row["half_angle_deg"] = number(kDegrees * std::atan(std::abs(s.slope)));
    row["half_angle_sigma_deg"] =
        number(kDegrees * sigma({Move::kSlope}) / errors.reach() / (1 + s.slope * s.slope));
  }
  const bool turned = s.kind == SurfaceKind::kPlane && face.reversed;
  row["axis"] = json_of(turned ? Eigen::Vector3d(-s.axis) : s.axis);
  row["axis_sigma_deg"] = number(kDegrees * sigma({Move::kTiltX, Move::kTiltY}) / errors.reach());
  row["origin"] = json_of(k * s.origin);
  row["position_sigma"] = number(k * sigma({Move::kAcrossX, Move::kAcrossY, Move::kAlong}));
  row["views"] = views_of(solid, face);
  return row;
}

Json row_of(const SolidDimension& d, const std::vector<std::vector<std::string>>& faces_on,
            const TableScale& scale) {
  const bool angle = is_angle(d.kind);
  std::vector<std::string> faces;
  for (const int s : d.surfaces) faces.insert(faces.end(), faces_on[s].begin(), faces_on[s].end());
  return {{"kind", solid_dimension_name(d.kind)},
          {"value", number((angle ? 1 : scale.units_per_world) * d.value)},
          {"sigma", number(angle ? d.sigma : scaled_sigma(d.sigma, d.value, scale))},
          {"unit", angle ? "deg" : scale.unit},
          {"faces", faces}};
}

// "axis_x" is the first number of the member "axis".
std::string field(const Json& row, const std::string& column) {
  Json value = row.value(column, Json());
  const size_t stem = column.size() - 2;
  if (column[stem] == '_' && row.contains(column.substr(0, stem)))
    value = row[column.substr(0, stem)][size_t(column.back() - 'x')];
  if (value.is_number_float()) return shortest(value.get<double>());
  if (value.is_number()) return std::to_string(value.get<int>());
  if (value.is_string()) return value.get<std::string>();
  std::string words;
  for (const auto& word : value) words += (words.empty() ? "" : " ") + word.get<std::string>();
  return words;
}

std::string csv_of(const std::string& heading, const Json& rows) {
  std::string out = heading + "\n";
  for (const Json& row : rows) {
    CsvRow line;
    std::istringstream columns(heading);
    for (std::string column; std::getline(columns, column, ',');) line.add(field(row, column));
    out += line.text();
  }
  return out;
}

}  // namespace

SolidTables solid_tables(const Solid& solid, const std::vector<double>& areas,
                         const SigmaModel& sigma, const TableScale& scale) {
  const SurfaceErrors errors(solid, sigma);
  Json surfaces = Json::array(), dimensions = Json::array();
  std::vector<std::vector<std::string>> faces_on(solid.surfaces.size());
  for (int f = 0; f < int(solid.faces.size()); ++f) {
    surfaces.push_back(row_of(solid, f, f < int(areas.size()) ? areas[f] : NAN, errors, scale));
    faces_on[solid.faces[f].surface].push_back(face_name(solid, f));
  }
  for (const SolidDimension& d : find_solid_dimensions(solid, errors))
    dimensions.push_back(row_of(d, faces_on, scale));
  return {scale.unit, json_text(surfaces), json_text(dimensions),
          csv_of("face,surface,kind,unit,area,radius,radius_sigma,minor_radius,minor_radius_sigma,"
                 "half_angle_deg,half_angle_sigma_deg,axis_x,axis_y,axis_z,axis_sigma_deg,"
                 "origin_x,origin_y,origin_z,position_sigma,views",
                 surfaces),
          csv_of("kind,value,sigma,unit,faces", dimensions)};
}

}  // namespace sketchsplat
