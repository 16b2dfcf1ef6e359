// SPDX-License-Identifier: MIT
// PNG and JPEG, which are decoded here; others are image_formats_fuzz.cc's.
#include "tests/fuzz/fuzz.h"
#include "tests/support/small_scene.h"

namespace sketchsplat {

std::vector<std::string> fuzz_seeds() {
  const FuzzFolder folder;
  const Picture picture = test::small_picture();
  Picture soft = picture;
  soft.alpha = picture.red;
  write_png(folder.path() + "/rgb.png", picture);
  write_png(folder.path() + "/rgba.png", soft);
  write_png(folder.path() + "/grey.png", picture.red);
  write_jpeg(folder.path() + "/a.jpg", picture, 80);
  std::vector<std::string> seeds;
  for (const char* name : {"rgb.png", "rgba.png", "grey.png", "a.jpg"})
    seeds.push_back(bytes_of_file(folder.path() + "/" + name));
  return seeds;
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  const std::string bytes = text_of(data, size);
  if (bytes.rfind("\x89PNG\r\n\x1a\n", 0) != 0 && bytes.rfind("\xff\xd8\xff", 0) != 0) return 0;
  const std::string path = folder.write("image", bytes);
  read_or_refuse([&] { read_image_size(path); });
  read_or_refuse([&] { read_picture(path); });
  read_or_refuse([&] { read_grey(path, 4); });
  return 0;
}
