// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>

#include "sketches/graph/solid.h"

namespace sketchsplat {

/// A solid as JSON (`solid.json`): its edges as in sketch.json, which of them are inferred, its
/// surfaces, and its faces as loops over edges. World units; numbers survive a round trip exactly.
/// `extra` is a JSON object as text whose members are added at the top; may be empty.
void write_solid_json(std::ostream& out, const Solid& solid, const std::string& extra = "");

/// Throws InputError(path, ...) if the text is no JSON, misses a key, names an edge or a surface
/// that is not, or holds no sound edges. Whether the faces close is for others to say.
Solid read_solid_json(std::istream& in, const std::string& path);

}  // namespace sketchsplat
