// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sketchsplat {

/// Pixels of an image beyond which nobody means it: twice those of the largest cameras. What claims
/// more is refused before memory is taken.
constexpr std::int64_t kMostPixels = 300'000'000;

/// A decoded image file, one plane per channel: grey, grey + alpha, RGB or RGBA by their number.
struct Planes {
  int width = 0, height = 0;
  int channels = 0;             ///< 1 to 4
  std::vector<float> plane[4];  ///< row-major, in [0, 1], alpha not premultiplied
};

/// Numbers per pixel that are no colours: depth, normals.
struct FloatPlanes {
  int width = 0, height = 0;
  std::vector<std::string> names;         ///< of the channels
  std::vector<std::vector<float>> plane;  ///< row-major, any value
};

/// What the plug-in image_formats does. All return false and say in `found` why they cannot. Safe
/// from many threads.
struct ImagePlugin {
  /// Decodes a file of any format that OpenImageIO knows, told by its first bytes, then by its
  /// name, or its header alone (then no plane is filled).
  bool (*read)(const char* path, bool header_only, Planes* planes, std::string* found);
  /// OpenEXR, whatever the file is called; `half`: 16 bits per number, else 32.
  bool (*write_exr)(const char* path, const FloatPlanes& planes, bool half, std::string* found);
  bool (*read_exr)(const char* path, FloatPlanes* planes, std::string* found);
};

inline constexpr char kImagePluginSymbol[] = "sketchsplat_image_plugin";
inline constexpr char kImagePluginFile[] = "sketchsplat_image_formats.so";

}  // namespace sketchsplat
