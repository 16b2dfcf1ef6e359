// SPDX-License-Identifier: MIT
#include "raster/splats/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "raster/splats/lanes.h"

namespace sketchsplat {
namespace {

// A footprint in the units of the inner loops.
struct Pen {
  float u00, u01, u11;
  Pen(const Footprint& f, const Profile& profile)
      : u00(float(f.u00 * profile.whiten)),
        u01(float(f.u01 * profile.whiten)),
        u11(float(f.u11 * profile.whiten)) {}
};

SKETCHSPLAT_INLINE void add_patch(const TilePatch& patch, const Pen& pen, const Profile& profile,
                                  float peak, Tile* tile) {
  const Lanes ux = (kIota + patch.dx) * pen.u00;
  float* row = tile->value + patch.row * kLanes;
  for (int k = 0; k < patch.rows; ++k, row += kLanes) {
    const float dy = patch.dy + float(k);
    const Lanes u = ux + pen.u01 * dy;
    const float v = pen.u11 * dy;
    Lanes r = u * u + v * v;
    r = r < profile.r_max ? r : Lanes{} + profile.r_max;
    Lanes e;
    exp2_of<Lanes, BitLanes>(-r, &e);
    Lanes depth;
    std::memcpy(&depth, row, sizeof(depth));
    depth += peak * (e - profile.c0 + profile.c1 * r);
    std::memcpy(row, &depth, sizeof(depth));
  }
}

SKETCHSPLAT_CLONES
void add_all(const Footprint* footprints, size_t count, const Profile& profile,
             TouchedTiles* tiles) {
  for (size_t i = 0; i < count; ++i) {
    const Footprint& f = footprints[i];
    const Pen pen(f, profile);
    const float peak = float(f.peak * profile.scale);
    for (int k = tiles->first_patch[i]; k < tiles->first_patch[i + 1]; ++k) {
      const TilePatch& patch = tiles->patches[k];
      add_patch(patch, pen, profile, peak, &tiles->tiles[patch.slot]);
    }
  }
}

// Sums over the pixels of a footprint of G k, G h, G h u, ... with G = dL/dtau, h = 2^-r - rim.
struct Moments {
  Lanes k = {}, u = {}, v = {}, uu = {}, uv = {}, vv = {};
};

SKETCHSPLAT_INLINE void add_moments(const TilePatch& patch, const Pen& pen, const Profile& profile,
                                    const Tile& tile, Moments* m) {
  const Lanes ux = (kIota + patch.dx) * pen.u00;
  const float* row = tile.value + patch.row * kLanes;
  for (int k = 0; k < patch.rows; ++k, row += kLanes) {
    const float dy = patch.dy + float(k);
    const Lanes u = ux + pen.u01 * dy;
    const float v = pen.u11 * dy;
    Lanes r = u * u + v * v;
    r = r < profile.r_max ? r : Lanes{} + profile.r_max;
    Lanes e, G;
    exp2_of<Lanes, BitLanes>(-r, &e);
    std::memcpy(&G, row, sizeof(G));
    m->k += G * (e - profile.c0 + profile.c1 * r);
    const Lanes w = G * (e - profile.rim);
    const Lanes wu = w * u, wv = w * v;
    m->u += wu;
    m->v += wv;
    m->uu += wu * u;
    m->uv += wu * v;
    m->vv += wv * v;
  }
}

// With U the whitening matrix, z = U d: dq/dmean = -2 U^T z, dq/dS = -U^T z z^T U.
SKETCHSPLAT_INLINE void finish(const Moments& m, const Footprint& f, const Profile& profile,
                               FootprintGradient* g) {
  const double first = f.peak * profile.scale / profile.whiten;
  const double second = first / (2 * profile.whiten);
  const double u = first * sum(m.u), v = first * sum(m.v);
  const double uu = second * sum(m.uu), uv = second * sum(m.uv), vv = second * sum(m.vv);
  g->peak = profile.scale * sum(m.k);
  g->mean = {f.u00 * u, f.u01 * u + f.u11 * v};
  g->covariance(0, 0) = f.u00 * f.u00 * uu;
  g->covariance(0, 1) = g->covariance(1, 0) = f.u00 * (f.u01 * uu + f.u11 * uv);
  g->covariance(1, 1) = f.u01 * f.u01 * uu + 2 * f.u01 * f.u11 * uv + f.u11 * f.u11 * vv;
}

SKETCHSPLAT_CLONES
void gather_all(const Footprint* footprints, size_t count, const Profile& profile,
                const TouchedTiles& tiles, FootprintGradient* gradients) {
  for (size_t i = 0; i < count; ++i) {
    const Footprint& f = footprints[i];
    const Pen pen(f, profile);
    Moments m;
    for (int k = tiles.first_patch[i]; k < tiles.first_patch[i + 1]; ++k) {
      const TilePatch& patch = tiles.patches[k];
      add_moments(patch, pen, profile, tiles.tiles[patch.slot], &m);
    }
    finish(m, f, profile, &gradients[i]);
  }
}

// exp(-depth), 0 < result <= 1.
SKETCHSPLAT_INLINE float transmittance(float depth) {
  float t;
  exp2_of<float, std::uint32_t>(-std::min(depth, 80.0f) * kLog2E, &t);
  return t;
}

SKETCHSPLAT_CLONES
void expose_all(Tile* tiles, size_t count) {
  for (size_t s = 0; s < count; ++s) {
    for (float& value : tiles[s].value) value = 1 - transmittance(value);
  }
}

// Loss in excess of the empty picture's, per pixel; tile: optical depth -> derivative by it.
// ((I - E)^2 - E^2) / 2 is I (I - 2E) / 2: nothing cancels.
SKETCHSPLAT_INLINE void compare_tile(const Tile& edges, Tile* tile, float* excess) {
  for (int k = 0; k < Tile::kPixels; ++k) {
    const float E = edges.value[k], t = transmittance(tile->value[k]), I = 1 - t;
    const float weight = E >= 0 ? 1.0f : 0.0f;  // there is no pixel
    excess[k] = weight * I * (I - 2 * E) * 0.5f;
    tile->value[k] = weight * (I - E) * t;
  }
}

SKETCHSPLAT_CLONES
double compare_all(const EdgeTarget& target, TouchedTiles* by_depth) {
  double total = 0;
  alignas(64) float excess[Tile::kPixels];
  for (size_t s = 0; s < by_depth->tiles.size(); ++s) {
    const Tile& edges = target.tiles[target.tile_index[by_depth->touched[s]]];
    compare_tile(edges, &by_depth->tiles[s], excess);
    Lanes partial = {}, row;
    for (int k = 0; k < Tile::kPixels; k += kLanes) {
      std::memcpy(&row, excess + k, sizeof(row));
      partial += row;
    }
    total += sum(partial);
  }
  return total;
}

// Whether the slanted strip |u00 dx + u01 dy| < cutoff around the ellipse passes by a tile's patch.
bool passes_by(const Footprint& f, double cutoff, const TilePatch& patch) {
  const double half_x = 0.5 * (Tile::kSide - 1), half_y = 0.5 * (patch.rows - 1);
  const double u = f.u00 * (patch.dx + half_x) + f.u01 * (patch.dy + half_y);
  return std::abs(u) - f.u00 * half_x - std::abs(f.u01) * half_y > cutoff;
}

void add_patches(const Footprint& f, double cutoff, TouchedTiles* t) {
  TilePatch patch;
  for (int ty = f.y0 / Tile::kSide; ty <= f.y1 / Tile::kSide; ++ty) {
    const int top = std::max(f.y0, ty * Tile::kSide);
    patch.row = top - ty * Tile::kSide;
    patch.rows = std::min(f.y1, ty * Tile::kSide + Tile::kSide - 1) - top + 1;
    patch.dy = float(top - f.mean.y());
    for (int tx = f.x0 / Tile::kSide; tx <= f.x1 / Tile::kSide; ++tx) {
      patch.dx = float(tx * Tile::kSide - f.mean.x());
      if (passes_by(f, cutoff, patch)) continue;
      int& slot = t->slot[ty * t->tiles_x + tx];
      if (slot < 0) {
        slot = int(t->touched.size());
        t->touched.push_back(ty * t->tiles_x + tx);
      }
      patch.slot = slot;
      t->patches.push_back(patch);
    }
  }
}

}  // namespace

TouchedTiles accumulate_depth(const Camera& camera, const std::vector<Footprint>& footprints,
                              const RasterOptions& options) {
  TouchedTiles t;
  t.tiles_x = (camera.width + Tile::kSide - 1) / Tile::kSide;
  t.tiles_y = (camera.height + Tile::kSide - 1) / Tile::kSide;
  t.slot.assign(size_t(t.tiles_x) * t.tiles_y, -1);
  t.first_patch.push_back(0);
  for (const Footprint& f : footprints) {
    add_patches(f, options.cutoff, &t);
    t.first_patch.push_back(int(t.patches.size()));
  }
  t.tiles.assign(t.touched.size(), Tile{});
  add_all(footprints.data(), footprints.size(), Profile(options.cutoff), &t);
  return t;
}

void expose(TouchedTiles* tiles) { expose_all(tiles->tiles.data(), tiles->tiles.size()); }

double compare(const EdgeTarget& target, TouchedTiles* by_depth) {
  return target.empty_loss + compare_all(target, by_depth);
}

std::vector<FootprintGradient> gather_gradients(const TouchedTiles& by_depth,
                                                const std::vector<Footprint>& footprints,
                                                const RasterOptions& options) {
  std::vector<FootprintGradient> gradients(footprints.size());
  gather_all(footprints.data(), footprints.size(), Profile(options.cutoff), by_depth,
             gradients.data());
  return gradients;
}

}  // namespace sketchsplat
