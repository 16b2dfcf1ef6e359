// SPDX-License-Identifier: MIT
#include "datasets/io/float_image_io.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "datasets/io/image_plugin.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr char kNoPlugin[] = "sketchsplat_image_formats.so cannot be loaded";

std::vector<unsigned char> interleaved_bytes(const Picture& picture) {
  std::vector<unsigned char> rows(picture.red.data.size() * 3);
  const std::vector<float>* colours[] = {&picture.red.data, &picture.green.data,
                                         &picture.blue.data};
  for (int c = 0; c < 3; ++c)
    for (size_t i = 0; i < colours[c]->size(); ++i)
      rows[3 * i + c] =
          static_cast<unsigned char>(std::clamp((*colours[c])[i], 0.0f, 1.0f) * 255.0f + 0.5f);
  return rows;
}

}  // namespace

void write_exr(const std::string& path, const std::vector<FloatChannel>& channels, bool half) {
  const ImagePlugin* plugin = image_plugin();
  if (!plugin) throw OutputError(path, kNoPlugin);
  FloatPlanes planes;
  planes.width = channels.at(0).values.width;
  planes.height = channels[0].values.height;
  for (const FloatChannel& channel : channels) {
    planes.names.push_back(channel.name);
    planes.plane.push_back(channel.values.data);
  }
  const std::string part = path + "." + std::to_string(::getpid()) + ".part";
  std::string found;
  if (plugin->write_exr(part.c_str(), planes, half, &found)) {
    if (std::rename(part.c_str(), path.c_str()) == 0) return;
    found = std::strerror(errno);
  }
  std::remove(part.c_str());
  throw OutputError(path, found);
}

std::vector<FloatChannel> read_exr(const std::string& path) {
  const ImagePlugin* plugin = image_plugin();
  if (!plugin) throw InputError(path, "an OpenEXR image", kNoPlugin);
  FloatPlanes planes;
  std::string found;
  if (!plugin->read_exr(path.c_str(), &planes, &found))
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

void write_jpeg(const std::string& path, const Picture& picture, int quality) {
  const ImagePlugin* plugin = image_plugin();
  if (!plugin) throw OutputError(path, kNoPlugin);
  std::vector<unsigned char> bytes;
  std::string found;
  if (!plugin->encode_jpeg(interleaved_bytes(picture).data(), picture.width(), picture.height(),
                           quality, &bytes, &found))
    throw OutputError(path, found);
  const std::string part = path + "." + std::to_string(::getpid()) + ".part";
  std::ofstream out(part, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  out.close();
  if (out && std::rename(part.c_str(), path.c_str()) == 0) return;
  std::remove(part.c_str());
  throw OutputError(path, std::strerror(errno));
}

Picture through_jpeg(const Picture& picture, int quality) {
  const ImagePlugin* plugin = image_plugin();
  if (!plugin) throw std::runtime_error(kNoPlugin);
  std::vector<unsigned char> rows = interleaved_bytes(picture), bytes;
  std::string found;
  if (!plugin->encode_jpeg(rows.data(), picture.width(), picture.height(), quality, &bytes,
                           &found) ||
      !plugin->decode_jpeg(bytes, &rows, &found))
    throw std::runtime_error("JPEG: " + found);
  Picture out = picture;
  for (size_t i = 0; i < out.red.data.size(); ++i) {
    out.red.data[i] = float(rows[3 * i]) / 255;
    out.green.data[i] = float(rows[3 * i + 1]) / 255;
    out.blue.data[i] = float(rows[3 * i + 2]) / 255;
  }
  return out;
}

}  // namespace sketchsplat
