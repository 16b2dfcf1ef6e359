// SPDX-License-Identifier: MIT
// Parts whose STEP file is broken in one place: read as a part of finite edges, or refused.
#include <fstream>
#include <sstream>

#include "datasets/synthetic/render/cad_part.h"
#include "datasets/types/errors.h"
#include "gmock/gmock.h"
#include "tests/topology/solids.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {
namespace {

using ::testing::HasSubstr;

std::string plate() {
  const std::string path = testing::TempDir() + "/plate.step";
  EXPECT_TRUE(write_solid_step(plate_with_hole(0.5), path).valid);
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// What the reader refuses `text` with; empty if it takes it.
std::string refusal(const std::string& text) {
  const std::string path = testing::TempDir() + "/broken.step";
  std::ofstream(path) << text;
  try {
    const CadPart part = read_cad_part(path, 1);
    EXPECT_TRUE(part.edges.sketch.nodes.allFinite());
    EXPECT_TRUE(part.edges.sketch.handles.allFinite());
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

// The text with what stands between `before` and `after`, the n-th time, replaced; empty if there
// is no n-th time.
std::string damaged(std::string text, const std::string& before, char after, int n,
                    const std::string& by) {
  size_t at = 0;
  for (int k = 0; k <= n; ++k) {
    at = text.find(before, at);
    if (at == std::string::npos) return "";
    at += before.size();
  }
  return text.replace(at, text.find(after, at) - at, by);
}

TEST(BrokenStep, TheWholePlateIsRead) { EXPECT_EQ(refusal(plate()), ""); }

// Some are turned over until their time is up.
TEST(BrokenStep, FarPlacesAreRefusedOrHarmNothing) {
  const std::string text = plate();
  int refused = 0;
  for (int n = 0; n < 9; n += 2) {
    const std::string broken = damaged(text, "= CARTESIAN_POINT('',(", ',', n, "1e308");
    ASSERT_FALSE(broken.empty());
    refused += !refusal(broken).empty();
  }
  EXPECT_GT(refused, 0);
}

// OpenCASCADE steps on a null pointer.
TEST(BrokenStep, EntitiesThatAreNotThereAreRefusedInOneLine) {
  for (const char* entity : {"= VECTOR('',", "= EDGE_CURVE('',", "= AXIS2_PLACEMENT_3D('',"}) {
    const std::string why = refusal(damaged(plate(), entity, ',', 0, "#99999"));
    EXPECT_THAT(why, HasSubstr("broken.step: expected ")) << entity;
    EXPECT_THAT(why, Not(HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace sketchsplat
