// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <functional>
#include <string>

namespace sketchsplat {

/// What `work` makes of a file with Open CASCADE, as bytes. Release 7.6 steps on null pointers and
/// turns for ever on what it does not expect: `work` runs in a child process, with at most
/// `seconds` of CPU. Throws InputError(name, expected, ...) if it crashes, takes longer or ends by
/// an exception of Open CASCADE; InputErrors of `work` as they are; std::bad_alloc where memory
/// runs out.
std::string guarded(const std::string& name, const std::string& expected, unsigned seconds,
                    const std::function<std::string()>& work);

/// A shape as bytes and back: its geometry to the last bit, its triangles if it has some.
std::string bytes_of(const TopoDS_Shape& shape);
TopoDS_Shape shape_of(const std::string& bytes);

}  // namespace sketchsplat
