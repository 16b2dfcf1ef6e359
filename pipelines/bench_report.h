// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/bench.h"

namespace sketchsplat {

/// The rows under their headings, aligned, a blank line between scenes. "-" where there is no
/// number. `columns` are names of numbers, empty: all.
std::string bench_table(const std::vector<BenchRow>& rows,
                        const std::vector<std::string>& columns = {});

/// Comma-separated, all digits; empty where there is no number.
std::string bench_csv(const std::vector<BenchRow>& rows);

/// {"version", "options", "rows": [{"scene", "variant", number: value, ...}]}; null where there is
/// no number. `options` are those that all rows share.
std::string bench_json(const std::vector<BenchRow>& rows, const OptionTexts& options);

/// Accuracy against time as SVG: F5 and F1 over the total seconds (logarithmic), a point per scene
/// in the colour of its variant, the means as rings.
std::string bench_chart(const std::vector<BenchRow>& rows);

}  // namespace sketchsplat
