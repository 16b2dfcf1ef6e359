// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sketches/io/io_glb.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using nlohmann::json;

std::string glb(const Sketch& sketch, double scale = 1) {
  std::ostringstream out;
  write_glb(out, sketch, {"part", scale});
  return out.str();
}

std::uint32_t word(const std::string& bytes, size_t at) {
  std::uint32_t value;
  std::memcpy(&value, &bytes[at], 4);  // the machines of the tests are little-endian
  return value;
}

struct Parts {
  json document;
  std::string binary;
};
Parts parts_of(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(bytes, 4), 2u);
  EXPECT_EQ(word(bytes, 8), bytes.size());
  const std::uint32_t length = word(bytes, 12);
  EXPECT_EQ(length % 4, 0u);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  Parts parts = {json::parse(bytes.substr(20, length)), ""};
  if (20 + length == bytes.size()) return parts;
  EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
  EXPECT_EQ(word(bytes, 20 + length), bytes.size() - 28 - length);
  parts.binary = bytes.substr(28 + length);
  return parts;
}

Sketch one_line() {
  Sketch sketch;
  const int a = sketch.add_node({1, 2, 3}), b = sketch.add_node({1, 2, 7});
  sketch.add_stroke(StrokeKind::kLine, a, b, {});
  return sketch;
}

TEST(Glb, ALineIsTwoVerticesInMetres) {
  const Parts parts = parts_of(glb(one_line(), 0.5));
  ASSERT_EQ(parts.binary.size(), 24u);
  float p[6];
  std::memcpy(p, parts.binary.data(), 24);
  EXPECT_EQ(std::vector<float>(p, p + 6), (std::vector<float>{0.5f, 1, 1.5f, 0.5f, 1, 3.5f}));
  const json& d = parts.document;
  EXPECT_EQ(d["meshes"][0]["primitives"][0]["mode"], 1);
  EXPECT_EQ(d["accessors"][0]["min"], json::parse("[0.5, 1.0, 1.5]"));
  EXPECT_EQ(d["accessors"][0]["max"], json::parse("[0.5, 1.0, 3.5]"));
  EXPECT_EQ(d["materials"][0]["name"], "line");
  EXPECT_EQ(d["nodes"][0]["name"], "part");
}

TEST(Glb, EveryKindHasItsMeshWithinTheBytes) {
  const Parts parts = parts_of(glb(five_kinds()));
  const json& d = parts.document;
  ASSERT_GE(d["meshes"].size(), 5u);
  EXPECT_EQ(d["buffers"][0]["byteLength"], parts.binary.size());
  size_t bytes = 0;
  for (size_t i = 0; i < d["meshes"].size(); ++i) {
    EXPECT_EQ(d["nodes"][i + 1]["mesh"], i);
    const json& accessor = d["accessors"][i];
    const json& view = d["bufferViews"][accessor["bufferView"].get<size_t>()];
    EXPECT_EQ(accessor["count"].get<size_t>() * 12, view["byteLength"].get<size_t>());
    EXPECT_EQ(accessor["count"].get<size_t>() % 2, 0u);
    bytes += view["byteLength"].get<size_t>();
  }
  EXPECT_EQ(bytes, parts.binary.size());
  EXPECT_EQ(glb(five_kinds()), glb(five_kinds()));
}

TEST(Glb, NothingIsAValidFile) {
  const Parts parts = parts_of(glb({}));
  EXPECT_TRUE(parts.binary.empty());
  EXPECT_FALSE(parts.document.contains("meshes"));
}

}  // namespace
}  // namespace sketchsplat
