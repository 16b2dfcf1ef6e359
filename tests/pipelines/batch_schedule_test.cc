// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipelines/base/resources.h"
#include "pipelines/base/schedule.h"
#include "pipelines/method/estimate.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

TEST(Schedule, StartsTheLongestFirstAsManyAsThereArePlacesAndRepetitionsLast) {
  Schedule schedule({{1, 10}, {5, 10}, {3, 10}}, 2, 1000);
  EXPECT_EQ(schedule.next(), 1);
  EXPECT_EQ(schedule.next(), 2);
  EXPECT_EQ(schedule.next(), -1) << "no place";
  schedule.ended(2, 10);
  schedule.again(2);
  EXPECT_EQ(schedule.next(), 0);
  EXPECT_FALSE(schedule.empty());
  schedule.ended(0, 10);
  EXPECT_EQ(schedule.next(), 2);
  EXPECT_TRUE(schedule.empty());
}

TEST(Schedule, KeepsWithinTheMemoryThatPiecesTurnOutToTakeUnlessOneAloneIsTooLarge) {
  Schedule schedule({{9, 500}, {8, 60}, {7, 30}, {6, 10}}, 3, 100);
  EXPECT_EQ(schedule.next(), 0) << "larger than all there is: alone";
  EXPECT_EQ(schedule.next(), -1);
  schedule.ended(0, 400);
  EXPECT_EQ(schedule.next(), 1);
  EXPECT_EQ(schedule.next(), 2) << "90 of 100 MB";
  schedule.ended(2, 90);
  EXPECT_EQ(schedule.next(), -1) << "three times as much: 180 + 30 of 100 MB";
  schedule.ended(1, 60);
  EXPECT_EQ(schedule.next(), 3);
}

TEST(Estimate, GrowsWithThePicturesAndShrinksWithThreads) {
  const ReconstructOptions options;
  const Load small = expected_load(12, 12 * 160 * 160, options, 1);
  const Load large = expected_load(50, 50 * 800 * 800, options, 1);
  EXPECT_GT(large.seconds, 5 * small.seconds);
  EXPECT_GT(large.memory_mb, 2 * small.memory_mb);
  EXPECT_LT(expected_load(50, 50 * 800 * 800, options, 4).seconds, large.seconds / 2);
  ReconstructOptions surfels = options;
  surfels.detector = "2dgs-sn";
  EXPECT_GT(expected_load(50, 50 * 800 * 800, surfels, 1).seconds, 5 * large.seconds);
}

TEST(Resources, AreThereAndTheSmallestLimitOfTheGroupsCounts) {
  EXPECT_GE(usable_cores(), 1);
  EXPECT_GT(usable_memory_mb(), 10);
  const TempFolder folder;
  folder.write("memory.max", "max\n");
  folder.write("slurm/memory.max", "8000000000\n");
  folder.write("slurm/job/memory.max", "9000000000\n");
  folder.write("slurm/job/cpu.max", "250000 100000\n");
  const std::string root = folder.path();
  EXPECT_EQ(least_of_groups(root, "slurm/job", "memory.max"), 8e9);
  EXPECT_EQ(least_of_groups(root, "slurm/job", "cpu.max"), 2.5);
  EXPECT_TRUE(std::isinf(least_of_groups(root, "", "memory.max")));
  EXPECT_TRUE(std::isinf(least_of_groups(root, "no/such/group", "memory.low")));
}

}  // namespace
}  // namespace sketchsplat
