// SPDX-License-Identifier: MIT
#include "pipelines/results/geometry_files.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "datasets/io/float_image_io.h"
#include "datasets/io/image_io.h"
#include "pipelines/base/atomic_file.h"

namespace sketchsplat {
namespace {

// Nearest white, farthest a quarter; nothing is black.
Image<float> depth_picture(const Image<float>& depth) {
  float low = std::numeric_limits<float>::max(), high = 0;
  for (const float z : depth.data)
    if (z > 0) low = std::min(low, z), high = std::max(high, z);
  Image<float> out(depth.width, depth.height);
  for (size_t i = 0; i < depth.data.size(); ++i)
    if (depth.data[i] > 0)
      out.data[i] = 1 - 0.75f * (depth.data[i] - low) / std::max(1e-20f, high - low);
  return out;
}

Picture normal_picture(const GeometryMaps& maps) {
  Picture out;
  const float sign[3] = {1, -1, -1};
  Image<float>* planes[3] = {&out.red, &out.green, &out.blue};
  for (int c = 0; c < 3; ++c) {
    *planes[c] = Image<float>(maps.width(), maps.height());
    for (size_t i = 0; i < maps.depth.data.size(); ++i)
      if (maps.depth.data[i] > 0)
        planes[c]->data[i] = 0.5f + 0.5f * sign[c] * maps.normal[c].data[i];
  }
  return out;
}

}  // namespace

void prepare_geometry_folders(const std::string& out) {
  for (const char* folder : {"/depth", "/normal", "/alpha"}) prepare_output_folder(out + folder);
}

void write_geometry_maps(const std::string& out, const View& view, const GeometryMaps& maps) {
  const std::string name = std::filesystem::path(view.name).replace_extension().string();
  const std::string depth = out + "/depth/" + name, normal = out + "/normal/" + name;
  write_exr(depth + ".exr", {{"Z", maps.depth}}, /*half=*/false);
  write_exr(normal + ".exr", {{"R", maps.normal[0]}, {"G", maps.normal[1]}, {"B", maps.normal[2]}},
            /*half=*/true);
  write_png(depth + ".png", depth_picture(maps.depth));
  write_png(normal + ".png", normal_picture(maps));
  write_exr(out + "/alpha/" + name + ".exr", {{"A", maps.alpha}}, /*half=*/true);
  write_png(out + "/alpha/" + name + ".png", maps.alpha);
}

}  // namespace sketchsplat
