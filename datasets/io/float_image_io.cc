// SPDX-License-Identifier: MIT
#include "datasets/io/float_image_io.h"

#include "datasets/io/image_plugin.h"
#include "datasets/io/write_whole.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr char kNoPlugin[] = "sketchsplat_image_formats.so cannot be loaded";

}  // namespace

void write_exr(const std::string& path, const std::vector<FloatChannel>& channels, bool half) {
  FloatPlanes planes;
  planes.width = channels.at(0).values.width;
  planes.height = channels[0].values.height;
  for (const FloatChannel& channel : channels) {
    planes.names.push_back(channel.name);
    planes.plane.push_back(channel.values.data);
  }
  write_whole(path, [&](const std::string& temporary) {
    const ImagePlugin* plugin = image_plugin();
    std::string found = plugin ? "" : kNoPlugin;
    if (plugin) plugin->write_exr(temporary.c_str(), planes, half, &found);
    return found;
  });
}

std::vector<FloatChannel> read_exr(const std::string& path) {
  const ImagePlugin* plugin = image_plugin();
  FloatPlanes planes;
  std::string found = kNoPlugin;
  if (!plugin || !plugin->read_exr(path.c_str(), &planes, &found))
    throw InputError(path, "an OpenEXR image", found);
  std::vector<FloatChannel> channels(planes.plane.size());
  for (size_t c = 0; c < channels.size(); ++c) {
    channels[c].name = planes.names[c];
    channels[c].values.width = planes.width;
    channels[c].values.height = planes.height;
    channels[c].values.data = std::move(planes.plane[c]);
  }
  return channels;
}

}  // namespace sketchsplat
