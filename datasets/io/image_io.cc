// SPDX-License-Identifier: MIT
#include "datasets/io/image_io.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

#include "datasets/io/image_plugin.h"
#include "datasets/io/jpeg_codec.h"
#include "datasets/io/png_codec.h"
#include "datasets/io/shrink_planes.h"
#include "datasets/io/write_whole.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr char kExpected[] = "an image";
constexpr std::int64_t kMostImageBytes = 4 * kMostPixels;  // of files; hardly any is that large
constexpr size_t kAll = std::numeric_limits<size_t>::max();

struct CloseFile {
  void operator()(FILE* file) const { std::fclose(file); }
};

/// The first bytes of a regular file that is not empty. Throws InputError.
std::string read_bytes(const std::string& path, size_t most) {
  const std::unique_ptr<FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  struct stat status;
  if (!file || ::fstat(::fileno(file.get()), &status) != 0)
    throw InputError(path, kExpected, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw InputError(path, kExpected, "a directory");
  if (!S_ISREG(status.st_mode)) throw InputError(path, kExpected, "no regular file");
  if (status.st_size == 0) throw InputError(path, kExpected, "an empty file");
  if (status.st_size > kMostImageBytes)
    throw InputError(path,
                     "an image of at most " + std::to_string(kMostImageBytes / 1000000) + " MB",
                     std::to_string(status.st_size / 1000000) + " MB");
  std::string bytes(std::min(size_t(status.st_size), most), '\0');
  bytes.resize(std::fread(&bytes[0], 1, bytes.size(), file.get()));
  return bytes;
}

bool begins_with(const std::string& signature, const std::string& file) {
  return file.compare(0, signature.size(), signature) == 0;
}
bool is_png(const std::string& file) { return begins_with("\x89PNG\r\n\x1a\n", file); }
bool is_jpeg(const std::string& file) { return begins_with("\xff\xd8\xff", file); }

// -------------------------------------------------------------------------------------- reading

[[noreturn]] void refuse(const std::string& path, const std::string& format,
                         const std::string& found) {
  throw InputError(path, "a whole " + format + " image", "a broken one (" + found + ")");
}

/// Decoders of JPEG fill what is missing with grey and say nothing. After the last start of a scan
/// (FF DA) there must be an end of image (FF D9); compressed data hold neither by chance.
bool has_end_of_jpeg(const std::string& file) {
  const size_t scan = file.rfind("\xff\xda"), end = file.rfind("\xff\xd9");
  return end != std::string::npos && (scan == std::string::npos || end > scan);
}

Planes read_by_plugin(const std::string& path, bool header_only) {
  const ImagePlugin* plugin = image_plugin();
  if (!plugin) {
    throw InputError(path, kExpected, std::string("no PNG, and no ") + kImagePluginFile);
  }
  Planes planes;
  std::string found;
  if (!plugin->read(path.c_str(), header_only, &planes, &found))
    throw InputError(path, kExpected, found);
  return planes;
}

/// What of a denominator the decoder of JPEG does by itself.
int jpeg_part(int denominator) {
  for (const int part : {8, 4, 2})
    if (denominator % part == 0) return part;
  return 1;
}

/// False if it is one of a kind that the decoder leaves to the plug-in.
bool read_jpeg(const std::string& path, const std::string& file, int denominator, Planes* planes) {
  if (!has_end_of_jpeg(file)) refuse(path, "JPEG", "no end");
  std::string found;
  if (decode_jpeg(file, denominator, planes, &found)) return true;
  if (!found.empty()) refuse(path, "JPEG", found);
  return false;
}

Planes read_planes(const std::string& path, int denominator) {
  Planes planes;
  const std::string file = read_bytes(path, kAll);
  const int part = jpeg_part(denominator);
  if (is_png(file)) {
    std::string found;
    if (!decode_png(file, &planes, &found)) refuse(path, "PNG", found);
  } else if (is_jpeg(file) && read_jpeg(path, file, part, &planes)) {
    denominator /= part;
  } else {
    planes = read_by_plugin(path, false);
  }
  shrink_planes(denominator, &planes);
  return planes;
}

// ---------------------------------------------------------------------------------- writing

/// 8-bit rows of interleaved channels.
std::vector<unsigned char> rows_of(const std::vector<const Image<float>*>& channels) {
  std::vector<unsigned char> rows(channels[0]->data.size() * channels.size());
  for (size_t c = 0; c < channels.size(); ++c) {
    const std::vector<float>& values = channels[c]->data;
    for (size_t i = 0; i < values.size(); ++i) {
      const float v = values[i] > 0 ? std::min(values[i], 1.0f) : 0.0f;  // NaN becomes 0
      rows[i * channels.size() + c] = static_cast<unsigned char>(v * 255.0f + 0.5f);
    }
  }
  return rows;
}

void write_channels(const std::string& path, const std::vector<const Image<float>*>& channels) {
  const int width = channels[0]->width, height = channels[0]->height;
  if (width <= 0 || height <= 0) throw OutputError(path, "an image without pixels");
  std::string bytes, found;
  if (!encode_png(rows_of(channels).data(), width, height, int(channels.size()), &bytes, &found))
    throw OutputError(path, found);
  write_whole(path, bytes);
}

std::string jpeg_of(const Picture& picture, int quality) {
  std::string bytes, found;
  if (!encode_jpeg(rows_of({&picture.red, &picture.green, &picture.blue}).data(), picture.width(),
                   picture.height(), quality, &bytes, &found))
    throw std::runtime_error("JPEG: " + found);
  return bytes;
}

Image<float> as_image(int width, int height, std::vector<float> data) {
  Image<float> image;
  image.width = width;
  image.height = height;
  image.data = std::move(data);
  return image;
}

}  // namespace

Picture read_picture(const std::string& path, int denominator) {
  Planes p = read_planes(path, denominator);
  const bool grey = p.channels <= 2;
  Picture picture;
  if (p.channels % 2 == 0)
    picture.alpha = as_image(p.width, p.height, std::move(p.plane[p.channels - 1]));
  picture.red = as_image(p.width, p.height, std::move(p.plane[0]));
  picture.green = grey ? picture.red : as_image(p.width, p.height, std::move(p.plane[1]));
  picture.blue = grey ? picture.red : as_image(p.width, p.height, std::move(p.plane[2]));
  return picture;
}

Image<float> read_grey(const std::string& path, int denominator) {
  Planes p = read_planes(path, denominator);
  std::vector<float>& grey = p.plane[0];
  if (p.channels >= 3) {
    for (size_t i = 0; i < grey.size(); ++i) {
      grey[i] = (grey[i] + p.plane[1][i] + p.plane[2][i]) / 3.0f;
    }
  }
  return as_image(p.width, p.height, std::move(grey));
}

ImageSize read_image_size(const std::string& path) {
  ImageSize size;
  constexpr size_t kUsualHead = 1 << 16;  // bytes; of JPEG, headers may be longer
  std::string file = read_bytes(path, kUsualHead);
  if (is_png(file)) {
    if (!png_size(file, &size.width, &size.height)) refuse(path, "PNG", "no header");
  } else if (is_jpeg(file)) {
    if (!jpeg_size(file, &size.width, &size.height) &&
        !jpeg_size(read_bytes(path, kAll), &size.width, &size.height))
      refuse(path, "JPEG", "no header");
  } else {
    const Planes planes = read_by_plugin(path, true);
    size = {planes.width, planes.height};
  }
  return size;
}

void write_png(const std::string& path, const Image<float>& grey) { write_channels(path, {&grey}); }

void write_png(const std::string& path, const Picture& picture) {
  std::vector<const Image<float>*> channels = {&picture.red, &picture.green, &picture.blue};
  if (!picture.alpha.empty()) channels.push_back(&picture.alpha);
  write_channels(path, channels);
}

void write_jpeg(const std::string& path, const Picture& picture, int quality) {
  write_whole(path, jpeg_of(picture, quality));
}

Picture through_jpeg(const Picture& picture, int quality) {
  Planes planes;
  std::string found;
  if (!decode_jpeg(jpeg_of(picture, quality), 1, &planes, &found))
    throw std::runtime_error("JPEG: " + found);
  Picture out = picture;
  out.red.data = std::move(planes.plane[0]);
  out.green.data = std::move(planes.plane[1]);
  out.blue.data = std::move(planes.plane[2]);
  return out;
}

}  // namespace sketchsplat
