// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "eval/evaluate.h"

namespace sketchsplat {

/// One row of numbers under its headings, aligned; `name` stands at its beginning.
/// F, P, R in per cent, Acc and Comp in thousandths; F5/F2/F1 "fine". "-" where there is no number.
std::string to_table(const Evaluation& evaluation, const std::string& name = "");

/// All numbers as a JSON object, indented: acc, comp, chamfer in thousandths, P20 ... F1 in per
/// cent; `fine` with the same keys; `structure`. null where there is no number.
std::string to_json(const Evaluation& evaluation);

}  // namespace sketchsplat
