// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>

#include "tests/datasets/temp_folder.h"
#include "tests/support/small_scene.h"

namespace sketchsplat::test {

/// Something that is done to a scene in a folder.
using Damage = std::function<void(const std::string& folder)>;

inline Damage put(const std::string& file, const std::string& bytes) {
  return [=](const std::string& folder) { write_file(folder + "/" + file, bytes); };
}
inline std::string replaced(std::string text, const std::string& from, const std::string& to,
                            bool all) {
  size_t at = text.find(from), times = 0;
  for (; at != std::string::npos && (all || times < 1);
       at = text.find(from, at + to.size()), ++times)
    text.replace(at, from.size(), to);
  EXPECT_GT(times, 0u) << "nothing to damage: " << from;
  return text;
}
inline Damage swap(const std::string& file, const std::string& from, const std::string& to) {
  return [=](const std::string& folder) {
    const std::string path = folder + "/" + file;
    write_file(path, replaced(bytes_of(path), from, to, false));
  };
}
inline Damage swap_all(const std::string& file, const std::string& from, const std::string& to) {
  return [=](const std::string& folder) {
    const std::string path = folder + "/" + file;
    write_file(path, replaced(bytes_of(path), from, to, true));
  };
}
inline Damage cut(const std::string& file, double share) {
  return [=](const std::string& folder) {
    const std::string path = folder + "/" + file;
    std::filesystem::resize_file(path,
                                 std::uintmax_t(share * double(std::filesystem::file_size(path))));
  };
}
/// Ten gigabytes of which the disk has none.
inline Damage blow_up(const std::string& file) {
  return [=](const std::string& folder) {
    std::filesystem::resize_file(folder + "/" + file, 10'000'000'000);
  };
}
inline Damage poke(const std::string& file, size_t at, const std::string& bytes) {
  return [=](const std::string& folder) {
    std::string text = bytes_of(folder + "/" + file);
    ASSERT_LE(at + bytes.size(), text.size());
    write_file(folder + "/" + file, text.replace(at, bytes.size(), bytes));
  };
}
inline Damage gone(const std::string& file) {
  return [=](const std::string& folder) { std::filesystem::remove_all(folder + "/" + file); };
}
inline Damage folder_instead(const std::string& file) {
  return [=](const std::string& folder) {
    std::filesystem::remove(folder + "/" + file);
    std::filesystem::create_directory(folder + "/" + file);
  };
}
inline Damage pipe_instead(const std::string& file) {
  return [=](const std::string& folder) {
    std::filesystem::remove(folder + "/" + file);
    ASSERT_EQ(::mkfifo((folder + "/" + file).c_str(), 0600), 0);
  };
}
inline Damage both(const Damage& first, const Damage& second) {
  return [=](const std::string& folder) {
    first(folder);
    second(folder);
  };
}

template <typename T>
inline std::string bytes(T value, bool big_endian = false) {
  std::string out(reinterpret_cast<const char*>(&value), sizeof value);
  if (big_endian) std::reverse(out.begin(), out.end());
  return out;
}

/// PNG's checksum (RFC 2083, section 15).
inline std::uint32_t crc(const std::string& text) {
  std::uint32_t c = 0xffffffffu;
  for (const unsigned char byte : text) {
    c ^= byte;
    for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
  }
  return c ^ 0xffffffffu;
}
/// A header that claims this size, with a good checksum.
inline Damage png_claims(const std::string& file, std::uint32_t width, std::uint32_t height) {
  const std::string head =
      "IHDR" + bytes(width, true) + bytes(height, true) + std::string("\x08\x02\0\0\0", 5);
  return poke(file, 12, head + bytes(crc(head), true));
}
inline Damage jpeg(const std::string& file, const Damage& then) {
  return [=](const std::string& folder) {
    write_jpeg(folder + "/" + file, small_picture(), 90);
    then(folder);
  };
}
/// Width and height in the frame header of a JPEG file.
inline Damage jpeg_claims(const std::string& file, std::uint16_t size) {
  return [=](const std::string& folder) {
    std::string text = bytes_of(folder + "/" + file);
    const size_t at = text.find("\xff\xc0");
    ASSERT_NE(at, std::string::npos);
    write_file(folder + "/" + file, text.replace(at + 5, 4, bytes(size, true) + bytes(size, true)));
  };
}
/// A TIFF of one strip that claims this size.
// With `rows` in a strip, packed; libtiff corrects what unpacked ones claim.
inline std::string tiff(std::uint32_t width, std::uint32_t height, std::uint32_t rows = 0) {
  const auto entry = [](std::uint16_t tag, std::uint32_t value) {
    return bytes(tag) + bytes(std::uint16_t(4)) + bytes(std::uint32_t(1)) + bytes(value);
  };
  return std::string("II*\0\x08\0\0\0", 8) + bytes(std::uint16_t(9)) + entry(256, width) +
         entry(257, height) + entry(258, 8) + entry(259, rows > 0 ? 32773 : 1) + entry(262, 1) +
         entry(273, 200) + entry(277, 1) + entry(278, rows > 0 ? rows : height) + entry(279, 64) +
         bytes(std::uint32_t(0)) + std::string(200, '\0');
}
/// Depth and normals of all views as OpenEXR, then damage.
inline Damage maps(const Damage& then) {
  return [=](const std::string& folder) {
    for (const char* name : {"depth", "normal"}) {
      std::filesystem::create_directories(folder + "/" + name);
      const Image<float> values(kSmallWidth, kSmallHeight, 1.0f);
      for (int k = 0; k < kSmallViews; ++k)
        write_exr(folder + "/" + name + "/" + std::to_string(k) + ".exr",
                  {{"R", values}, {"G", values}, {"B", values}}, false);
    }
    then(folder);
  };
}
inline Damage exr_claims(const std::string& file, std::int32_t last) {
  return [=](const std::string& folder) {
    std::string text = bytes_of(folder + "/" + file);
    for (const std::string name : {"dataWindow", "displayWindow"}) {
      const size_t at = text.find(name + '\0') + name.size() + 1 + 6 + 4;  // box2i, its size
      text.replace(at + 8, 8, bytes(last) + bytes(last));
    }
    write_file(folder + "/" + file, text);
  };
}
inline std::string many_frames(int n) {
  std::string text = "{\"width\": 32, \"height\": 24, \"frames\": [0";
  for (int k = 1; k < n; ++k) text += ",0";
  return text + "]}";
}
inline std::string repeated(const std::string& text, int n) {
  std::string out;
  for (int i = 0; i < n; ++i) out += text;
  return out;
}

}  // namespace sketchsplat::test
