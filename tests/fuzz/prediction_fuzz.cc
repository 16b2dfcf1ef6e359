// SPDX-License-Identifier: MIT
// Edges of others to be scored: the first byte says whether JSON (EMAP's, NEF's, ours), PLY or OBJ.
#include "eval/metrics/prediction.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  const std::string json(1, '\0'), ply(1, '\1'), obj(1, '\2');
  return {json + test::small_emap(),        json + test::small_nef(), json + test::small_sketch(),
          json + "{\"points\": [[0,1,2]]}", ply + test::small_ply(),  obj + test::small_obj()};
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  static constexpr const char* kNames[] = {"a.json", "a.ply", "a.obj"};
  if (size < 1) return 0;
  const std::string path = folder.write(kNames[data[0] % 3], text_of(data + 1, size - 1));
  read_or_refuse([&] { read_prediction(path); });
  return 0;
}
