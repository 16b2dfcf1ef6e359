// SPDX-License-Identifier: MIT
#include "eval/solids/solid_tables.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "eval/inspect/csv_row.h"
#include "eval/solids/solid_dimensions.h"
#include "eval/solids/surface_errors.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

using Move = SurfaceMove;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
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

bool has_radius(SurfaceKind kind) {
  return kind != SurfaceKind::kPlane && kind != SurfaceKind::kExtrusion;
}

SurfaceRow row_of(const Solid& solid, int f, const SurfaceErrors& errors, const TableScale& scale) {
  const SolidFace& face = solid.faces[f];
  const Surface& s = errors.surfaces()[face.surface];
  const bool flat = s.kind == SurfaceKind::kPlane, round = has_radius(s.kind),
             cone = s.kind == SurfaceKind::kCone, torus = s.kind == SurfaceKind::kTorus;
  const auto sigma = [&](const std::vector<Move>& moves) {
    return errors.sigma(face.surface, moves);
  };
  const double k = scale.units_per_world;
  SurfaceRow row;
  row.face = face_name(solid, f);
  row.surface = face.surface;
  row.kind = s.kind;
  row.radius = round ? k * s.radius : kNone;
  row.radius_sigma = scaled_sigma(round ? sigma({Move::kRadius}) : kNone, s.radius, scale);
  row.minor_radius = torus ? k * s.minor_radius : kNone;
  row.minor_radius_sigma = scaled_sigma(sigma({Move::kMinorRadius}), s.minor_radius, scale);
  row.half_angle = cone ? kDegrees * std::atan(std::abs(s.slope)) : kNone;
  row.half_angle_sigma =
      kDegrees * sigma({Move::kSlope}) / errors.reach() / (1 + s.slope * s.slope);
  row.axis = flat && face.reversed ? Eigen::Vector3d(-s.axis) : s.axis;
  row.axis_sigma = kDegrees * sigma({Move::kTiltX, Move::kTiltY}) / errors.reach();
  row.origin = k * s.origin;
  row.position_sigma = k * sigma({Move::kAcrossX, Move::kAcrossY, Move::kAlong});
  row.views = views_of(solid, face);
  return row;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

Json number(double x) { return std::isfinite(x) ? Json(nine_digits(x)) : Json(); }

Json json_of(const Eigen::Vector3d& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

}  // namespace

std::string face_name(const Solid& solid, int face) {
  return std::string(surface_name(solid.surfaces[solid.faces[face].surface].kind)) + "_" +
         std::to_string(face);
}

SolidTables solid_tables(const Solid& solid, const std::vector<double>& areas,
                         const SigmaModel& sigma, const TableScale& scale) {
  const SurfaceErrors errors(solid, sigma);
  SolidTables out;
  out.unit = scale.unit;
  std::vector<std::vector<std::string>> names(solid.surfaces.size());
  for (int f = 0; f < int(solid.faces.size()); ++f) {
    out.surfaces.push_back(row_of(solid, f, errors, scale));
    out.surfaces.back().area =
        f < int(areas.size()) ? std::pow(scale.units_per_world, 2) * areas[f] : kNone;
    names[solid.faces[f].surface].push_back(out.surfaces.back().face);
  }
  for (const SolidDimension& d : find_solid_dimensions(solid, errors)) {
    const bool angle = is_angle(d.kind);
    DimensionRow row;
    row.kind = solid_dimension_name(d.kind);
    row.value = (angle ? 1 : scale.units_per_world) * d.value;
    row.sigma = angle ? d.sigma : scaled_sigma(d.sigma, d.value, scale);
    row.unit = angle ? "deg" : scale.unit;
    for (const int s : d.surfaces)
      row.faces.insert(row.faces.end(), names[s].begin(), names[s].end());
    out.dimensions.push_back(row);
  }
  return out;
}

std::string surfaces_csv(const SolidTables& tables) {
  std::string out =
      "face,surface,kind,unit,area,radius,radius_sigma,minor_radius,minor_radius_sigma,"
      "half_angle_deg,half_angle_sigma_deg,axis_x,axis_y,axis_z,axis_sigma_deg,"
      "origin_x,origin_y,origin_z,position_sigma,views\n";
  for (const SurfaceRow& s : tables.surfaces) {
    CsvRow row;
    row.add(s.face).add(std::to_string(s.surface)).add(surface_name(s.kind)).add(tables.unit);
    for (const double x :
         {s.area, s.radius, s.radius_sigma, s.minor_radius, s.minor_radius_sigma, s.half_angle,
          s.half_angle_sigma, s.axis.x(), s.axis.y(), s.axis.z(), s.axis_sigma, s.origin.x(),
          s.origin.y(), s.origin.z(), s.position_sigma})
      row.add(x);
    out += row.add(std::to_string(s.views)).text();
  }
  return out;
}

std::string dimensions_csv(const SolidTables& tables) {
  std::string out = "kind,value,sigma,unit,faces\n";
  for (const DimensionRow& d : tables.dimensions)
    out += CsvRow().add(d.kind).add(d.value).add(d.sigma).add(d.unit).add(joined(d.faces)).text();
  return out;
}

std::string surfaces_json(const SolidTables& tables) {
  Json out = Json::array();
  for (const SurfaceRow& s : tables.surfaces) {
    Json row = {{"face", s.face}, {"surface", s.surface}, {"kind", surface_name(s.kind)}};
    row["unit"] = tables.unit;
    row["area"] = number(s.area);
    if (has_radius(s.kind)) {
      row["radius"] = number(s.radius);
      row["radius_sigma"] = number(s.radius_sigma);
    }
    if (s.kind == SurfaceKind::kTorus) {
      row["minor_radius"] = number(s.minor_radius);
      row["minor_radius_sigma"] = number(s.minor_radius_sigma);
    }
    if (s.kind == SurfaceKind::kCone) {
      row["half_angle_deg"] = number(s.half_angle);
      row["half_angle_sigma_deg"] = number(s.half_angle_sigma);
    }
    row["axis"] = json_of(s.axis);
    row["axis_sigma_deg"] = number(s.axis_sigma);
    row["origin"] = json_of(s.origin);
    row["position_sigma"] = number(s.position_sigma);
    row["views"] = s.views;
    out.push_back(row);
  }
  return json_text(out);
}

std::string dimensions_json(const SolidTables& tables) {
  Json out = Json::array();
  for (const DimensionRow& d : tables.dimensions)
    out.push_back({{"kind", d.kind},
                   {"value", number(d.value)},
                   {"sigma", number(d.sigma)},
                   {"unit", d.unit},
                   {"faces", d.faces}});
  return json_text(out);
}

}  // namespace sketchsplat
