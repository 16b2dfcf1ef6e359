// SPDX-License-Identifier: MIT
#include "datasets/io/exr_header.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>

namespace sketchsplat {
namespace {

constexpr std::uint32_t kMultipart = 1 << 12;  // of the version: several headers

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | std::uint8_t(bytes[at + k]);
  return value;
}

// Bytes of values that have but one length.
std::size_t fixed_size(const std::string& type) {
  static const std::map<std::string, std::size_t> kSizes = {
      {"box2f", 16},      {"box2i", 16},    {"chromaticities", 32},
      {"compression", 1}, {"double", 8},    {"envmap", 1},
      {"float", 4},       {"int", 4},       {"keycode", 28},
      {"m33d", 72},       {"m33f", 36},     {"m44d", 128},
      {"m44f", 64},       {"v2d", 16},      {"v2f", 8},
      {"v2i", 8},         {"v3d", 24},      {"v3f", 12},
      {"v3i", 12},        {"lineOrder", 1}, {"rational", 8},
      {"tiledesc", 9},    {"timecode", 8},  {"deepImageState", 1}};
  const auto found = kSizes.find(type);
  return found == kSizes.end() ? 0 : found->second;
}

constexpr std::size_t kChannel = 16;  // bytes of a channel after its name

// Channels - a name and what is known of it each -, and a zero byte.
bool are_channels(const std::string& value) {
  std::size_t at = 0;
  while (at < value.size() && value[at] != 0) {
    const std::size_t name_end = value.find('\0', at);
    if (name_end == std::string::npos) return false;
    at = name_end + 1 + kChannel;
  }
  return at + 1 == value.size();
}

// Texts with their lengths before them.
bool are_texts(const std::string& value) {
  std::size_t at = 0;
  while (at + 4 <= value.size()) at += 4 + std::size_t(little_endian(value, at));
  return at == value.size();
}

// Width, height and four bytes a pixel.
bool is_preview(const std::string& value) {
  return value.size() >= 8 &&
         8 + 4.0 * little_endian(value, 0) * little_endian(value, 4) == double(value.size());
}

// Whether the library, which does not look at the size of all, takes as many bytes as it says.
bool has_its_size(const std::string& type, const std::string& value) {
  if (type == "chlist") return are_channels(value);
  if (type == "stringvector") return are_texts(value);
  if (type == "preview") return is_preview(value);
  const std::size_t fixed = fixed_size(type);
  return fixed == 0 || fixed == value.size();
}

// What memory is taken for when a file is opened: lines of the window, as many as its codec packs
// together.
struct Claim {
  double width = 0, height = 0;  // of the data window
  double pixel_bytes = 4;
  int lines = 256;

  double bytes() const { return width * pixel_bytes * std::max<double>(height, lines); }

  void add(const std::string& name, const std::string& value) {
    if (name == "dataWindow" && value.size() == 16) {
      std::int64_t corner[4];
      for (int k = 0; k < 4; ++k) corner[k] = std::int32_t(little_endian(value, 4 * k));
      width = std::max<double>(0, corner[2] - corner[0] + 1);
      height = std::max<double>(0, corner[3] - corner[1] + 1);
    }
    // None, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB
    constexpr int kLines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    if (name == "compression" && value.size() == 1 && std::uint8_t(value[0]) < std::size(kLines))
      lines = kLines[std::uint8_t(value[0])];
    if (name == "channels") pixel_bytes = 4 * std::max(1.0, double(value.size() / (kChannel + 2)));
  }
};

}  // namespace

// Layout: openexr.com, "OpenEXR File Layout". Magic number, version, then name, type (both end with
// a zero byte), size and value of each attribute; a zero byte ends a header, another one the list
// of headers.
bool exr_sizes_are_believable(const std::string& head, std::size_t file_size, double per_byte) {
  if (head.size() < 8 || head.compare(0, 4, "v/1\1") != 0) return true;
  const bool several = little_endian(head, 4) & kMultipart;
  Claim claim;
  for (std::size_t at = 8, in_header = 0; at < head.size();) {
    if (head[at] == 0) {
      if (claim.bytes() > per_byte * double(file_size)) return false;
      if (!several || in_header == 0) return true;
      claim = {};
      in_header = 0, ++at;
      continue;
    }
    const std::size_t name_end = head.find('\0', at);
    const std::size_t type_end =
        name_end == std::string::npos ? name_end : head.find('\0', name_end + 1);
    if (type_end == std::string::npos || type_end + 5 > head.size()) return true;
    const std::string name = head.substr(at, name_end - at);
    const std::string type = head.substr(name_end + 1, type_end - name_end - 1);
    const std::size_t size = little_endian(head, type_end + 1);
    at = type_end + 5;
    if (at + size > file_size) return false;
    if (at + size <= head.size()) {
      const std::string value = head.substr(at, size);
      if (!has_its_size(type, value)) return false;
      claim.add(name, value);
    }
    at += size, ++in_header;
  }
  return true;
}

}  // namespace sketchsplat
