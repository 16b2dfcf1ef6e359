// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pipelines/base/progress.h"

namespace sketchsplat {

/// Has eval/charts.py make tables and charts of out/rows.json, beside it. What cannot be made, for
/// want of Python or matplotlib, is a line of the progress that says what to install.
void write_charts(const std::string& out, Progress* progress);

}  // namespace sketchsplat
