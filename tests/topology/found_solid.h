// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "topology/brep/solid_step.h"
#include "topology/solid/find_solid.h"

namespace sketchsplat {

/// What Open CASCADE makes of the solid that was found; a failure if there is none that is valid.
inline SolidCheck check_of(const SolidSearch& search) {
  EXPECT_TRUE(search.solid) << search.why;
  if (!search.solid) return {};
  const SolidCheck check = write_solid_step(*search.solid, "");
  EXPECT_TRUE(check.valid) << check.why;
  return check;
}
inline double volume_of(const Sketch& sketch) { return check_of(find_solid(sketch)).volume; }

}  // namespace sketchsplat
