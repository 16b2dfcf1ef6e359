// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/parts.h"

#include <BRepCheck_Analyzer.hxx>
#include <Standard_Failure.hxx>
#include <stdexcept>

#include "datasets/synthetic/cad/shapes.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

const PartMaker& maker_of(const std::string& name) {
  for (const auto* parts : {&prismatic_parts(), &plate_parts(), &thin_parts(), &turned_parts(),
                            &freeform_parts(), &cast_parts()})
    for (const PartMaker& part : *parts)
      if (name == part.name) return part;
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
  try {
    const TopoDS_Shape shape = maker_of(name).make(draw(*spec, seed, values));
    if (shape.IsNull() || !BRepCheck_Analyzer(shape).IsValid())
      throw std::logic_error("the part " + name + " of seed " + std::to_string(seed) +
                             " is no valid solid");
    return {std::make_shared<const TopoDS_Shape>(shape)};
  } catch (const Standard_Failure& failure) {
    throw std::logic_error("the part " + name + " of seed " + std::to_string(seed) +
                           " cannot be made: " + failure.GetMessageString());
  }
}

}  // namespace sketchsplat
