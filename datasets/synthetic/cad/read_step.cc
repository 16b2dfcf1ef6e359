// SPDX-License-Identifier: MIT
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Shape.hxx>
#include <string>

#include "datasets/step/guarded.h"
#include "datasets/step/read_step_shape.h"
#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/cad/truth.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

// In the unit frame, where the part is one long. Boxes of OpenCASCADE pass over what is no number.
bool is_believable(const Sketch& edges) {
  constexpr double kFar = 1e3;
  return (edges.nodes.array().abs() < kFar).all() && (edges.handles.array().abs() < kFar).all();
}

// What the caller will ask of the part. `bytes`: as the caller will have it.
void rehearse(const std::string& path, const std::string& bytes) {
  const Brep brep{std::make_shared<const TopoDS_Shape>(shape_of(bytes))};
  if (!TopExp_Explorer(*brep.shape, TopAbs_FACE).More())
    throw InputError(path, "a shape with faces", "none");
  const UnitFrame frame = unit_frame(brep, path);
  constexpr double kEveryEdge = 0;
  if (!is_believable(sharp_edges(brep, frame, kEveryEdge).sketch))
    throw InputError(path, "edges that end", "one without an end, or without a place");
}

}  // namespace

Brep read_step(const std::string& path) {
  const std::string bytes = guarded(path, "a STEP file", seconds_to_read(path), [&] {
    const std::string shape = bytes_of(read_step_shape(path));
    rehearse(path, shape);
    return shape;
  });
  return {std::make_shared<const TopoDS_Shape>(shape_of(bytes))};
}

}  // namespace sketchsplat
