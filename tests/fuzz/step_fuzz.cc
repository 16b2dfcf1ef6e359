// SPDX-License-Identifier: MIT
// STEP files: what Open CASCADE makes of them in a child process, and faces and edges of that here.
#include "datasets/step/read_step_shape.h"
#include "datasets/synthetic/render/cad_part.h"
#include "tests/fuzz/fuzz.h"
#include "tests/topology/solids.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  const FuzzFolder folder;
  std::vector<std::string> seeds;
  for (const Solid& solid : {plate_with_hole(0.5), elbow()}) {
    write_solid_step(solid, folder.path() + "/a.step");
    seeds.push_back(bytes_of_file(folder.path() + "/a.step"));
  }
  return seeds;
}

}  // namespace sketchsplat

namespace {

// What Open CASCADE sets up when it reads its first file, children inherit.
bool read_once(const sketchsplat::FuzzFolder& folder) {
  sketchsplat::read_step_shape(folder.write("seed.step", sketchsplat::fuzz_seeds().front()));
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  static const bool ready = read_once(folder);
  const std::string text = text_of(data, size);
  if (!ready || text.rfind("ISO-10303-21;", 0) != 0) return 0;  // refused at once, a test says so
  const std::string path = folder.write("part.step", text);
  read_or_refuse([&] { read_cad_part(path, 1); });
  return 0;
}
