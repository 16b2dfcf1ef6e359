// SPDX-License-Identifier: MIT
// small_run [EXECUTIONS]: drives a target by the same mutations of its seeds at every run, as a
// test. No coverage guides it: the long run is libFuzzer's.
#include <random>

#include "tests/fuzz/fuzz.h"

namespace sketchsplat {
namespace {

using Random = std::mt19937_64;

size_t below(size_t n, Random* random) { return n == 0 ? 0 : size_t((*random)() % n); }

constexpr const char* kWords[] = {
    "0", "-1", "1e308", "-1e308", "1e-320",     "NaN", "null", "true", "[",  "]",  "{",
    "}", "\"", ",",     "\n",     "4294967296", "1e5", "\\u0", "#",    ": ", "- ", "../"};

/// First and last + 1 of the number at or after a place; equal if there is none.
std::pair<size_t, size_t> number_after(const std::string& text, size_t at) {
  const size_t first = text.find_first_of("-0123456789", at);
  if (first == std::string::npos) return {0, 0};
  const size_t last = text.find_first_not_of("-+.0123456789e", first);
  return {first, last == std::string::npos ? text.size() : last};
}

void mutate(const std::vector<std::string>& seeds, Random* random, std::string* text) {
  const size_t at = below(text->size() + 1, random), most = text->size() - at;
  const size_t length = std::min(most, 1 + below(16, random));
  switch (below(8, random)) {
    case 0:
      if (most > 0) (*text)[at] = char(1u << below(8, random) ^ unsigned((*text)[at]));
      break;
    case 1:
      if (most > 0) (*text)[at] = char(below(256, random));
      break;
    case 2:
      text->erase(at, length);
      break;
    case 3:
      text->insert(at, text->substr(below(text->size() + 1, random), length));
      break;
    case 4:
      text->insert(at, kWords[below(std::size(kWords), random)]);
      break;
    case 5: {
      const auto [first, last] = number_after(*text, at);
      text->replace(first, last - first, kWords[below(7, random)]);
      break;
    }
    case 6: {
      const std::string& other = seeds[below(seeds.size(), random)];
      *text = text->substr(0, at) + other.substr(below(other.size() + 1, random));
      break;
    }
    default:
      for (size_t i = at; i < at + std::min<size_t>(most, 8); ++i)
        (*text)[i] = below(2, random) ? '\xff' : '\0';
  }
}

int run(int executions) {
  const std::vector<std::string> seeds = fuzz_seeds();
  Random random(1);
  for (const std::string& seed : seeds)
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size());
  for (int i = 0; i < executions; ++i) {
    std::string text = seeds[below(seeds.size(), &random)];
    for (size_t k = 1 + below(6, &random); k > 0; --k) mutate(seeds, &random, &text);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  std::printf("%d executions\n", executions);
  return 0;
}

}  // namespace
}  // namespace sketchsplat

int main(int argc, char** argv) { return sketchsplat::run(argc > 1 ? std::atoi(argv[1]) : 2000); }
