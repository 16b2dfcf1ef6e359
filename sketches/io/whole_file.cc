// SPDX-License-Identifier: MIT
#include "sketches/io/whole_file.h"

#include <algorithm>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr std::int64_t kMega = 1'000'000;
constexpr std::int64_t kLeastBlock = 1 << 14, kMostBlock = 1 << 20;  // [bytes] read at a time

[[noreturn]] void refuse(const std::string& path, std::int64_t most, const std::string& found) {
  throw InputError(path, "a file of at most " + std::to_string(most / kMega) + " MB", found);
}

}  // namespace

void check_length(std::istream* in, const std::string& path, std::int64_t most) {
  const std::streamoff begin = in->tellg();
  if (begin >= 0 && in->seekg(0, std::ios::end)) {
    const std::int64_t left = std::int64_t(in->tellg()) - begin;
    in->seekg(begin);
    if (left > most) refuse(path, most, std::to_string(left / kMega) + " MB");
  } else {
    in->clear();
  }
}

std::string read_whole(std::istream* in, const std::string& path, std::int64_t most) {
  check_length(in, path, most);
  std::string text;
  // Most files are small, and memory has to be cleared before it is read into.
  for (std::int64_t block = kLeastBlock; *in; block = std::min(2 * block, kMostBlock)) {
    const size_t before = text.size();
    text.resize(before + size_t(block));
    in->read(&text[before], block);
    text.resize(before + size_t(in->gcount()));
    if (std::int64_t(text.size()) > most) refuse(path, most, "more");
  }
  return text;
}

}  // namespace sketchsplat
