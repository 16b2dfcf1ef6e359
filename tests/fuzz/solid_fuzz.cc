// SPDX-License-Identifier: MIT
// solid.json, and what is written of it.
#include <sstream>

#include "sketches/io/io_solid.h"
#include "tests/fuzz/fuzz.h"
#include "tests/topology/solids.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  std::ostringstream plate, elbow_text;
  write_solid_json(plate, plate_with_hole(0.5), R"({"scale": {"unit": "mm"}})");
  write_solid_json(elbow_text, elbow());
  return {plate.str(), elbow_text.str()};
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  std::istringstream in(text_of(data, size));
  read_or_refuse([&] {
    const Solid solid = read_solid_json(in, "solid.json");
    std::ostringstream out;
    write_solid_json(out, solid);
  });
  return 0;
}
