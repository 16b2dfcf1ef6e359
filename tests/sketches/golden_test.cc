// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "sketches/io/io.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(SKETCHSPLAT_SOURCE_DIR) / "tests" / "golden";

// parametric_edges.json ends in .edges here; PLY is binary: its numbers are compared elsewhere.
constexpr const char* kExtensions[] = {".json", ".obj", ".step", ".dxf", ".edges"};

std::string written(const Sketch& s, const std::string& extension) {
  std::ostringstream out;
  if (extension == ".json") write_sketch_json(out, s);
  if (extension == ".obj") write_obj(out, s, 1e-2);
  if (extension == ".step") write_step(out, s, {"golden part", 100});
  if (extension == ".dxf") write_dxf(out, s, {100});
  if (extension == ".edges") write_parametric_edges(out, s);
  return out.str();
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Numbers, and what stands between them.
struct Tokens {
  std::vector<double> numbers;
  std::string rest;
};
Tokens tokens(const std::string& text) {
  Tokens out;
  const char* p = text.c_str();
  while (*p) {
    char* end = nullptr;
    const bool starts = std::isdigit(*p) || ((*p == '-' || *p == '.') && std::isdigit(p[1]));
    const double x = starts ? std::strtod(p, &end) : 0;
    if (starts) {
      out.numbers.push_back(x);
      out.rest += '0';
      p = end;
    } else {
      out.rest += *p++;
    }
  }
  return out;
}

// The last bits of sines belong to the machine; everything else must be the same.
void expect_same(const std::string& text, const std::string& golden, const fs::path& path) {
  const Tokens now = tokens(text), before = tokens(golden);
  EXPECT_EQ(now.rest, before.rest) << path;
  ASSERT_EQ(now.numbers.size(), before.numbers.size()) << path;
  for (size_t i = 0; i < now.numbers.size(); ++i)
    EXPECT_NEAR(now.numbers[i], before.numbers[i], 1e-12 * (1 + std::abs(before.numbers[i])))
        << path;
}

// SKETCHSPLAT_UPDATE_GOLDEN=1 writes the files anew; look at the difference before committing it.
TEST(Golden, FilesOfEverySketchAreAsTheyWere) {
  if (std::getenv("SKETCHSPLAT_UPDATE_GOLDEN")) {
    fs::create_directories(kFolder);
    for (const char* extension : kExtensions)
      for (const auto& [name, sketch] :
           {std::pair("five_kinds", five_kinds()), std::pair("all_kinds", all_kinds())})
        std::ofstream(kFolder / (std::string(name) + extension), std::ios::binary)
            << written(sketch, extension);
  }
  ASSERT_TRUE(fs::is_directory(kFolder));
  int sketches = 0;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".json") continue;
    ++sketches;
    std::ifstream in(entry.path());
    const Sketch s = read_sketch_json(in, entry.path().string());
    for (const char* extension : kExtensions) {
      const fs::path path = fs::path(entry.path()).replace_extension(extension);
      ASSERT_TRUE(fs::exists(path)) << path << " is missing";
      expect_same(written(s, extension), contents(path), path);
    }
  }
  EXPECT_GT(sketches, 0) << "an empty corpus proves nothing";
}

TEST(Golden, TheSameSketchGivesTheSameBytes) {
  for (const char* extension : kExtensions) {
    EXPECT_EQ(written(five_kinds(), extension), written(five_kinds(), extension));
    EXPECT_GT(written(five_kinds(), extension).size(), 500u);
  }
}

}  // namespace
}  // namespace sketchsplat
