// SPDX-License-Identifier: MIT
// Cameras, images and points of a model; the first byte says whether as text or binary.
#include "datasets/readers/scene.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  test::ColmapFiles lens = test::small_colmap();
  lens.cameras[0] = {1, "OPENCV", 4, 32, 24, {40, 40, 16, 12, 0.1, 0.01, 0, 0.001}};
  std::vector<std::string> seeds;
  for (const test::ColmapFiles& m : {test::small_colmap(), lens}) {
    seeds.push_back('\0' + joined({cameras_text(m), images_text(m), points_text(m)}));
    seeds.push_back('\1' + joined({cameras_binary(m), images_binary(m), points_binary(m)}));
  }
  return seeds;
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder text, binary;
  static const bool ready = [] {
    test::write_small_scene(text.path(), "colmap-text");
    test::write_small_scene(binary.path(), "colmap-binary");
    return true;
  }();
  if (size < 1 || !ready) return 0;
  const FuzzFolder& folder = data[0] % 2 ? binary : text;
  const std::string ending = data[0] % 2 ? ".bin" : ".txt";
  const std::vector<std::string> files = parted(text_of(data + 1, size - 1), 3);
  const char* names[] = {"cameras", "images", "points3D"};
  for (int k = 0; k < 3; ++k) folder.write(std::string("sparse/0/") + names[k] + ending, files[k]);
  read_or_refuse([&] { open_scene(folder.path(), "colmap"); });
  return 0;
}
