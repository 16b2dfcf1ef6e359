// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "raster/splats/loss.h"

// What the inner loops of the rasterizers share; for their .cc files only.
//
// The loops are written over fixed groups of 8 floats, so that the order of every sum, and with it
// every byte, is the same for all instruction sets; the compiler makes one version for each. AVX2
// is 4 times as fast as the default here, AVX-512 2 % faster still. Groups of 16 would gain a
// quarter on AVX-512 and lose a factor of 3 on AVX2; scanline spans instead of tiles take 1.5 times
// as long. Of functions that a header declares clang 14 makes the first version alone, which other
// machines cannot run: with clang there is the default.
#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define SKETCHSPLAT_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SKETCHSPLAT_CLONES
#endif
#define SKETCHSPLAT_INLINE inline __attribute__((always_inline))

namespace sketchsplat {

constexpr int kLanes = Tile::kSide;
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::uint32_t BitLanes __attribute__((vector_size(kLanes * sizeof(float))));
constexpr Lanes kIota = {0, 1, 2, 3, 4, 5, 6, 7};
constexpr float kLog2E = 1.44269504f;

// 2^x for x in [-125, 0], relative error below 3e-7: 2^round(x) through the exponent bits times a
// polynomial on [-1/2, 1/2], the Taylor series of degree 7 economised by Chebyshev polynomials to
// degree 5. F is float or Lanes, I the unsigned integer of that size.
template <typename F, typename I>
SKETCHSPLAT_INLINE void exp2_of(const F& x, F* result) {
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: the sum has the integer in its low bits
  const F shifted = x + kRound;
  const F f = x - (shifted - kRound);
  F p = f * 1.3400288e-3f + 9.6758921e-3f;
  p = p * f + 5.5503275e-2f;
  p = p * f + 2.4022109e-1f;
  p = p * f + 6.9314721e-1f;
  p = p * f + 1.0f;
  I bits;
  std::memcpy(&bits, &shifted, sizeof(bits));
  bits = (bits + 127u) << 23;
  F power;
  std::memcpy(&power, &bits, sizeof(power));
  *result = p * power;
}

// k(q) of RasterOptions in terms of r = q log2(e) / 2, so that exp(-q/2) = 2^-r, and its scale.
struct Profile {
  float r_max;   // r at the rim
  float rim;     // exp(-Q/2)
  float c0, c1;  // k = (2^-r - c0 + c1 r) * scale, dk/dq = -(2^-r - rim) * scale / 2
  double scale;
  double whiten;  // footprint's U times this gives r = |U d|^2

  explicit Profile(double cutoff) {
    const double half = cutoff * cutoff / 2, e = std::exp(-half), log2e = 1 / std::log(2.0);
    r_max = float(half * log2e);
    rim = float(e);
    c0 = float(e * (1 + half));
    c1 = float(e / log2e);
    scale = 1 / (1 - e * (1 + half));
    whiten = std::sqrt(log2e / 2);
  }
};

SKETCHSPLAT_INLINE double sum(const Lanes& x) {
  return double((x[0] + x[4]) + (x[2] + x[6])) + double((x[1] + x[5]) + (x[3] + x[7]));
}

}  // namespace sketchsplat
