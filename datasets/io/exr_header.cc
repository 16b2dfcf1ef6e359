// SPDX-License-Identifier: MIT
#include "datasets/io/exr_header.h"

#include <cstdint>
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
         8 + 4 * std::uint64_t(little_endian(value, 0)) * little_endian(value, 4) == value.size();
}

// Corners of the rectangle of pixels: for its lines memory is taken when the file is opened. No
// codec packs more than some thousand pixels into a byte.
bool is_window(const std::string& value, std::size_t file_size) {
  if (value.size() != 16) return false;
  std::int64_t corner[4];
  for (int k = 0; k < 4; ++k) corner[k] = std::int32_t(little_endian(value, 4 * k));
  const double width = double(corner[2] - corner[0] + 1),
               height = double(corner[3] - corner[1] + 1);
  return width * height / 20000 <= double(file_size);
}

// Whether the library, which does not look at the size of all, takes as many bytes as it says.
bool has_its_size(const std::string& type, const std::string& value) {
  if (type == "chlist") return are_channels(value);
  if (type == "stringvector") return are_texts(value);
  if (type == "preview") return is_preview(value);
  const std::size_t fixed = fixed_size(type);
  return fixed == 0 || fixed == value.size();
}

}  // namespace

// Layout: openexr.com, "OpenEXR File Layout". Magic number, version, then name, type (both end with
// a zero byte), size and value of each attribute; a zero byte ends a header, another one the list
// of headers.
bool exr_sizes_are_believable(const std::string& head, std::size_t file_size) {
  if (head.size() < 8 || head.compare(0, 4, "v/1\1") != 0) return true;
  const bool several = little_endian(head, 4) & kMultipart;
  for (std::size_t at = 8, in_header = 0; at < head.size();) {
    if (head[at] == 0) {
      if (!several || in_header == 0) return true;
      in_header = 0, ++at;
      continue;
    }
    const std::size_t at_name = at, name_end = head.find('\0', at);
    const std::size_t type_end =
        name_end == std::string::npos ? name_end : head.find('\0', name_end + 1);
    if (type_end == std::string::npos || type_end + 5 > head.size()) return true;
    const std::size_t size = little_endian(head, type_end + 1);
    at = type_end + 5;
    if (at + size > file_size) return false;
    const std::string type = head.substr(name_end + 1, type_end - name_end - 1);
    if (at + size <= head.size()) {
      const std::string value = head.substr(at, size);
      if (!has_its_size(type, value)) return false;
      const bool window = head.compare(at_name, name_end - at_name, "dataWindow") == 0;
      if (window && !is_window(value, file_size)) return false;
    }
    at += size, ++in_header;
  }
  return true;
}

}  // namespace sketchsplat
