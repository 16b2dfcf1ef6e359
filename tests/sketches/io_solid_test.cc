// SPDX-License-Identifier: MIT
#include "sketches/io/io_solid.h"

#include <gmock/gmock.h>

#include <sstream>

#include "datasets/types/errors.h"
#include "tests/topology/solids.h"

namespace sketchsplat {
namespace {

using ::testing::HasSubstr;

std::string text_of(const Solid& solid, const std::string& extra = "") {
  std::ostringstream out;
  write_solid_json(out, solid, extra);
  return out.str();
}

Solid read(const std::string& text) {
  std::istringstream in(text);
  return read_solid_json(in, "a/solid.json");
}

TEST(SolidJson, ComesBackToTheLastBit) {
  std::vector<Solid> solids = some_solids();
  solids.push_back(sphere_solid());
  for (Solid& solid : solids) {
    if (!solid.inferred.empty()) solid.inferred.back() = true;
    solid = perturbed(solid, 1e-3);
    const Solid back = read(text_of(solid));
    EXPECT_EQ(text_of(back), text_of(solid));
    EXPECT_EQ(back.edges.nodes, solid.edges.nodes);
    EXPECT_EQ(back.inferred, solid.inferred);
    EXPECT_EQ(back.gap, solid.gap);
    ASSERT_EQ(back.faces.size(), solid.faces.size());
    for (size_t i = 0; i < solid.surfaces.size(); ++i) {
      EXPECT_EQ(back.surfaces[i].radius, solid.surfaces[i].radius);
      EXPECT_EQ(back.surfaces[i].slope, solid.surfaces[i].slope);
      EXPECT_EQ(back.surfaces[i].minor_radius, solid.surfaces[i].minor_radius);
      EXPECT_EQ(back.surfaces[i].origin, solid.surfaces[i].origin);
    }
  }
}

// In sketch.json they are one curve.
TEST(SolidJson, SpansOfASplineStayEdgesOfTheirOwn) {
  Solid solid = box_solid({0, 0, 0}, {1, 1, 1});
  const int a = solid.edges.add_node({2, 0, 0}), b = solid.edges.add_node({3, 0, 0}),
            c = solid.edges.add_node({4, 0, 0});
  solid.edges.add_stroke(StrokeKind::kBezier, a, b, {{2.3, 1, 0}, {2.7, 0, 0}});
  solid.edges.add_stroke(StrokeKind::kBezier, b, c, {{3.3, 0, 0}, {3.7, 1, 0}});
  solid.inferred.resize(size_t(solid.edges.size()));
  EXPECT_EQ(read(text_of(solid)).edges.size(), solid.edges.size());
}

TEST(SolidJson, HoldsWhatElseIsToBeSaid) {
  EXPECT_THAT(text_of(box_solid({0, 0, 0}, {1, 1, 1}), R"({"scale": {"unit": "mm"}})"),
              HasSubstr("\n  \"scale\": {\"unit\":\"mm\"},\n"));
}

std::string refusal(std::string text, const std::string& what, const std::string& by) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(SolidJson, SaysWhatIsNoSolid) {
  const std::string text = text_of(plate_with_hole(0.5));
  EXPECT_THAT(refusal(text, "\"plane\"", "\"plain\""),
              HasSubstr("in surfaces[0].kind, found \"plain\""));
  EXPECT_THAT(refusal(text, "\"surface\":6", "\"surface\":7"),
              HasSubstr("below 7 in faces[6].surface, found 7"));
  EXPECT_THAT(refusal(text, "[[[", "[[[9"), HasSubstr("below 14"));
  EXPECT_THAT(refusal(text, "\"axis\":[0.0,0.0,-1.0]", "\"axis\":[0.0,0.0,-2.0]"),
              HasSubstr("a unit vector"));
  EXPECT_THAT(refusal(text, "true]", "1]"), HasSubstr("true or false"));
  EXPECT_THAT(refusal(text, "\"edges\"", "\"wedges\""), HasSubstr("\"edges\""));
  EXPECT_THAT(refusal(text, "\"inferred\": []", "\"inferred\": [14]"), HasSubstr("below 14"));
  EXPECT_THAT(refusal(text, "{", "["), HasSubstr("a/solid.json: expected a solid as JSON"));
}

}  // namespace
}  // namespace sketchsplat
