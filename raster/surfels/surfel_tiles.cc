// SPDX-License-Identifier: MIT
#include "raster/surfels/surfel_tiles.h"

#include <algorithm>

namespace sketchsplat {
namespace {

typedef std::int32_t IntLanes __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
constexpr float kLn2 = 0.693147181f;

SKETCHSPLAT_INLINE bool any(const IntLanes& mask) {
  std::uint64_t parts[4];
  static_assert(sizeof(parts) == sizeof(mask), "");
  std::memcpy(parts, &mask, sizeof(mask));
  return ((parts[0] | parts[1]) | (parts[2] | parts[3])) != 0;
}

// 2 Phi(s) and phi(s): Abramowitz and Stegun 26.2.17; its error, 7.5e-8 in Phi, is that of floats.
SKETCHSPLAT_INLINE void normal_cdf(const Lanes& s, Lanes* twice, Lanes* density) {
  const Lanes size = s < 0 ? -s : s;
  const Lanes clamped = size < 13.0f ? size : Lanes{} + 13.0f;  // 2^-122: floats end there
  Lanes e;
  exp2_of<Lanes, BitLanes>(clamped * clamped * (-0.5f * kLog2E), &e);
  *density = e * 0.398942280f;
  const Lanes t = 1.0f / (1.0f + 0.2316419f * clamped);
  Lanes p = t * 1.330274429f - 1.821255978f;
  p = p * t + 1.781477937f;
  p = p * t - 0.356563782f;
  p = p * t + 0.319381530f;
  const Lanes tail = 2.0f * *density * (p * t);
  const Lanes result = s < 0 ? tail : 2.0f - tail;
  *twice = s == 0 ? Lanes{} + 1.0f : result;
}

// A footprint at the pixels of a row of a tile.
struct Sample {
  Lanes dx, u, v, p0, p1, rw;  // u = p0 rw, v = p1 rw, rw = 1 / w
  Lanes e, k;                  // 2^-r and k without its scale, of the larger kernel
  Lanes F, density;            // 2 Phi and phi; F is 1 where k(q2) is the larger one
  IntLanes low;                // there
  IntLanes inside;             // drawn at all
  Lanes alpha;
};

SKETCHSPLAT_INLINE void profile_at(const Profile& profile, const Lanes& r, Lanes* e, Lanes* k) {
  const Lanes clamped = r < profile.r_max ? r : Lanes{} + profile.r_max;
  exp2_of<Lanes, BitLanes>(-clamped, e);
  const Lanes lowered = *e - profile.c0 + profile.c1 * clamped;
  *k = lowered > 0 ? lowered : Lanes{};
}

// False if no pixel of the row that still lets light through (`alive`) is inside.
template <bool kSkewed>
SKETCHSPLAT_INLINE bool sample(const SurfelLoop& loop, const SurfelFootprint& f, const Lanes& dx,
                               float dy, const IntLanes& alive, Sample* s) {
  s->dx = dx;
  s->p0 = f.a00 * dx + f.a01 * dy;
  s->p1 = f.a10 * dx + f.a11 * dy;
  const Lanes w = f.b0 * dx + (f.b1 * dy + f.facing);
  const IntLanes meets = w > 0.25f;
  s->rw = 1.0f / (meets ? w : Lanes{} + 1.0f);
  s->u = s->p0 * s->rw;
  s->v = s->p1 * s->rw;
  const Lanes r3 = meets ? s->u * s->u + s->v * s->v : Lanes{} + 1e30f;
  const Lanes r2 = (dx * dx + dy * dy) * loop.lowpass;
  const float r_max = loop.profile.r_max;
  s->low = r2 < r3;
  const Lanes r = s->low ? r2 : r3;
  s->inside = (r < r_max) & alive;
  if (!any(s->inside)) return false;
  if (kSkewed) {
    Lanes e2, e3, k2, k3, F;
    profile_at(loop.profile, r2, &e2, &k2);
    profile_at(loop.profile, r3, &e3, &k3);
    const Lanes slope = f.skew_u * s->u + f.skew_v * s->v;
    normal_cdf(r3 < r_max ? slope : Lanes{}, &F, &s->density);
    const Lanes value = F * k3;
    // Without skew the choice must be that of the plain Gaussian, also where the values tie.
    s->low = F == 1.0f ? s->low : k2 > value;
    s->e = s->low ? e2 : e3;
    s->k = s->low ? k2 : k3;
    s->F = s->low ? Lanes{} + 1.0f : F;
  } else {
    profile_at(loop.profile, r, &s->e, &s->k);
    s->F = s->density = Lanes{} + 1.0f;
  }
  const Lanes full = f.opacity * (s->F * s->k);
  const Lanes clamped = full < loop.max_alpha ? full : Lanes{} + loop.max_alpha;
  s->alpha = s->inside ? clamped : Lanes{};
  return true;
}

// Rows of a tile and the transmittance of its pixels (0 where none is wanted).
struct Rows {
  Lanes T[kLanes];
  int first = kLanes, last = -1;  // not finished

  SKETCHSPLAT_INLINE explicit Rows(const SurfelTile& tile) {
    for (int y = 0; y < kLanes; ++y) {
      const std::uint32_t bits = std::uint32_t(tile.mask >> (y * kLanes)) & 255u;
      for (int x = 0; x < kLanes; ++x) T[y][x] = float(bits >> x & 1u);
      if (bits == 0) continue;
      first = std::min(first, y);
      last = y;
    }
  }
  SKETCHSPLAT_INLINE bool alive(float least) {
    while (first <= last && !any(T[first] >= least)) ++first;
    while (first <= last && !any(T[last] >= least)) --last;
    return first <= last;
  }
};

// Calls visit(entry, row, footprint, sample, T before) for every row of every entry where
// something is drawn, front to back, and finish(entry) after each entry.
template <bool kSkewed, typename Visit, typename Finish>
SKETCHSPLAT_INLINE void walk(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                             const SurfelFootprint* footprints, Rows* rows, const Visit& visit,
                             const Finish& finish) {
  const int x0 = tile.tx * kLanes, y0 = tile.ty * kLanes;
  Sample s;
  for (int e = tile.begin; e < tile.end; ++e) {
    if (!rows->alive(loop.min_transmittance)) return;
    const SurfelFootprint& f = footprints[entries[e]];
    const Lanes dx = kIota + float(x0 - f.mean.x());
    const float dy0 = float(y0 - f.mean.y());
    const int last = std::min(rows->last, f.y1 - y0);
    for (int y = std::max(rows->first, f.y0 - y0); y <= last; ++y) {
      const Lanes T = rows->T[y];
      if (!sample<kSkewed>(loop, f, dx, dy0 + float(y), T >= loop.min_transmittance, &s)) continue;
      visit(e - tile.begin, y, f, s, T);
      rows->T[y] = T * (1.0f - s.alpha);
    }
    finish(e - tile.begin);
  }
}

template <bool kSkewed>
SKETCHSPLAT_INLINE void composite(const SurfelLoop& loop, const SurfelTile& tile,
                                  const int* entries, const SurfelFootprint* footprints,
                                  SurfelSums* sums) {
  Rows rows(tile);
  const float origin = footprints[entries[tile.begin]].depth;
  *sums = SurfelSums{};
  sums->origin = origin;
  Lanes before[kLanes];
  std::copy_n(rows.T, kLanes, before);
  const auto visit = [&](int, int y, const SurfelFootprint& f, const Sample& s, const Lanes& T)
      __attribute__((always_inline)) {
    const Lanes w = T * s.alpha;
    const Lanes z = f.depth * (s.low ? Lanes{} + 1.0f : s.rw);
    const Lanes m = z - origin;
    for (int c = 0; c < 3; ++c) {
      sums->color[c][y] += w * f.color[c];
      sums->normal[c][y] += w * f.normal[c];
    }
    sums->m[y] += w * m;
    const IntLanes halved = (T > 0.5f) & (T * (1.0f - s.alpha) <= 0.5f);
    sums->median[y] = halved ? z : sums->median[y];
  };
  walk<kSkewed>(loop, tile, entries, footprints, &rows, visit,
                [](int) __attribute__((always_inline)){});
  for (int y = 0; y < kLanes; ++y) sums->alpha[y] = before[y] - rows.T[y];
}

// Per pixel: the derivative of L by the weight of a surfel with colour c, normal n and depth m is
// base + m by_depth + by_color . c + by_normal . n, and `rest` the sum of w times that over the
// surfels that are still to come, for those lose light by the alpha of one before them.
struct Adjoint {
  Lanes base[kLanes], rest[kLanes];

  SKETCHSPLAT_INLINE Adjoint(const SurfelSums& s, const SurfelTileGradient& g) {
    for (int y = 0; y < kLanes; ++y) {
      base[y] = g.alpha[y] + g.depth[y] * s.origin;
      rest[y] = base[y] * s.alpha[y] + g.depth[y] * s.m[y];
      for (int c = 0; c < 3; ++c) {
        rest[y] += g.color[c][y] * s.color[c][y] + g.normal[c][y] * s.normal[c][y];
      }
    }
  }
};

// Adds what one row gives to the surfel's own numbers. `by_full`: by alpha before the clamp;
// `by_z`: by the depth.
template <bool kSkewed>
SKETCHSPLAT_INLINE void add_row(const SurfelLoop& loop, const SurfelFootprint& f, const Sample& s,
                                float dy, const Lanes& by_full, const Lanes& by_z, Lanes* sum) {
  using G = SurfelEntryGradient;
  const Lanes zero = {};
  const Lanes lowered = s.e - loop.profile.rim;
  const Lanes by_value = by_full * f.opacity;  // by F k
  const Lanes by_k = by_value * s.F;
  const Lanes by_r = by_k * lowered * -kLn2;
  sum[G::kOpacity] += by_full * s.F * s.k;

  const Lanes low = s.low ? by_r * (-2.0f * loop.lowpass) : zero;
  const Lanes low_x = low * s.dx, low_y = low * dy;
  sum[G::kMeanX] += low_x;
  sum[G::kMeanY] += low_y;
  sum[G::kDepth] += s.low ? by_z : zero;

  const Lanes by_r3 = s.low ? zero : by_r;
  Lanes by_u = by_r3 * 2.0f * s.u, by_v = by_r3 * 2.0f * s.v;
  if (kSkewed) {
    const Lanes by_slope = s.low ? zero : by_value * s.k * 2.0f * s.density;
    by_u += by_slope * f.skew_u;
    by_v += by_slope * f.skew_v;
    sum[G::kSkewU] += by_slope * s.u;
    sum[G::kSkewV] += by_slope * s.v;
  }
  const Lanes by_rw = s.p0 * by_u + s.p1 * by_v + (s.low ? zero : by_z * f.depth);
  const Lanes by_p0 = s.rw * by_u, by_p1 = s.rw * by_v, by_w = -(s.rw * s.rw) * by_rw;
  sum[G::kU] += by_p0;
  sum[G::kUx] += by_p0 * s.dx;
  sum[G::kUy] += by_p0 * dy;
  sum[G::kV] += by_p1;
  sum[G::kVx] += by_p1 * s.dx;
  sum[G::kVy] += by_p1 * dy;
  sum[G::kW] += by_w;
  sum[G::kWx] += by_w * s.dx;
  sum[G::kWy] += by_w * dy;
  const Lanes shift_x = low_x - (by_p0 * f.a00 + by_p1 * f.a10 + by_w * f.b0);
  const Lanes shift_y = low_y - (by_p0 * f.a01 + by_p1 * f.a11 + by_w * f.b1);
  sum[G::kAbsX] += shift_x < 0 ? -shift_x : shift_x;
  sum[G::kAbsY] += shift_y < 0 ? -shift_y : shift_y;

  // Hess k = -lowered I + e (u, v) (u, v)^T, in standard deviations; u^2 = 2 ln 2 u'^2.
  const Lanes curve = s.low ? zero : by_k * (2.0f * kLn2) * s.e;
  const Lanes round = s.low ? zero : by_k * lowered;
  Lanes uu = curve * s.u * s.u - round, uv = curve * s.u * s.v, vv = curve * s.v * s.v - round;
  if (kSkewed) {
    // + grad F grad k^T + grad k grad F^T + k Hess F, with Hess F = -2 s phi(s) a a^T.
    const Lanes dense = s.low ? zero : by_value * s.density;
    const Lanes mixed = dense * -2.0f * lowered;
    const Lanes bent = dense * (-1.0f / kLn2) * (f.skew_u * s.u + f.skew_v * s.v) * s.k;
    uu += mixed * 2.0f * f.skew_u * s.u + bent * f.skew_u * f.skew_u;
    uv += mixed * (f.skew_u * s.v + f.skew_v * s.u) + bent * f.skew_u * f.skew_v;
    vv += mixed * 2.0f * f.skew_v * s.v + bent * f.skew_v * f.skew_v;
  }
  sum[G::kSplitUU] += uu;
  sum[G::kSplitUV] += uv;
  sum[G::kSplitVV] += vv;
}

template <bool kSkewed>
SKETCHSPLAT_INLINE void composite_backward(const SurfelLoop& loop, const SurfelTile& tile,
                                           const int* entries, const SurfelFootprint* footprints,
                                           const SurfelSums& sums, const SurfelTileGradient& g,
                                           SurfelEntryGradient* gradients) {
  using G = SurfelEntryGradient;
  Rows rows(tile);
  Adjoint adjoint(sums, g);
  Lanes sum[G::kTerms] = {};
  const auto visit = [&](int, int y, const SurfelFootprint& f, const Sample& s, const Lanes& T)
      __attribute__((always_inline)) {
    const Lanes w = T * s.alpha;
    const Lanes m = f.depth * (s.low ? Lanes{} + 1.0f : s.rw) - sums.origin;
    Lanes by_weight = adjoint.base[y] + m * g.depth[y];
    for (int c = 0; c < 3; ++c) {
      by_weight += g.color[c][y] * f.color[c] + g.normal[c][y] * f.normal[c];
      sum[G::kColor0 + c] += w * g.color[c][y];
      sum[G::kNormal0 + c] += w * g.normal[c][y];
    }
    sum[G::kWeight] += w;
    adjoint.rest[y] -= w * by_weight;
    const Lanes by_alpha = T * by_weight - adjoint.rest[y] / (1.0f - s.alpha);
    const IntLanes free = s.inside & (s.alpha < loop.max_alpha);
    const IntLanes halved = (T > 0.5f) & (T * (1.0f - s.alpha) <= 0.5f);
    const Lanes by_z = w * g.depth[y] + (halved ? g.median[y] : Lanes{});
    const float dy = float(tile.ty * kLanes - f.mean.y()) + float(y);
    add_row<kSkewed>(loop, f, s, dy, free ? by_alpha : Lanes{}, by_z, sum);
  };
  const auto finish = [&](int entry) __attribute__((always_inline)) {
    for (int t = 0; t < G::kTerms; ++t) {
      gradients[entry].sum[t] = float(sketchsplat::sum(sum[t]));
      sum[t] = Lanes{};
    }
  };
  walk<kSkewed>(loop, tile, entries, footprints, &rows, visit, finish);
}

template <bool kSkewed>
SKETCHSPLAT_INLINE void weights_of(const SurfelLoop& loop, const SurfelTile& tile,
                                   const int* entries, const SurfelFootprint* footprints,
                                   float* weights) {
  Rows rows(tile);
  const auto visit = [&](int entry, int y, const SurfelFootprint&, const Sample& s, const Lanes& T)
      __attribute__((always_inline)) {
    const Lanes w = T * s.alpha;
    std::memcpy(weights + entry * Tile::kPixels + y * kLanes, &w, sizeof(w));
  };
  walk<kSkewed>(loop, tile, entries, footprints, &rows, visit,
                [](int) __attribute__((always_inline)){});
}

}  // namespace

SurfelLoop::SurfelLoop(const SurfelOptions& options)
    : profile(options.cutoff),
      skewed(options.kernel == SurfelKernel::kSkewNormal),
      lowpass(float(profile.whiten * profile.whiten / (options.lowpass_px * options.lowpass_px))),
      max_alpha(float(options.max_alpha)),
      min_transmittance(float(options.min_transmittance)) {}

SKETCHSPLAT_CLONES
void composite_tile(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                    const SurfelFootprint* footprints, SurfelSums* sums) {
  if (loop.skewed) {
    composite<true>(loop, tile, entries, footprints, sums);
  } else {
    composite<false>(loop, tile, entries, footprints, sums);
  }
}

SKETCHSPLAT_CLONES
void composite_tile_backward(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                             const SurfelFootprint* footprints, const SurfelSums& sums,
                             const SurfelTileGradient& by_images, SurfelEntryGradient* gradients) {
  std::fill_n(gradients, tile.end - tile.begin, SurfelEntryGradient{});
  if (loop.skewed) {
    composite_backward<true>(loop, tile, entries, footprints, sums, by_images, gradients);
  } else {
    composite_backward<false>(loop, tile, entries, footprints, sums, by_images, gradients);
  }
}

SKETCHSPLAT_CLONES
void tile_weights(const SurfelLoop& loop, const SurfelTile& tile, const int* entries,
                  const SurfelFootprint* footprints, float* weights) {
  std::fill_n(weights, size_t(tile.end - tile.begin) * Tile::kPixels, 0.0f);
  if (loop.skewed) {
    weights_of<true>(loop, tile, entries, footprints, weights);
  } else {
    weights_of<false>(loop, tile, entries, footprints, weights);
  }
}

SKETCHSPLAT_CLONES
void twice_normal_cdf(const float* s, int count, float* value, float* density) {
  for (int i = 0; i < count; ++i) {
    Lanes twice, dense;
    normal_cdf(Lanes{} + s[i], &twice, &dense);
    value[i] = twice[0];
    density[i] = dense[0];
  }
}

}  // namespace sketchsplat
