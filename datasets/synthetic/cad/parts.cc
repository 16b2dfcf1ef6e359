// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/parts.h"

#include <BRepCheck_Analyzer.hxx>
#include <Standard_Failure.hxx>
#include <stdexcept>

#include "datasets/synthetic/cad/shapes.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

TopoDS_Shape made(const std::string& name, const Dimensions& d) {
  for (const PartMakers* parts :
       {&prismatic_parts(), &plate_parts(), &turned_parts(), &smooth_parts()})
    if (const auto found = parts->find(name); found != parts->end()) return found->second(d);
  throw std::logic_error("nothing makes the part " + name);
}

}  // namespace

Brep make_part(const std::string& name, std::uint64_t seed, const PartValues& values) {
  const PartSpec* spec = find_part(name);
  if (!spec) {
    std::string known;
    for (const std::string& part : part_names()) known += (known.empty() ? "" : ", ") + part;
    throw InputError(name, "a STEP file or one of " + known, "neither");
  }
  const std::string wrong = wrong_values(*spec, values);
  if (!wrong.empty()) throw InputError(name, "a parameter and a value that it can have", wrong);
  const std::string what = "the part " + name + " of seed " + std::to_string(seed);
  try {
    const TopoDS_Shape shape = made(name, in_model_units(*spec, draw(*spec, seed, values)));
    if (shape.IsNull() || !BRepCheck_Analyzer(shape).IsValid())
      throw std::logic_error(what + " is no valid solid");
    return {std::make_shared<const TopoDS_Shape>(shape)};
  } catch (const Standard_Failure& failure) {
    throw std::logic_error(what + " cannot be made: " + failure.GetMessageString());
  }
}

}  // namespace sketchsplat
