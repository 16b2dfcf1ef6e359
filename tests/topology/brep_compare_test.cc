// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>

#include "datasets/types/errors.h"
#include "gmock/gmock.h"
#include "tests/topology/solids.h"
#include "topology/brep/compare.h"
#include "topology/brep/solid_step.h"

namespace sketchsplat {
namespace {

std::string write(const Solid& solid, const std::string& name) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string path =
      ::testing::TempDir() + "brep_compare_" + test->name() + "_" + name + ".step";
  const SolidCheck check = write_solid_step(solid, path);
  EXPECT_TRUE(check.valid) << check.why;
  return path;
}

SolidComparison compare(const Solid& solid, const Solid& truth) {
  return compare_solids(write(solid, "solid"), write(truth, "truth"));
}

TEST(BrepCompare, ASolidIsItself) {
  const std::vector<Solid> solids = {
      plate_with_hole(0.5), cone_solid(0), ball_octant(), elbow(), cut_rod(),
      half_cone(),          sphere_solid()};
  for (size_t i = 0; i < solids.size(); ++i) {
    const SolidComparison c = compare(solids[i], solids[i]);
    EXPECT_TRUE(c.valid) << i;
    EXPECT_TRUE(c.iou_is_exact) << i;
    EXPECT_NEAR(c.iou, 1, 1e-6) << i;
    EXPECT_EQ(c.face_f, 1) << i;
    EXPECT_EQ(c.faces, int(solids[i].faces.size()));
    EXPECT_LT(c.largest_distance, 1e-4) << i;
    EXPECT_NEAR(c.volume, c.true_volume, 1e-9 * c.volume) << i;
  }
}

TEST(BrepCompare, AShiftedBoxOverlapsByWhatItShould) {
  const Solid truth = box_solid({0, 0, 0}, {1, 1, 1});
  const SolidComparison c = compare(box_solid({0.2, 0, 0}, {1.2, 1, 1}), truth);
  EXPECT_NEAR(c.iou, 0.8 / 1.2, 1e-6);
  EXPECT_NEAR(c.largest_distance, 0.2, 1e-6);
  // Four sides lie in those of the truth, for four fifths only.
  EXPECT_EQ(c.face_precision, 0);
  const SolidComparison near = compare(box_solid({0.004, 0, 0}, {1.004, 1, 1}), truth);
  EXPECT_NEAR(near.iou, 0.996 / 1.004, 1e-6);
  EXPECT_EQ(near.face_f, 1);
  EXPECT_NEAR(near.largest_distance, 0.004, 1e-6);
}

TEST(BrepCompare, LinesSayWhatTheBooleanOperationSays) {
  // Off by so little that boolean operations stumble, or not: the number is right in any case.
  for (const double off : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    const SolidComparison c =
        compare(perturbed(plate_with_hole(0.2), 1e-6), scaled(plate_with_hole(0.2), 1 + off));
    EXPECT_NEAR(c.iou, 1 / std::pow(1 + off, 3), 2e-3) << off;
    EXPECT_EQ(c.face_f, 1) << off;
    EXPECT_NEAR(c.largest_distance, off * std::sqrt(5.25), 2e-4) << off;
  }
}

TEST(BrepCompare, SmallAndLargePartsAreTheSame) {
  for (const double size : {1e-3, 1e5}) {
    const SolidComparison c = compare(scaled(box_solid({0.2, 0, 0}, {1.2, 1, 1}), size),
                                      scaled(box_solid({0, 0, 0}, {1, 1, 1}), size));
    EXPECT_NEAR(c.iou, 0.8 / 1.2, 1e-3) << size;
    EXPECT_NEAR(c.largest_distance / size, 0.2, 1e-3) << size;
    EXPECT_NEAR(c.volume / std::pow(size, 3), 1, 1e-3) << size;
  }
}

TEST(BrepCompare, AMissingHoleCostsItsFaces) {
  const SolidComparison c = compare(box_solid({0, 0, 0}, {2, 1, 0.5}), plate_with_hole(0.2));
  EXPECT_NEAR(c.iou, 1 - M_PI / 16 * 0.2, 1e-5);
  EXPECT_EQ(c.faces, 6);
  EXPECT_EQ(c.true_faces, 8);
  EXPECT_EQ(c.face_precision, 1) << "less than a tenth of the top is not there";
  EXPECT_NEAR(c.face_recall, 6.0 / 8, 1e-9);
  EXPECT_NEAR(c.to_truth, 0.2, 0.01) << "the middle of the hole is far from its wall and floor";
  EXPECT_NEAR(c.from_truth, 0.2, 1e-3);
}

TEST(BrepCompare, AnotherKindOfSurfaceIsWrong) {
  // A cone that is all but a cylinder.
  SolidMaker m;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const int low = m.circle({0, 0, 0}, up, 1), high = m.circle({0, 0, 1}, up, 1);
  m.face(SolidMaker::plane({0, 0, 0}, -up), false, {{{low, false}}});
  m.face(SolidMaker::plane({0, 0, 1}, up), false, {{{high, true}}});
  m.face(SolidMaker::cylinder({0, 0, 0}, up, 1), false, {{{low, true}}, {{high, false}}});
  const SolidComparison c = compare(cone_solid(0.999), m.solid);
  EXPECT_NEAR(c.face_f, 2.0 / 3, 1e-9);
  EXPECT_GT(c.iou, 0.998);
}

TEST(BrepCompare, FilesWithoutSolidsAreBadInput) {
  const std::string path = write(sphere_solid(), "solid");
  EXPECT_THROW(compare_solids(path, path + ".none"), InputError);
  std::ofstream(path + ".text") << "no STEP file";
  EXPECT_THROW(compare_solids(path + ".text", path), InputError);
}

}  // namespace
}  // namespace sketchsplat
