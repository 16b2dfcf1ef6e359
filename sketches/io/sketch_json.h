// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <ostream>
#include <vector>

#include "sketches/curve/curve_chain.h"
#include "sketches/io/json.h"

namespace sketchsplat {

// Of files that hold a sketch. A header of this folder alone.

/// Nodes, strokes, handles of one: adding them copies the others.
constexpr size_t kMostParts = 50000;

Json json_of_point(const Eigen::Vector3d& p);

/// One item a line: readable, and a change of one stroke is a change of one line.
void write_json_array(std::ostream& out, const char* name, const std::vector<Json>& items);

/// "nodes" and "strokes", with a comma between and none behind; chains become strokes.
void write_sketch_members(std::ostream& out, const Sketch& sketch,
                          const std::vector<CurveChain>& chains);

/// The sketch that these members are. Throws InputError.
Sketch sketch_of_members(const JsonValue& object);

}  // namespace sketchsplat
