// SPDX-License-Identifier: MIT
#include "datasets/io/jpeg_codec.h"

#include <turbojpeg.h>

#include <memory>
#include <type_traits>
#include <vector>

namespace sketchsplat {
namespace {

using Codec = std::unique_ptr<std::remove_pointer_t<tjhandle>, int (*)(tjhandle)>;

const unsigned char* bytes_of(const std::string& file) {
  return reinterpret_cast<const unsigned char*>(file.data());
}

struct JpegHeader {
  int width = 0, height = 0, subsampling = 0, colours = 0;
};

bool read_header(const Codec& codec, const std::string& file, JpegHeader* header) {
  return tjDecompressHeader3(codec.get(), bytes_of(file), file.size(), &header->width,
                             &header->height, &header->subsampling, &header->colours) == 0 ||
         (tjGetErrorCode(codec.get()) == TJERR_WARNING && header->width > 0);
}

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// False if the decoder stops, or warns of missing data, for which it makes up grey. Its other
/// warnings (bytes too many between segments, ...) do no harm.
bool decode(const Codec& codec, const std::string& file, int width, int height, int channels,
            unsigned char* rows) {
  for (const int flags : {TJFLAG_STOPONWARNING, 0}) {
    if (tjDecompress2(codec.get(), bytes_of(file), file.size(), rows, width, 0, height,
                      channels == 1 ? TJPF_GRAY : TJPF_RGB, flags) == 0)
      return true;
    if (tjGetErrorCode(codec.get()) != TJERR_WARNING ||
        contains(tjGetErrorStr2(codec.get()), "remature end"))
      return false;
  }
  return true;
}

template <int kChannels>
void split(const std::vector<unsigned char>& rows, Planes* planes) {
  const size_t pixels = rows.size() / kChannels;
  for (int c = 0; c < kChannels; ++c) planes->plane[c].reserve(pixels);
  for (size_t begin = 0; begin < pixels; begin += size_t(planes->width))
    for (int c = 0; c < kChannels; ++c) {
      // Growing row by row keeps the zeros of resize() in the cache.
      std::vector<float>& plane = planes->plane[c];
      plane.resize(begin + size_t(planes->width));
      const unsigned char* in = rows.data() + begin * kChannels + c;
      float* out = plane.data() + begin;
      for (int x = 0; x < planes->width; ++x) out[x] = float(in[x * kChannels]) / 255.0f;
    }
}

}  // namespace

bool decode_jpeg(const std::string& file, int denominator, Planes* planes, std::string* found) {
  const Codec codec(tjInitDecompress(), tjDestroy);
  JpegHeader header;
  if (!read_header(codec, file, &header)) {
    *found = tjGetErrorStr2(codec.get());
    if (contains(*found, "subsampling")) found->clear();
    return false;
  }
  if (header.colours == TJCS_CMYK || header.colours == TJCS_YCCK) return false;
  // The first scan spends at least one bit on a block of 8 x 8 pixels: a header that promises more
  // is broken and must not make us allocate.
  const std::int64_t pixels = std::int64_t(header.width) * header.height;
  const bool fits = pixels / 1024 <= std::int64_t(file.size());
  if (!fits || pixels > kMostPixels) {
    *found = fits ? "too many pixels" : "more pixels than the file can hold";
    return false;
  }
  planes->width = (header.width + denominator - 1) / denominator;
  planes->height = (header.height + denominator - 1) / denominator;
  planes->channels = header.colours == TJCS_GRAY ? 1 : 3;
  std::vector<unsigned char> rows(size_t(planes->width) * planes->height * planes->channels);
  if (!decode(codec, file, planes->width, planes->height, planes->channels, rows.data())) {
    *found = tjGetErrorStr2(codec.get());
    return false;
  }
  planes->channels == 1 ? split<1>(rows, planes) : split<3>(rows, planes);
  return true;
}

bool encode_jpeg(const unsigned char* rows, int width, int height, int quality, std::string* bytes,
                 std::string* found) {
  const Codec codec(tjInitCompress(), tjDestroy);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const bool done = tjCompress2(codec.get(), rows, width, 0, height, TJPF_RGB, &out, &size,
                                TJSAMP_420, quality, TJFLAG_ACCURATEDCT) == 0;
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(out, tjFree);
  if (done)
    bytes->assign(reinterpret_cast<const char*>(out), size);
  else
    *found = tjGetErrorStr2(codec.get());
  return done;
}

bool jpeg_size(const std::string& file, int* width, int* height) {
  const Codec codec(tjInitDecompress(), tjDestroy);
  JpegHeader header;
  if (!read_header(codec, file, &header)) return false;
  *width = header.width;
  *height = header.height;
  return true;
}

}  // namespace sketchsplat
