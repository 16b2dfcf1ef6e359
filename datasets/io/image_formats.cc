// SPDX-License-Identifier: MIT
// Plug-in, loaded by image_plugin.cc when a file is no PNG: OpenImageIO brings some 260 shared
// objects and 0.2 s of start-up, which a run over PNG images need not pay.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <memory>

#include "datasets/io/exr_header.h"
#include "datasets/io/image_planes.h"

namespace sketchsplat {
namespace {

/// Channels to read, in the order of Planes: colours (one or three), then alpha if there is one.
std::vector<int> channels_to_read(const OIIO::ImageSpec& spec) {
  std::vector<int> colours;
  for (int c = 0; c < spec.nchannels; ++c) {
    if (c != spec.alpha_channel && c != spec.z_channel) colours.push_back(c);
  }
  colours.resize(std::min<size_t>(colours.size(), colours.size() < 3 ? 1 : 3));
  if (spec.alpha_channel >= 0 && !colours.empty()) colours.push_back(spec.alpha_channel);
  return colours;
}

/// Whether the colours can be premultiplied: none is above alpha by more than rounding to 8 bits.
bool can_be_premultiplied(const Planes& planes) {
  const std::vector<float>& alpha = planes.plane[planes.channels - 1];
  for (int c = 0; c + 1 < planes.channels; ++c) {
    for (size_t i = 0; i < alpha.size(); ++i) {
      if (planes.plane[c][i] > alpha[i] + 1.0f / 255.0f) return false;
    }
  }
  return true;
}

void divide_by_alpha(Planes* planes) {
  const std::vector<float>& alpha = planes->plane[planes->channels - 1];
  for (int c = 0; c + 1 < planes->channels; ++c) {
    std::vector<float>& colour = planes->plane[c];
    for (size_t i = 0; i < colour.size(); ++i) {
      if (alpha[i] > 0) colour[i] /= alpha[i];
    }
  }
}

/// Whether so many pixels may be read: before memory is taken for what a few bytes only claim. No
/// format packs more than some thousand bytes into one.
bool is_believable(const OIIO::ImageSpec& spec, const char* path, std::string* found) {
  const std::uint64_t bytes = OIIO::Filesystem::file_size(path);
  const bool too_many = spec.width > 0 && spec.height > kMostPixels / spec.width;
  const bool too_deep = spec.nchannels < 1 || spec.nchannels > 64;
  // OpenImageIO takes memory for a whole strip of a TIFF, which may claim more rows than the image.
  const std::uint64_t rows = std::max(spec.height, spec.get_int_attribute("tiff:RowsPerStrip"));
  const bool too_tall = !too_many && rows > kMostPixels / std::uint64_t(std::max(1, spec.width));
  if (!too_many && !too_deep && !too_tall && spec.scanline_bytes() * rows / 20000 <= bytes)
    return true;
  *found = std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels of " +
           std::to_string(spec.nchannels) + " numbers in " + std::to_string(bytes) + " bytes" +
           (too_tall ? ", in strips of " + std::to_string(rows) + " rows" : "");
  return false;
}

struct Signature {
  int at;  // byte
  std::string bytes;
  const char* format;  // OpenImageIO's name
};

/// The format of a file by its first bytes; by its name where these tell nothing.
std::string format_of(const char* path) {
  using namespace std::string_literals;
  static const std::vector<Signature> kSignatures = {
      {0, "II*\0"s, "tiff"},     {0, "MM\0*"s, "tiff"},    {0, "II+\0"s, "tiff"},
      {0, "MM\0+"s, "tiff"},     {0, "v/1\1"s, "openexr"}, {0, "\xff\xd8\xff", "jpeg"},
      {0, "\x89PNG\r\n", "png"}, {8, "WEBP", "webp"},      {0, "BM", "bmp"},
      {0, "#?RADIANCE", "hdr"},  {0, "#?RGBE", "hdr"},     {0, "GIF8", "gif"},
      {0, "P5", "pnm"},          {0, "P6", "pnm"},         {4, "jP  \r\n\x87\n", "jpeg2000"},
      {4, "ftyphei", "heif"},    {4, "ftypmif1", "heif"},  {0, "8BPS", "psd"}};
  char head[16] = {};
  OIIO::Filesystem::read_bytes(path, head, sizeof head);
  for (const Signature& s : kSignatures)
    if (s.bytes.compare(0, std::string::npos, head + s.at, s.bytes.size()) == 0) return s.format;
  return OIIO::Strutil::lower(OIIO::Filesystem::extension(path, false));
}

constexpr size_t kMostHeader = 1 << 20;  // bytes of an OpenEXR file's headers that are looked at

bool exr_is_believable(const char* path) {
  const std::uint64_t size = OIIO::Filesystem::file_size(path);
  std::string head(std::min<std::uint64_t>(size, kMostHeader), '\0');
  head.resize(OIIO::Filesystem::read_bytes(path, &head[0], head.size()));
  return exr_sizes_are_believable(head, size);
}

/// By the reader of the file's format. ImageInput::open(path) would hand a broken file to the
/// readers of all other formats, which takes longer and offers it more code to break.
std::unique_ptr<OIIO::ImageInput> open_image(const char* path, OIIO::ImageSpec* spec,
                                             std::string* found) {
  const std::string format = format_of(path);
  if (format == "openexr" && !exr_is_believable(path)) {
    *found = "a header that claims more than the file can hold";
    return nullptr;
  }
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;  // else colours come multiplied by alpha
  std::unique_ptr<OIIO::ImageInput> input;
  if (!format.empty()) input = OIIO::ImageInput::create(format);
  if (input && input->open(path, *spec, config)) return input;
  if (!input) OIIO::geterror();  // speaks of the format as of a file
  *found = input ? input->geterror() : "neither first bytes nor a name of a known format";
  return nullptr;
}

/// All numbers of an image, interleaved.
bool read_numbers(OIIO::ImageInput* input, const OIIO::ImageSpec& spec, const char* path,
                  std::vector<float>* numbers, std::string* found) {
  if (!is_believable(spec, path, found)) return false;
  input->threads(1);
  numbers->resize(size_t(spec.width) * spec.height * spec.nchannels);
  if (input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, numbers->data()))
    return true;
  *found = input->geterror();
  return false;
}

std::vector<float> plane_of(const std::vector<float>& numbers, size_t channels, size_t channel) {
  std::vector<float> plane(numbers.size() / channels);
  for (size_t i = 0; i < plane.size(); ++i) plane[i] = numbers[i * channels + channel];
  return plane;
}

bool read_planes(const char* path, bool header_only, Planes* planes, std::string* found) {
  OIIO::ImageSpec spec;
  const std::unique_ptr<OIIO::ImageInput> input = open_image(path, &spec, found);
  if (!input) return false;
  const std::vector<int> channels = channels_to_read(spec);
  if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 || channels.empty()) {
    *found = "no two-dimensional image with colours";
    return false;
  }
  planes->width = spec.width;
  planes->height = spec.height;
  planes->channels = int(channels.size());
  if (header_only) return true;
  std::vector<float> numbers;
  if (!read_numbers(input.get(), spec, path, &numbers, found)) return false;
  for (size_t c = 0; c < channels.size(); ++c)
    planes->plane[c] = plane_of(numbers, size_t(spec.nchannels), size_t(channels[c]));
  // Formats that store premultiplied colours (TIFF, OpenEXR) ignore the wish above, and some TIFF
  // writers do not say which of the two they mean.
  if (spec.alpha_channel >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha") &&
      can_be_premultiplied(*planes)) {
    divide_by_alpha(planes);
  }
  for (std::vector<float>& plane : planes->plane) {
    for (float& v : plane) v = v > 0 ? std::min(v, 1.0f) : 0.0f;  // NaN becomes 0
  }
  return true;
}

bool read_exr(const char* path, FloatPlanes* planes, std::string* found) {
  OIIO::ImageSpec spec;
  const std::unique_ptr<OIIO::ImageInput> input = open_image(path, &spec, found);
  std::vector<float> numbers;
  if (!input || !read_numbers(input.get(), spec, path, &numbers, found)) return false;
  planes->width = spec.width;
  planes->height = spec.height;
  planes->names = spec.channelnames;
  for (size_t c = 0; c < planes->names.size(); ++c)
    planes->plane.push_back(plane_of(numbers, planes->names.size(), c));
  return true;
}

bool write_exr(const char* path, const FloatPlanes& planes, bool half, std::string* found) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("openexr");
  if (!output) {
    *found = OIIO::geterror();
    return false;
  }
  const size_t channels = planes.plane.size(), pixels = size_t(planes.width) * planes.height;
  OIIO::ImageSpec spec(planes.width, planes.height, int(channels),
                       half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  spec.channelnames = planes.names;
  spec.attribute("compression", "zip:2");             // fast rather than small
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // same values, same bytes
  output->threads(1);
  std::vector<float> interleaved(pixels * channels);
  for (size_t c = 0; c < channels; ++c)
    for (size_t i = 0; i < pixels; ++i) interleaved[i * channels + c] = planes.plane[c][i];
  if (output->open(path, spec) && output->write_image(OIIO::TypeDesc::FLOAT, interleaved.data()) &&
      output->close())
    return true;
  *found = output->geterror();
  return false;
}

/// Calls a function of the above; nothing but a sentence leaves the plug-in.
template <typename Function>
bool guarded(std::string* found, Function function) {
  // The callers are the threads; OpenImageIO shall not start more.
  static const bool single = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  (void)single;
  try {
    if (function()) return true;
  } catch (const std::exception& e) {
    *found = e.what();
  }
  if (found->empty()) *found = "something that cannot be decoded";
  std::replace(found->begin(), found->end(), '\n', ' ');
  return false;
}

const ImagePlugin kPlugin = {
    [](const char* path, bool header_only, Planes* planes, std::string* found) {
      return guarded(found, [&] { return read_planes(path, header_only, planes, found); });
    },
    [](const char* path, const FloatPlanes& planes, bool half, std::string* found) {
      return guarded(found, [&] { return write_exr(path, planes, half, found); });
    },
    [](const char* path, FloatPlanes* planes, std::string* found) {
      return guarded(found, [&] { return read_exr(path, planes, found); });
    },
};

}  // namespace
}  // namespace sketchsplat

extern "C" const sketchsplat::ImagePlugin* sketchsplat_image_plugin() {
  return &sketchsplat::kPlugin;
}
