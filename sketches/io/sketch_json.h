// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "sketches/curve/curve_chain.h"
#include "sketches/io/json_reader.h"

namespace sketchsplat {

// Of files that hold a sketch. A header of this folder alone.

/// Nodes, strokes, handles of one: adding them copies the others.
constexpr size_t kMostParts = 50000;

inline nlohmann::ordered_json json_of_point(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

/// One item a line: readable, and a change of one stroke is a change of one line.
inline void write_json_array(std::ostream& out, const char* name,
                             const std::vector<nlohmann::ordered_json>& items) {
  out << "  \"" << name << "\": [";
  for (size_t i = 0; i < items.size(); ++i) out << (i ? ",\n    " : "\n    ") << items[i].dump();
  out << (items.empty() ? "]" : "\n  ]");
}

/// "nodes" and "strokes", with a comma between and none behind; chains become strokes.
void write_sketch_members(std::ostream& out, const Sketch& sketch,
                          const std::vector<CurveChain>& chains);

/// The sketch that these members are. Throws InputError.
Sketch sketch_of_members(const nlohmann::ordered_json& object, const JsonReader& reader);

}  // namespace sketchsplat
