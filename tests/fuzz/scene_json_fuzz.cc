// SPDX-License-Identifier: MIT
// The first byte is the format, the rest its scene file.
#include "datasets/readers/scene.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {
namespace {

struct Format {
  const char *name, *file;
};
constexpr Format kFormats[] = {{"abc-nef", "meta_data.json"},
                               {"nerf", "transforms_train.json"},
                               {"nerfstudio", "transforms.json"}};

}  // namespace

std::vector<std::string> fuzz_seeds() {
  std::vector<std::string> seeds;
  for (int k = 0; k < 3; ++k) seeds.push_back(char(k) + test::small_scene_json(kFormats[k].name));
  return seeds;
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  static const bool ready = [] {
    for (const Format& format : kFormats) test::write_small_scene(folder.path(), format.name);
    return true;
  }();
  if (size < 1 || !ready) return 0;
  const Format& format = kFormats[data[0] % 3];
  folder.write(format.file, text_of(data + 1, size - 1));
  read_or_refuse([&] { open_scene(folder.path(), format.name); });
  return 0;
}
