// SPDX-License-Identifier: MIT
#include "datasets/synthetic/photo/photo_patterns.h"

#include <algorithm>
#include <cmath>

#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2f;

Color mixed(const Color& a, const Color& b, float share) { return a + (b - a) * share; }

std::uint64_t bits_at(std::uint64_t seed, int x, int y) {
  return mix(seed ^ (std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(y)));
}

float share_of(std::uint64_t bits, int which) {
  return float((bits >> (16 * which)) & 0xffff) / 65536.0f;
}

// Lattice noise in [0, 1] with smooth steps (Perlin, "An image synthesizer", 1985, with values in
// place of gradients).
float noise(const Vector2f& q, std::uint64_t seed) {
  const float fx = std::floor(q.x()), fy = std::floor(q.y());
  const int x = int(fx), y = int(fy);
  const auto step = [](float t) { return t * t * (3 - 2 * t); };
  const float s = step(q.x() - fx), t = step(q.y() - fy);
  const float a = share_of(bits_at(seed, x, y), 0), b = share_of(bits_at(seed, x + 1, y), 0);
  const float c = share_of(bits_at(seed, x, y + 1), 0),
              d = share_of(bits_at(seed, x + 1, y + 1), 0);
  return a + (b - a) * s + (c - a) * t + (a - b - c + d) * s * t;
}

// Octaves in [-1, 1], the first one of wavelength 1; those shorter than two footprints have faded.
float clouds(const Vector2f& q, std::uint64_t seed, int octaves, float footprint) {
  float sum = 0, share = 0.5f, wave = 1;
  for (int i = 0; i < octaves; ++i, share *= 0.6f, wave *= 0.5f) {
    const float visible = std::clamp(wave / footprint - 1.5f, 0.0f, 1.0f);
    if (visible <= 0) break;
    sum += visible * share * (2 * noise(q / wave, seed + i) - 1);
  }
  return sum;
}

// Distance from a point to a segment.
float distance(const Vector2f& p, const Vector2f& a, const Vector2f& b) {
  const Vector2f along = b - a, to = p - a;
  const float t = std::clamp(to.dot(along) / along.squaredNorm(), 0.0f, 1.0f);
  return (to - t * along).norm();
}

// Some of eight strokes of a box of 1 by 1.4.
bool in_glyph(const Vector2f& p, std::uint64_t bits) {
  static const float strokes[8][4] = {{0, 0, 0, 1.4f},    {1, 0, 1, 1.4f},      {0, 0, 1, 0},
                                      {0, 0.7f, 1, 0.7f}, {0, 1.4f, 1, 1.4f},   {0, 0, 1, 1.4f},
                                      {1, 0, 0, 1.4f},    {0.5f, 0, 0.5f, 1.4f}};
  constexpr float kHalfWidth = 0.13f;
  for (int k = 0; k < 4; ++k) {
    const float* s = strokes[(bits >> (3 * k)) & 7];
    if (distance(p, {s[0], s[1]}, {s[2], s[3]}) < kHalfWidth) return true;
  }
  return false;
}

// Lines of `size`, words of two to eight glyphs.
bool is_text(const Vector2f& q, float size, std::uint64_t seed) {
  const float line = std::floor(q.y() / size), advance = 0.5f * size;
  const int row = int(line), column = int(std::floor(q.x() / advance));
  const std::uint64_t bits = bits_at(seed, column, row);
  if (share_of(bits, 3) < 0.17f) return false;  // between words
  const Vector2f at(q.x() - float(column) * advance, q.y() - line * size);
  const float width = 0.36f * size;
  return in_glyph({(at.x() - 0.07f * size) / width, (at.y() - 0.25f * size) / width}, bits);
}

// The nearest of one point in each cell, and how much further away the second nearest is.
std::uint64_t nearest_cell(const Vector2f& q, std::uint64_t seed, float* margin) {
  const int x = int(std::floor(q.x())), y = int(std::floor(q.y()));
  float first = 1e9f, second = 1e9f;
  std::uint64_t found = 0;
  for (int j = y - 1; j <= y + 1; ++j)
    for (int i = x - 1; i <= x + 1; ++i) {
      const std::uint64_t bits = bits_at(seed, i, j);
      const float d =
          (q - Vector2f(float(i) + share_of(bits, 0), float(j) + share_of(bits, 1))).norm();
      if (d < first) {
        second = first;
        first = d;
        found = bits;
      } else {
        second = std::min(second, d);
      }
    }
  *margin = second - first;
  return found;
}

// A spot in some of the cells, inside of them.
bool in_spot(const Vector2f& q, std::uint64_t seed, float share, float* strength) {
  const int x = int(std::floor(q.x())), y = int(std::floor(q.y()));
  const std::uint64_t bits = bits_at(seed, x, y);
  if (share_of(bits, 3) > share) return false;
  const float radius = 0.08f + 0.27f * share_of(bits, 2) * share_of(bits, 2);
  const Vector2f middle(float(x) + radius + (1 - 2 * radius) * share_of(bits, 0),
                        float(y) + radius + (1 - 2 * radius) * share_of(bits, 1));
  *strength = share_of(mix(bits), 0);
  return (q - middle).squaredNorm() < radius * radius;
}

Color wood(const Pattern& p, const Vector2f& q, float footprint) {
  const Vector2f unit = q / p.size;
  const float f = footprint / p.size;
  // Growth rings cut at a small angle: bands along u that wander.
  const float wander = 1.6f * clouds({0.22f * unit.x(), 0.8f * unit.y()}, p.seed, 2, f);
  const float ring = unit.y() * 1.5f + 1.3f * wander;
  const float band = 0.5f + 0.5f * std::sin(float(2 * M_PI) * ring);
  const float fibres = clouds({1.2f * unit.x(), 16 * unit.y()}, p.seed + 10, 3, 16 * f);
  float share =
      0.2f + 0.4f * band * band + 0.55f * fibres + 0.2f * clouds(0.5f * unit, p.seed + 20, 3, f);
  Color color = mixed(p.light, p.dark, std::clamp(share, 0.0f, 1.0f));
  float strength;  // pores, flecks and scratches of use
  if (in_spot({4 * unit.x(), 14 * unit.y()}, p.seed + 30, 0.25f, &strength))
    color *= 1 - 0.5f * strength;
  if (in_spot({7 * unit.y(), 6 * unit.x()}, p.seed + 31, 0.05f, &strength))
    color = mixed(color, Color(0.75f, 0.7f, 0.6f), 0.1f + 0.3f * strength);
  return color;
}

Color bricks(const Pattern& p, const Vector2f& q) {
  const float height = 0.5f * p.size, row = std::floor(q.y() / height);
  const float shifted = q.x() + ((int(row) & 1) ? 0.5f * p.size : 0.0f);
  const float column = std::floor(shifted / p.size);
  const float x = shifted - column * p.size, y = q.y() - row * height, joint = 0.06f * p.size;
  if (x < joint || y < joint) return p.light;
  const std::uint64_t bits = bits_at(p.seed, int(column), int(row));
  return mixed(p.dark, p.light, 0.5f * share_of(bits, 0));
}

Color planks(const Pattern& p, const Vector2f& q, float footprint) {
  const float board = std::floor(q.y() / p.size), at = q.y() / p.size - board;
  const std::uint64_t bits = bits_at(p.seed, 0, int(board));
  if (at < 0.03f) return 0.5f * p.dark;
  const float grain =
      clouds({3 * q.x() / p.size, 14 * q.y() / p.size}, bits, 3, 14 * footprint / p.size);
  return mixed(p.dark, p.light,
               std::clamp(0.5f * share_of(bits, 1) + 0.3f + 0.4f * grain, 0.0f, 1.0f));
}

Color cells(const Pattern& p, const Vector2f& q) {
  float margin;
  const std::uint64_t bits = nearest_cell(q / p.size, p.seed, &margin);
  if (margin < 0.06f) return p.dark;
  return color_of(share_of(bits, 2), 0.2f + 0.6f * share_of(bits, 3),
                  0.3f + 0.5f * share_of(mix(bits), 0));
}

Color marble(const Pattern& p, const Vector2f& q, float footprint) {
  const Vector2f unit = q / p.size;
  const float f = footprint / p.size, warp = 2.5f * clouds(unit, p.seed, 4, f);
  const float vein = 0.5f + 0.5f * std::sin(float(2 * M_PI) * (0.7f * unit.x() + warp));
  const Color third = 0.5f * (p.light + p.dark).reverse();
  return mixed(mixed(p.dark, p.light, vein), third,
               std::clamp(0.5f + 1.5f * clouds(2 * unit, p.seed + 9, 3, f), 0.0f, 1.0f));
}

Color stripes(const Pattern& p, const Vector2f& q) {
  const float stripe = std::floor(q.x() / p.size), at = q.x() / p.size - stripe;
  const std::uint64_t bits = bits_at(p.seed, int(stripe), 0);
  return at < 0.2f + 0.6f * share_of(bits, 0) ? p.light
                                              : mixed(p.dark, p.light, 0.5f * share_of(bits, 1));
}

}  // namespace

Color color_of(float hue, float saturation, float value) {
  Color color;
  for (int c = 0; c < 3; ++c) {
    const float at = std::fmod(hue + float(c) / 3, 1.0f);
    const float full = std::clamp(std::abs(6 * at - 3) - 1, 0.0f, 1.0f);
    color[c] = value * (1 - saturation * (1 - full));
  }
  return color;
}

Color Pattern::at(const Vector2f& q, float footprint) const {
  float strength;
  switch (kind) {
    case PatternKind::kPlain:
      return light;
    case PatternKind::kWood:
      return wood(*this, q, footprint);
    case PatternKind::kPlaster:
      return light * (1 + 0.25f * clouds(q / size, seed, 5, footprint / size));
    case PatternKind::kPlanks:
      return planks(*this, q, footprint);
    case PatternKind::kText:
      return is_text(q, size, seed) ? dark : light;
    case PatternKind::kChecker:
      return (int(std::floor(q.x() / size)) + int(std::floor(q.y() / size))) & 1 ? dark : light;
    case PatternKind::kCells:
      return cells(*this, q);
    case PatternKind::kMarble:
      return marble(*this, q, footprint);
    case PatternKind::kStripes:
      return stripes(*this, q);
    case PatternKind::kDots:
      return in_spot(q / size, seed, 0.8f, &strength) ? mixed(dark, light, 0.5f * strength) : light;
    case PatternKind::kBricks:
      return bricks(*this, q);
    case PatternKind::kBitmap: {
      const int w = bitmap->width, h = bitmap->height;
      const int x = std::clamp(int(q.x() * float(w)), 0, w - 1);
      const int y = std::clamp(int((1 - q.y()) * float(h)), 0, h - 1);
      return mixed(dark, light, bitmap->at(x, y));
    }
  }
  return light;
}

}  // namespace sketchsplat
