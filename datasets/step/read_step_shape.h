// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>

namespace sketchsplat {

/// All roots of a STEP file (AP203, AP214, AP242) as one shape, in millimetres. Open CASCADE 7.6
/// steps on null pointers where a file names entities that it does not hold, and turns for ever on
/// some numbers: it reads in a child process, which may take 2 s of CPU and 20 for every megabyte
/// (twenty times what files take that can be read). Throws InputError if the file is missing, is no
/// STEP file, holds no shape, or is such a one; std::bad_alloc where memory runs out.
TopoDS_Shape read_step_shape(const std::string& path);

}  // namespace sketchsplat
