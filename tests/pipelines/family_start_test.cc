// SPDX-License-Identifier: MIT
#include "pipelines/method/family_start.h"

#include <gtest/gtest.h>

#include "datasets/types/errors.h"
#include "tests/pipelines/rendered_part.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT

SynthesizeOptions part_options(const std::string& part, int seed, int views) {
  SynthesizeOptions options;
  options.part = part;
  options.seed = seed;
  options.rig.views = views;
  options.rig.resolution = 400;
  options.rig.object_size = 0.7;
  options.render.noise = 2;
  options.outputs = "none";
  return options;
}

// Files of the true edges of some siblings, one a line.
std::string write_siblings(const std::string& part, const TempFolder& folder) {
  std::string paths;
  for (int seed = 2; seed < 7; ++seed) {
    const std::string path = folder.file(part + std::to_string(seed) + ".json");
    std::ofstream out(path);
    write_sketch_json(out, synthesize(part_options(part, seed, 3)).truth.sketch);
    paths += (paths.empty() ? "" : "\n") + path;
  }
  return paths;
}

double count(const RunReport& report, const std::string& name) {
  for (const auto& [key, value] : report.counts)
    if (key == name) return value;
  return -1;
}

TEST(FamilyStart, FiveViewsAreEnoughForAPartWhoseSiblingsAreKnown) {
  const TempFolder scene, siblings;
  write_scene(synthesize(part_options("l-bracket", 1, 5)), scene.path());
  ReconstructOptions options;
  const Sketch cold = reconstruct(open_scene(scene.path()), options, nullptr).sketch;
  options.like = write_siblings("l-bracket", siblings);
  const Reconstruction warm = reconstruct(open_scene(scene.path()), options, nullptr);
  EXPECT_EQ(count(warm.report, "family_followed"), 1);
  EXPECT_TRUE(validate(warm.sketch).empty());
  const double at_once = f_at(score(warm.sketch, scene.path()).fine, 0.005);
  EXPECT_GE(at_once, 95);
  EXPECT_LE(f_at(score(cold, scene.path()).fine, 0.005), at_once - 10);
}

// The contours of its cylinders are a third of the edgels, and no edges.
TEST(FamilyStart, AShaftIsFollowedThoughTheContoursOfItsCylindersAreNoEdges) {
  const TempFolder scene, siblings;
  write_scene(synthesize(part_options("stepped-shaft", 1, 5)), scene.path());
  ReconstructOptions options;
  options.like = write_siblings("stepped-shaft", siblings);
  const Reconstruction warm = reconstruct(open_scene(scene.path()), options, nullptr);
  EXPECT_EQ(count(warm.report, "family_followed"), 1);
  EXPECT_GE(f_at(score(warm.sketch, scene.path()).fine, 0.005), 95);
}

TEST(FamilyStart, APartOfAnotherKindIsReconstructedAsWithoutSiblings) {
  const TempFolder scene, siblings;
  write_scene(synthesize(part_options("box-hole", 1, 6)), scene.path());
  ReconstructOptions options;
  const Sketch cold = reconstruct(open_scene(scene.path()), options, nullptr).sketch;
  options.like = write_siblings("l-bracket", siblings);
  const Reconstruction foreign = reconstruct(open_scene(scene.path()), options, nullptr);
  EXPECT_EQ(count(foreign.report, "family_followed"), 0);
  EXPECT_EQ(json_of(foreign.sketch), json_of(cold));
}

TEST(FamilyStart, SiblingsThatCannotBeReadAreAnInputError) {
  const TempFolder scene;
  write_scene(synthesize(part_options("box-hole", 1, 4)), scene.path());
  ReconstructOptions options;
  options.like = scene.path() + "/nothing.json";
  EXPECT_THROW(reconstruct(open_scene(scene.path()), options, nullptr), InputError);
}

}  // namespace
}  // namespace sketchsplat
