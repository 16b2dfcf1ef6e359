// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>

namespace sketchsplat {

/// All roots of a STEP file (AP203, AP214, AP242) as one shape, in millimetres. For use within
/// guarded(). Throws InputError if the file is missing, is no STEP file or holds no shape;
/// Standard_Failure.
TopoDS_Shape read_step_shape(const std::string& path);

/// Seconds of CPU that reading a file of this size may take, twenty times what the slowest of those
/// that can be read do: 2, and 20 for every megabyte.
unsigned seconds_to_read(const std::string& path);

}  // namespace sketchsplat
