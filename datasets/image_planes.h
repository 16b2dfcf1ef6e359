// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace sketchsplat {

/// A decoded image file, one plane per channel: grey, grey + alpha, RGB or RGBA by their number.
struct Planes {
  int width = 0, height = 0;
  int channels = 0;             ///< 1 to 4
  std::vector<float> plane[4];  ///< row-major, in [0, 1], alpha not premultiplied
};

/// What the plug-in image_formats exports under kReadPlanesSymbol: decodes a file of any format
/// that OpenImageIO knows, or its header alone (then no plane is filled). Returns false and says in
/// `found` why it cannot. Safe from many threads.
using ReadPlanes = bool(const char* path, bool header_only, Planes* planes, std::string* found);
inline constexpr char kReadPlanesSymbol[] = "sketchsplat_read_planes";
inline constexpr char kImagePluginFile[] = "sketchsplat_image_formats.so";

}  // namespace sketchsplat
