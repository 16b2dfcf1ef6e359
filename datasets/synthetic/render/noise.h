// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

namespace sketchsplat {

/// Random numbers by address, not by turn: the same for any order of pixels, views and threads.
/// Mixing function: splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number
/// generators", 2014).
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
inline std::uint64_t hash(std::uint64_t seed, std::uint64_t view, std::uint64_t pixel,
                          std::uint64_t use) {
  return mix(mix(mix(mix(seed) ^ view) ^ pixel) ^ use);
}

/// In [0, 1).
inline double uniform(std::uint64_t bits) { return double(bits >> 11) * 0x1p-53; }

/// Standard normal (Box and Muller).
inline double normal(std::uint64_t bits) {
  const double u = uniform(bits), v = uniform(mix(bits));
  return std::sqrt(-2 * std::log(1 - u)) * std::cos(2 * M_PI * v);
}

}  // namespace sketchsplat
