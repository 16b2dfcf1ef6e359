// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "sketches/io/length_unit.h"

namespace sketchsplat::brep {

/// Writes a shape, in millimetres, as an AP214 file whose numbers are in
/// `unit`: faces are named by index and coloured by their surfaces, the product is called `name`
/// (UTF-8). Whole or not at all; no time stamp, so the same shape gives the same bytes. Throws
/// OutputError.
void write_step_file(const TopoDS_Shape& shape, const std::string& name, LengthUnit unit,
                     const std::string& path, std::vector<TopoDS_Shape> faces = {});

}  // namespace sketchsplat::brep
