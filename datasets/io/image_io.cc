// SPDX-License-Identifier: MIT
#include "datasets/io/image_io.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include "datasets/io/image_plugin.h"
#include "datasets/io/jpeg_codec.h"
#include "datasets/io/png_codec.h"
#include "datasets/io/shrink_planes.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr char kExpected[] = "an image";
constexpr std::int64_t kMostImageBytes = 4 * kMostPixels;  // of files; hardly any is that large

struct CloseFile {
  void operator()(FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<FILE, CloseFile>;

/// Opens a regular file that is not empty. Throws InputError.
File open_image(const std::string& path, size_t* size) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(path, kExpected, std::strerror(errno));
  struct stat status;
  if (::fstat(::fileno(file.get()), &status) != 0) {
    throw InputError(path, kExpected, std::strerror(errno));
  }
  if (S_ISDIR(status.st_mode)) throw InputError(path, kExpected, "a directory");
  if (!S_ISREG(status.st_mode)) throw InputError(path, kExpected, "no regular file");
  if (status.st_size == 0) throw InputError(path, kExpected, "an empty file");
  if (status.st_size > kMostImageBytes)
    throw InputError(path,
                     "an image of at most " + std::to_string(kMostImageBytes / 1000000) + " MB",
                     std::to_string(status.st_size / 1000000) + " MB");
  *size = size_t(status.st_size);
  return file;
}

bool begins_with(const std::string& signature, FILE* file) {
  char head[8] = {};
  const size_t n = std::fread(head, 1, signature.size(), file);
  std::rewind(file);
  return signature.compare(0, std::string::npos, head, n) == 0;
}
bool is_png(FILE* file) { return begins_with("\x89PNG\r\n\x1a\n", file); }
bool is_jpeg(FILE* file) { return begins_with("\xff\xd8\xff", file); }

// -------------------------------------------------------------------- JPEG, everything else

/// Decoders of JPEG fill what is missing with grey and say nothing. After the last start of a scan
/// (FF DA) there must be an end of image (FF D9); compressed data hold neither by chance.
void check_jpeg_is_whole(const std::string& path, const std::string& bytes) {
  const size_t scan = bytes.rfind("\xff\xda"), end = bytes.rfind("\xff\xd9");
  if (end == std::string::npos || (scan != std::string::npos && end < scan)) {
    throw InputError(path, "a whole JPEG image", "a broken one (no end)");
  }
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

/// False if it is no JPEG, or one of a kind that libjpeg does not turn into RGB.
bool read_jpeg(const std::string& path, FILE* file, size_t size, int denominator, Planes* planes) {
  if (!is_jpeg(file)) return false;
  std::string bytes(size, '\0');
  bytes.resize(std::fread(&bytes[0], 1, size, file));
  check_jpeg_is_whole(path, bytes);
  std::string found;
  if (decode_jpeg(bytes, denominator, planes, &found)) return true;
  if (!found.empty()) throw InputError(path, "a whole JPEG image", "a broken one (" + found + ")");
  return false;
}

// What of a denominator libjpeg does by itself.
int jpeg_part(int denominator) {
  for (const int part : {8, 4, 2})
    if (denominator % part == 0) return part;
  return 1;
}

Planes read_planes(const std::string& path, int denominator) {
  size_t size = 0;
  const File file = open_image(path, &size);
  Planes planes;
  if (is_png(file.get())) {
    std::string found;
    if (!decode_png(file.get(), size, &planes, &found))
      throw InputError(path, "a whole PNG image", "a broken one (" + found + ")");
  } else if (const int part = jpeg_part(denominator);
             read_jpeg(path, file.get(), size, part, &planes)) {
    denominator /= part;
  } else {
    planes = read_by_plugin(path, false);
  }
  shrink_planes(denominator, &planes);
  return planes;
}

// ---------------------------------------------------------------------------------- writing

void write_planes(const std::string& path, int width, int height,
                  const std::vector<const float*>& planes) {
  if (width <= 0 || height <= 0) throw OutputError(path, "an image without pixels");
  const size_t channels = planes.size(), pixels = size_t(width) * height;
  std::vector<unsigned char> rows(pixels * channels);
  for (size_t c = 0; c < channels; ++c) {
    for (size_t i = 0; i < pixels; ++i) {
      const float v = planes[c][i] > 0 ? std::min(planes[c][i], 1.0f) : 0.0f;
      rows[i * channels + c] = static_cast<unsigned char>(v * 255.0f + 0.5f);
    }
  }
  const std::string part = path + "." + std::to_string(::getpid()) + ".part";
  FILE* file = std::fopen(part.c_str(), "wb");
  if (!file) throw OutputError(path, std::strerror(errno));
  std::string found;
  encode_png(rows.data(), width, height, int(channels), file, &found);
  if (std::fclose(file) != 0 && found.empty()) found = std::strerror(errno);
  if (found.empty() && std::rename(part.c_str(), path.c_str()) != 0) found = std::strerror(errno);
  if (found.empty()) return;
  std::remove(part.c_str());
  throw OutputError(path, found);
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
  size_t size = 0;
  const File file = open_image(path, &size);
  ImageSize found;
  if (is_jpeg(file.get())) {
    if (jpeg_size(file.get(), &found.width, &found.height)) return found;
    throw InputError(path, "a whole JPEG image", "a broken one (no header)");
  }
  if (!is_png(file.get())) {
    const Planes planes = read_by_plugin(path, true);
    return {planes.width, planes.height};
  }
  if (!png_size(file.get(), &found.width, &found.height)) {
    throw InputError(path, "a whole PNG image", "a broken one (no header)");
  }
  return found;
}

void write_png(const std::string& path, const Image<float>& grey) {
  write_planes(path, grey.width, grey.height, {grey.data.data()});
}

void write_png(const std::string& path, const Picture& picture) {
  std::vector<const float*> planes = {picture.red.data.data(), picture.green.data.data(),
                                      picture.blue.data.data()};
  if (!picture.alpha.empty()) planes.push_back(picture.alpha.data.data());
  write_planes(path, picture.width(), picture.height(), planes);
}

}  // namespace sketchsplat
