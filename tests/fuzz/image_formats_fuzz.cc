// SPDX-License-Identifier: MIT
// OpenEXR and TIFF, by OpenImageIO.
#include "tests/fuzz/fuzz.h"
#include "tests/support/damage.h"

namespace sketchsplat {
namespace {

// What claims more is left to its limits' own test: some hundred bytes may claim some million
// pixels, for which memory has to be cleared.
constexpr std::int64_t kMostPixelsHere = 10'000;

}  // namespace

std::vector<std::string> fuzz_seeds() {
  const FuzzFolder folder;
  const Image<float> depth(test::kSmallWidth, test::kSmallHeight, 0.5f);
  write_exr(folder.path() + "/a.exr", {{"R", depth}, {"G", depth}, {"B", depth}}, true);
  write_exr(folder.path() + "/b.exr", {{"Z", depth}}, false);
  return {bytes_of_file(folder.path() + "/a.exr"), bytes_of_file(folder.path() + "/b.exr"),
          test::tiff(8, 8)};
}

}  // namespace sketchsplat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  const std::string bytes = text_of(data, size);
  const bool tiff = bytes.rfind("II*", 0) == 0 || bytes.rfind("MM", 0) == 0;
  if (!tiff && bytes.rfind("\x76\x2f\x31\x01", 0) != 0) return 0;
  const std::string path = folder.write(tiff ? "image.tif" : "image.exr", bytes);
  bool small = false;
  read_or_refuse([&] {
    const ImageSize image = read_image_size(path);
    small = std::int64_t(image.width) * image.height <= kMostPixelsHere;
  });
  if (!small) return 0;
  read_or_refuse([&] { read_picture(path); });
  if (!tiff) read_or_refuse([&] { read_exr(path); });
  return 0;
}
