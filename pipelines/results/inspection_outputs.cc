// SPDX-License-Identifier: MIT
#include "pipelines/results/inspection_outputs.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pipelines/base/atomic_file.h"
#include "pipelines/pages/page.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "sketches/io/json.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {
namespace {

double six_decimals(double x) { return std::round(x * 1e6) / 1e6; }

// For the screen: the part in a unit cube about the origin.
void add_point(const Eigen::Vector3d& p, const Extent& extent, Json* flat) {
  for (int k = 0; k < 3; ++k)
    flat->push_back(six_decimals((p[k] - extent.center[k]) / extent.size));
}

Json edge_curve(const NominalEdge& edge, const EdgeMatch& match, const Extent& extent) {
  Json points = Json::array(), deviation = Json::array();
  const auto add = [&](const EdgePlace& p) {
    add_point(p.nominal, extent, &points);
    deviation.push_back(
        p.stroke < 0 ? Json() : Json(six_decimals(p.deviation.norm() / extent.size) * extent.size));
  };
  for (const EdgePlace& p : match.places) add(p);
  if (is_closed(edge.kind)) add(match.places.front());
  return {{"points", points}, {"deviation", deviation}};
}

Json measured_curve(const Sketch& sketch, int s, const Extent& extent) {
  const int pieces = sketch.strokes[s].kind == StrokeKind::kLine ? 1 : 48;
  const Eigen::Matrix3Xd points = sample_stroke(sketch, s, stroke_length(sketch, s) / pieces);
  Json flat = Json::array();
  for (int i = 0; i < points.cols(); ++i) add_point(points.col(i), extent, &flat);
  return {{"points", flat}};
}

std::string page_of(const std::string& json, const Inspection& inspection, const Nominal& nominal,
                    const std::vector<ReportImage>& overlays) {
  const Extent extent = sketch_extent(nominal.sketch);
  Json data;
  data["inspection"] = parse_json<Json>(json);
  data["tolerance"] = inspection.edges[0].tolerance;
  data["edges"] = data["measured"] = data["overlays"] = Json::array();
  for (size_t i = 0; i < nominal.edges.size(); ++i)
    data["edges"].push_back(edge_curve(nominal.edges[i], inspection.association.edges[i], extent));
  for (int s = 0; s < inspection.measured.size(); ++s)
    data["measured"].push_back(measured_curve(inspection.measured, s, extent));
  for (const ReportImage& image : overlays)
    data["overlays"].push_back({{"name", image.name}, {"png", base64(image.png)}});
  return fill_page(kInspectionPage, json_text(data));
}

// The nominal edges, green, red, orange and grey.
StepOptions step_of(const Inspection& inspection, const Nominal& nominal,
                    const InspectionTitle& title) {
  StepOptions step;
  step.name = std::filesystem::path(nominal.name).stem().string();
  const std::vector<std::string> units = length_unit_names();
  for (size_t k = 0; k < units.size(); ++k)
    if (units[k] == title.unit) step.unit = LengthUnit(k);
  step.paints = {{"in", 0.08, 0.5, 0.24},
                 {"out", 0.86, 0.1, 0.1},
                 {"undecided", 0.9, 0.55, 0.0},
                 {"not judged", 0.55, 0.58, 0.62}};
  for (const int edge : nominal.edge_of_stroke)
    step.paint_of_stroke.push_back(int(inspection.edges[edge].verdict));
  return step;
}

}  // namespace

void write_inspection(const std::string& folder, const Inspection& inspection,
                      const Nominal& nominal, const InspectOptions& options,
                      const InspectionTitle& title, const std::vector<ReportImage>& overlays) {
  const std::string json = inspection_json(inspection, nominal, options, title);
  write_text(folder + "/inspection.json", json);
  write_text(folder + "/inspection.csv", inspection_csv(inspection, nominal));
  write_text(folder + "/inspection.html", page_of(json, inspection, nominal, overlays));
  const StepOptions step = step_of(inspection, nominal, title);
  write_atomically(folder + "/inspection.step",
                   [&](std::ostream& out) { write_step(out, nominal.sketch, step); });
}

void write_lot(const std::string& folder, const std::vector<LotPart>& parts,
               const Inspection& first, const Nominal& nominal, const InspectionTitle& title) {
  const std::vector<LotRow> rows = lot_rows(parts, first, nominal);
  const std::string json = lot_json(parts, rows, title.nominal, title.unit);
  write_text(folder + "/lot.json", json);
  write_text(folder + "/lot.csv", lot_csv(rows));
  write_text(folder + "/lot.html", fill_page(kLotPage, json));
}

}  // namespace sketchsplat
