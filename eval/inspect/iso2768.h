// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat {

/// Tolerance classes of ISO 2768-1:1989: fine, medium, coarse, very coarse.
enum class Iso2768 { kNone, kFine, kMedium, kCoarse, kVeryCoarse };

/// Permissible deviation (+-) of a linear size [mm], table 1; where the table has none for the
/// class (too small, too large): that of the nearest size that has one. 0 for kNone.
double iso2768_linear(Iso2768 grade, double size_mm);

/// The same of an angle [deg] by the length of its shorter side [mm], table 3.
double iso2768_angle(Iso2768 grade, double leg_mm);

}  // namespace sketchsplat
