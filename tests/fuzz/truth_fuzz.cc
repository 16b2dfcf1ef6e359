// SPDX-License-Identifier: MIT
// Truth as JSON, or as features of ABC with an OBJ beside them: the first byte says which.
#include "datasets/truth/ground_truth.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  const std::string json(1, '\0'), features(1, '\1');
  return {
      json + test::small_truth(), json + test::small_sketch(),
      json +
          R"({"scale": 0.01, "offset": [0,0,0], "curves": [{"type": "line", "points_mm": [[0,0,0],[9,0,0]]}]})",
      features + joined({"v 0 0 0\nv 1 0 0\nv 1 1 0\n", test::small_features()})};
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  if (size < 1) return 0;
  const std::string text = text_of(data + 1, size - 1);
  if (data[0] % 2 == 0) {
    const std::string path = folder.write("gt.json", text);
    read_or_refuse([&] { find_ground_truth(path); });
    return 0;
  }
  const std::vector<std::string> files = parted(text, 2);
  folder.write("a_trimesh.obj", files[0]);
  const std::string path = folder.write("a_features.yml", files[1]);
  read_or_refuse([&] { find_ground_truth(path); });
  return 0;
}
