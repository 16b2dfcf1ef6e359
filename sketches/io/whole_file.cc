// SPDX-License-Identifier: MIT
#include "sketches/io/whole_file.h"

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr std::int64_t kMega = 1'000'000;
constexpr std::int64_t kBlock = 1 << 20;  // [bytes] read at a time

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
  for (std::streamsize got = kBlock; got == kBlock;) {
    const size_t before = text.size();
    text.resize(before + kBlock);
    in->read(&text[before], kBlock);
    got = in->gcount();
    text.resize(before + size_t(got));
    if (std::int64_t(text.size()) > most) refuse(path, most, "more");
  }
  return text;
}

}  // namespace sketchsplat
