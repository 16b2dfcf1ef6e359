// SPDX-License-Identifier: MIT
#include "pipelines/results/snap_output.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pipelines/base/atomic_file.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

// Columns of the table and members of the objects.
Json row_of(const Snap& s, const std::string& unit) {
  return {{"kind", length_name(s.kind)},
          {"curves", s.strokes},
          {"unit", unit},
          {"measured", s.measured},
          {"sigma", s.sigma},
          {"standard", s.standard},
          {"series", s.series},
          {"deviation", s.standard - s.measured},
          {"nats_saved", s.nats},
          {"chi2_growth", s.chi2},
          {"chi2_most", s.chi2_most},
          {"moved_px", s.moved_px},
          {"noise_px", s.noise_px}};
}

std::string cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value.get<double>());
    return text;
  }
  std::string all;
  for (const Json& one : value) all += (all.empty() ? "" : " ") + json_text(one);
  return all;
}

}  // namespace

void write_snaps(const std::string& folder, const SnapOutcome& outcome) {
  const std::string path = folder + "/snaps.csv";
  if (outcome.unit.empty()) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    return;
  }
  write_atomically(path, [&](std::ostream& out) {
    const Json heading = row_of({}, "");
    for (auto it = heading.begin(); it != heading.end(); ++it)
      out << (it == heading.begin() ? "" : ",") << it.key();
    out << "\n";
    for (const Snap& s : outcome.snaps) {
      const Json row = row_of(s, outcome.unit);
      for (auto it = row.begin(); it != row.end(); ++it)
        out << (it == row.begin() ? "" : ",") << cell(*it);
      out << "\n";
    }
  });
}

std::string snap_json(const SnapOutcome& outcome) {
  Json json = {{"unit", outcome.unit.empty() ? Json() : Json(outcome.unit)},
               {"hypotheses", outcome.hypotheses}};
  json["snaps"] = Json::array();
  for (const Snap& s : outcome.snaps) json["snaps"].push_back(row_of(s, outcome.unit));
  return json_text(json);
}

}  // namespace sketchsplat
