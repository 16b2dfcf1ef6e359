// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace sketchsplat {

/// Real roots in [low, high] at which a polynomial changes its sign, ascending. `coefficients`: of
/// x^0, x^1, ... To about 1e-12 of the range. Highest coefficients may vanish, as they do for
/// straight profiles: eigenvalues of companion matrices, which libraries offer, do not bear that.
std::vector<double> roots_between(const std::vector<double>& coefficients, double low, double high);

}  // namespace sketchsplat
