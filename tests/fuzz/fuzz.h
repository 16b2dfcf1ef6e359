// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/types/errors.h"

// A target of fuzzing: a reader that gets any bytes at all. It may refuse them by an InputError of
// one line; everything else (another exception, a sanitizer's complaint, a time-out) is a finding.
// Driven by libFuzzer (`./run fuzz`), or by small_run.cc within the tests.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size);

namespace sketchsplat {

/// Good inputs to begin with. Each target defines its own.
std::vector<std::string> fuzz_seeds();

/// A folder in memory, where the system has one, for as long as the process lives.
class FuzzFolder {
 public:
  FuzzFolder() {
    std::error_code none;
    const std::filesystem::path shared = "/dev/shm";
    const std::filesystem::path place = std::filesystem::is_directory(shared, none)
                                            ? shared
                                            : std::filesystem::temp_directory_path();
    std::string name = (place / "sketchsplat_fuzz_XXXXXX").string();
    if (!::mkdtemp(&name[0])) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~FuzzFolder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
  }
  FuzzFolder(const FuzzFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string path = path_ + "/" + name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

 private:
  std::string path_;
};

/// Runs a reader; what it refuses must be said in one line.
template <typename Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const InputError& e) {
    const bool one_line = std::strchr(e.what(), '\n') == nullptr && std::strlen(e.what()) < 2000;
    if (one_line) return;
    std::fprintf(stderr, "not one line: %s\n", e.what());
    std::abort();
  }
}

inline std::string text_of(const std::uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Files of one input, after one another, each but the last with its length before it.
inline std::string joined(const std::vector<std::string>& files) {
  std::string out;
  for (size_t i = 0; i < files.size(); ++i) {
    if (i + 1 < files.size()) {
      out += char(files[i].size() & 255);
      out += char(files[i].size() >> 8);
    }
    out += files[i];
  }
  return out;
}
inline std::vector<std::string> parted(const std::string& text, size_t count) {
  std::vector<std::string> files;
  size_t at = 0;
  while (files.size() + 1 < count && at + 2 <= text.size()) {
    const size_t length = size_t(std::uint8_t(text[at])) | size_t(std::uint8_t(text[at + 1])) << 8;
    files.push_back(text.substr(at + 2, length));
    at = std::min(at + 2 + length, text.size());
  }
  files.push_back(text.substr(at));
  files.resize(count);
  return files;
}

inline std::string bytes_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace sketchsplat
