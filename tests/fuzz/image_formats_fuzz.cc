// SPDX-License-Identifier: MIT
// OpenEXR and TIFF, by OpenImageIO.
#include <atomic>
#include <new>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <sanitizer/asan_interface.h>
#elif __has_feature(thread_sanitizer)
#define TSAN_ALLOCATES
#endif
#endif
#ifndef ASAN_POISON_MEMORY_REGION
#define ASAN_POISON_MEMORY_REGION(at, bytes) ((void)(at))
#define ASAN_UNPOISON_MEMORY_REGION(at, bytes) ((void)(at))
#endif

#include "datasets/io/exr_header.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/damage.h"

namespace sketchsplat {
namespace {

// What claims more is left to its limits' own tests: some hundred bytes may claim some million
// pixels, for which memory has to be cleared.
constexpr std::int64_t kMostPixelsHere = 10'000;
constexpr double kMostPerByteHere = 100;

// OpenImageIO takes 64 MB and some rows to convert the pixels of any image. ASan marks all of them
// as good, and as bad again: three quarters of a run. So one such array is kept for the next run;
// what lies behind the bytes that were asked for is bad all the same.
constexpr size_t kLarge = size_t(1) << 26, kRoom = size_t(80) << 20, kBehind = 4096;

class LargeArray {
 public:
  bool has_room_for(size_t bytes) const { return bytes >= kLarge && bytes + kBehind <= kRoom; }
  void* take(size_t bytes) {  // null if it is in use
    if (taken_.exchange(true)) return nullptr;
    static char* const room = static_cast<char*>(std::malloc(kRoom));
    if (!room) throw std::bad_alloc();
    room_ = room;
    behind_ = room + (bytes + 7) / 8 * 8;
    ASAN_POISON_MEMORY_REGION(behind_, kBehind - 8);
    return room;
  }
  bool gives_back(void* array) {
    if (array != room_) return false;
    ASAN_UNPOISON_MEMORY_REGION(behind_, kBehind - 8);
    taken_ = false;
    return true;
  }

 private:
  std::atomic<bool> taken_{false};
  std::atomic<void*> room_{nullptr};
  char* behind_ = nullptr;
};

[[maybe_unused]] LargeArray large_array;

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

#ifndef TSAN_ALLOCATES
void* operator new[](size_t bytes) {
  using sketchsplat::large_array;
  void* array = large_array.has_room_for(bytes) ? large_array.take(bytes) : nullptr;
  if (!array) array = std::malloc(std::max<size_t>(bytes, 1));
  if (!array) throw std::bad_alloc();
  return array;
}
void operator delete[](void* array) noexcept {
  if (array && !sketchsplat::large_array.gives_back(array)) std::free(array);
}
void operator delete[](void* array, size_t) noexcept { operator delete[](array); }
#endif

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace sketchsplat;
  static const FuzzFolder folder;
  const std::string bytes = text_of(data, size);
  const bool tiff = bytes.rfind("II*", 0) == 0 || bytes.rfind("MM", 0) == 0;
  if (!tiff && bytes.rfind("\x76\x2f\x31\x01", 0) != 0) return 0;
  const bool large = exr_sizes_are_believable(bytes, bytes.size()) &&
                     !exr_sizes_are_believable(bytes, bytes.size(), kMostPerByteHere);
  if (large) return 0;
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
