// SPDX-License-Identifier: MIT
// How good the method is, at least. Floors lie a little below what was measured when they were set;
// who makes the method better raises them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

TEST_F(Program, BenchOfAFewPartsKeepsItsFloors) {
  const Outcome o = run("bench --suite " SKETCHSPLAT_SOURCE_DIR "/eval/suites/floors.yml --out " +
                        in_folder("bench"));
  ASSERT_EQ(o.status, 0) << o.err;
  const nlohmann::json rows =
      nlohmann::json::parse(text_of_file(folder_ / "bench" / "rows.json")).at("rows");
  std::map<std::string, std::map<std::string, double>> mean;
  std::map<std::string, int> count;
  for (const auto& row : rows) {
    EXPECT_EQ(row["status"], "0") << row;
    const std::string variant = row["variant"];
    ++count[variant];
    for (const char* name : {"F5", "F5_visible", "fine_F1", "structure_f"})
      mean[variant][name] += double(row.at(name));
  }
  for (auto& [variant, numbers] : mean)
    for (auto& [name, value] : numbers) value /= count[variant];
  EXPECT_GE(mean["fast"]["F5"], 93) << o.out;
  EXPECT_GE(mean["balanced"]["F5"], 96.5) << o.out;
  EXPECT_GE(mean["balanced"]["fine_F1"], 84) << o.out;
  EXPECT_GE(mean["balanced"]["structure_f"], 77) << o.out;
  EXPECT_GE(mean["balanced"]["F5_visible"], 96.5) << o.out;
}

}  // namespace
}  // namespace sketchsplat
