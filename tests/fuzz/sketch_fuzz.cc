// SPDX-License-Identifier: MIT
// sketch.json, and what is written of it.
#include <sstream>

#include "sketches/io/io.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() { return {test::small_sketch()}; }

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  std::istringstream in(text_of(data, size));
  read_or_refuse([&] {
    const Sketch sketch = read_sketch_json(in, "sketch.json");
    std::ostringstream out;
    write_sketch_json(out, sketch);
  });
  return 0;
}
