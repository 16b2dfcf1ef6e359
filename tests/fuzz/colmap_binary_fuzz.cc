// SPDX-License-Identifier: MIT
// Cameras, images and points of a model, as binary.
#include "datasets/scene.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  test::ColmapFiles lens = test::small_colmap();
  lens.cameras[0] = {1, "OPENCV", 4, 32, 24, {40, 40, 16, 12, 0.1, 0.01, 0, 0.001}};
  std::vector<std::string> seeds;
  for (const test::ColmapFiles& m : {test::small_colmap(), lens})
    seeds.push_back(
        joined({test::cameras_binary(m), test::images_binary(m), test::points_binary(m)}));
  return seeds;
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  static const bool ready = [] {
    test::write_small_scene(folder.path(), "colmap-binary");
    return true;
  }();
  if (!ready) return 0;
  const std::vector<std::string> files = parted(text_of(data, size), 3);
  folder.write("sparse/0/cameras.bin", files[0]);
  folder.write("sparse/0/images.bin", files[1]);
  folder.write("sparse/0/points3D.bin", files[2]);
  read_or_refuse([&] { open_scene(folder.path(), "colmap"); });
  return 0;
}
