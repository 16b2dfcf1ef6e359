// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/shading.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3f;

struct Lamp {
  Vector3f position;
  float power;  // radiance of a white surface that faces it at the object's centre
};
// Unit frame. Near enough for a gradient across flat faces. The six sides of a box get about
// 225, 202, 190, 180, 166 and 158 grey levels: some pairs differ by ten only.
const Lamp kLamps[] = {{{2.6f, -2.2f, 3.6f}, 0.67f},
                       {{-3.6f, -0.4f, 1.5f}, 0.41f},
                       {{0.8f, 3.8f, 0.9f}, 0.39f},
                       {{-0.7f, 0.9f, -3.6f}, 0.26f},
                       {{3.3f, 1.4f, -1.9f}, 0.18f}};
constexpr float kSky = 0.14f, kGround = 0.06f, kAlbedo = 0.88f;
constexpr float kEven = 0.6f;  // of even light, on a white surface: about the mean of the lamps'

// Dark style: black plastic in a room with half of the light.
constexpr float kDarkAlbedo = 0.06f, kDarkLight = 0.5f;

// Shadowed style: a lamp of its own, the others dimmed. It is small: a shadow thrown over half the
// object has a border of about two hundredths.
const Lamp kStrongLamp = {{-2.4f, -2.8f, 3.4f}, 0.85f};
constexpr float kStrongRadius = 0.06f, kDimmed = 0.35f;

// Glossy style: a varnish over grey.
constexpr float kGlossyAlbedo = 0.42f, kMirror = 0.12f, kRoughness = 0.18f;

// Of a white surface that faces the lamp, at the squared distance `d2` from it.
float falloff(const Lamp& lamp, float d2) { return lamp.power * lamp.position.squaredNorm() / d2; }

float sky(const Vector3f& normal) { return kGround + (kSky - kGround) * 0.5f * (1 + normal.z()); }

// Of a white matt surface.
float matt_in_lamps(const Vector3f& point, const Vector3f& normal) {
  float light = sky(normal);
  for (const Lamp& lamp : kLamps) {
    const Vector3f to = lamp.position - point;
    const float d2 = to.squaredNorm();
    const float cosine = normal.dot(to) / std::sqrt(d2);
    if (cosine > 0) light += lamp.power * cosine * lamp.position.squaredNorm() / d2;
  }
  return light;
}

float lambert(const Lamp& lamp, const Vector3f& point, const Vector3f& normal) {
  const Vector3f to = lamp.position - point;
  const float d2 = to.squaredNorm();
  return std::max(0.0f, normal.dot(to) / std::sqrt(d2)) * falloff(lamp, d2);
}

float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

float fresnel(float cosine) { return schlick(kMirror, cosine); }

// Light of the surroundings in a direction: a sky above a dark floor.
float surroundings(const Vector3f& direction) {
  return 0.08f + 0.62f * smoothstep(-0.1f, 0.1f, direction.z()) +
         0.2f * std::max(0.0f, direction.z());
}

float highlight(const Lamp& lamp, const SurfacePoint& s) {
  const Vector3f to = lamp.position - s.point;
  const float d2 = to.squaredNorm();
  const Vector3f l = to / std::sqrt(d2), h = (l + s.to_eye).normalized();
  return microfacets(s.normal, s.to_eye, l, kRoughness, fresnel(s.to_eye.dot(h))) *
         falloff(lamp, d2);
}

// ------------------------------------------------------------------------------------- patterns

// Printed lines: one in each cell, of its own place, width and blackness.
float lines(const Vector3f& q, std::uint64_t bits) {
  constexpr float kCell = 0.07f;
  const float cell = std::floor(q.x() / kCell);
  const std::uint64_t line = mix(bits ^ std::uint64_t(std::int64_t(cell) + 1000));
  const float width = 0.012f + 0.02f * float(uniform(line));
  const float begin = (kCell - width) * float(uniform(mix(line)));
  const float at = q.x() - cell * kCell;
  if (at < begin || at > begin + width) return 0;
  return 0.35f + 0.4f * float(uniform(mix(mix(line))));
}

float checks(const Vector3f& q) {
  constexpr float kCell = 0.09f;
  const Eigen::Vector3i cell = (q / kCell).array().floor().cast<int>();
  return (cell.sum() & 1) ? 0.6f : 0.0f;
}

// Rings about an axis beside the object: light early wood darkens slowly, late wood ends abruptly.
float wood(const Vector3f& q) {
  constexpr float kRing = 0.06f;
  const float wobble = 0.012f * std::sin(9 * q.z() + 4 * q.x()) + 0.008f * std::sin(23 * q.y());
  const float ring = (std::hypot(q.x() - 0.8f, q.y() - 0.3f) + wobble) / kRing;
  const float at = ring - std::floor(ring);
  return 0.12f + 0.5f * at * at * at;
}

constexpr float kSpeckleCell = 0.06f;

bool is_printed(Style style) { return style == Style::kTextured || style == Style::kSpeckled; }

}  // namespace

// Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
Eigen::Matrix3f drawn_rotation(std::uint64_t bits) {
  const float u = float(uniform(bits)), a = float(2 * M_PI * uniform(mix(bits))),
              b = float(2 * M_PI * uniform(mix(mix(bits))));
  const float r = std::sqrt(1 - u), t = std::sqrt(u);
  return Eigen::Quaternionf(t * std::cos(b), r * std::sin(a), r * std::cos(a), t * std::sin(b))
      .toRotationMatrix();
}

float speckles(const Vector3f& q, float side, std::uint64_t seed) {
  const Eigen::Vector3i cell = (q / side).array().floor().cast<int>();
  std::uint64_t bits = seed;
  for (int i = 0; i < 3; ++i) bits = mix(bits ^ std::uint64_t(std::int64_t(cell[i]) + 1000));
  const auto next = [&bits] { return float(uniform(bits = mix(bits))); };
  const float radius = side * (0.25f + 0.25f * next());
  Vector3f middle;
  for (int i = 0; i < 3; ++i)
    middle[i] = float(cell[i]) * side + radius + (side - 2 * radius) * next();
  return (q - middle).squaredNorm() < radius * radius ? 0.3f + 0.4f * next() : 0.0f;
}

float schlick(float straight, float cosine) {
  const float m = 1 - std::clamp(cosine, 0.0f, 1.0f);
  return straight + (1 - straight) * m * m * m * m * m;
}

float microfacets(const Vector3f& normal, const Vector3f& to_eye, const Vector3f& to_lamp,
                  float roughness, float fresnel) {
  const Vector3f h = (to_lamp + to_eye).normalized();
  const float nl = normal.dot(to_lamp), nv = std::max(1e-3f, normal.dot(to_eye));
  if (nl <= 0) return 0;
  const float nh = std::max(0.0f, normal.dot(h)), a2 = roughness * roughness;
  const float base = nh * nh * (a2 - 1) + 1, k = roughness / 2;
  const float d = a2 / (float(M_PI) * base * base);
  const float visible = 1 / (4 * (nl * (1 - k) + k) * (nv * (1 - k) + k));
  return d * visible * fresnel * float(M_PI) * nl;
}

Print::Print(int faces, std::uint64_t seed) : patterns_(faces) {
  for (int face = 0; face < faces; ++face) {
    const std::uint64_t bits = hash(seed, std::uint64_t(face), 0, 50);
    patterns_[face] = {bits, drawn_rotation(mix(bits))};
  }
}

float Print::ink(const Vector3f& point, int face) const {
  const Pattern& pattern = patterns_[face];
  const Vector3f q = pattern.frame * point;
  switch (pattern.bits % 3) {
    case 0:
      return lines(q, pattern.bits);
    case 1:
      return checks(q);
    default:
      return wood(q);
  }
}

Shader::Shader(const Tracer& tracer, const Tracer* clutter, const Look& look, std::uint64_t seed,
               double lift)
    : tracer_(tracer),
      style_(is_printed(look.style) && look.texture_strength == 0 ? Style::kPlain : look.style),
      strength_(float(look.texture_strength)),
      even_(float(look.even_light)),
      seed_(seed),
      lift_(float(lift)),
      stone_(drawn_rotation(hash(seed, 0, 0, 52))),
      print_(style_ == Style::kTextured ? tracer.num_faces() : 0, seed),
      clutter_print_(clutter ? clutter->num_faces() : 0, mix(seed)) {}

// Of a white matt surface.
float Shader::matt(const SurfacePoint& s) const {
  return (1 - even_) * matt_in_lamps(s.point, s.normal) + even_ * kEven;
}

float Shader::glossy(const SurfacePoint& s) const {
  const Vector3f mirrored = 2 * s.normal.dot(s.to_eye) * s.normal - s.to_eye;
  float light = kGlossyAlbedo * matt(s) + fresnel(s.normal.dot(s.to_eye)) * surroundings(mirrored);
  for (const Lamp& lamp : kLamps) light += (1 - even_) * highlight(lamp, s);
  return light;
}

bool Shader::lamp_is_hidden(const SurfacePoint& s, float u, float v) const {
  const Vector3f to = (kStrongLamp.position - s.point).normalized();
  if (s.normal.dot(to) <= 0) return true;
  const Vector3f side = to.unitOrthogonal(), other = to.cross(side);
  const float r = kStrongRadius * std::sqrt(u), a = float(2 * M_PI) * v;
  const Vector3f lamp = kStrongLamp.position + r * (std::cos(a) * side + std::sin(a) * other);
  return tracer_.blocked(s.point + lift_ * s.facet_normal, lamp);
}

float Shader::with_shadow(const SurfacePoint& s, float share) const {
  const float strong =
      share > 0 ? (1 - even_) * share * lambert(kStrongLamp, s.point, s.normal) : 0.0f;
  const float dimmed = kDimmed + (1 - kDimmed) * even_;
  return kAlbedo * (dimmed * matt(s) + strong);
}

float Shader::object(const SurfacePoint& s, float u, float v) const {
  switch (style_) {
    case Style::kTextured:
      return kAlbedo * matt(s) * (1 - strength_ * print_.ink(s.point, s.face));
    case Style::kSpeckled:
      return kAlbedo * matt(s) * (1 - strength_ * speckles(stone_ * s.point, kSpeckleCell, seed_));
    case Style::kDark:
      return kDarkAlbedo * kDarkLight * matt(s);
    case Style::kGlossy:
      return glossy(s);
    case Style::kShadowed:
      return with_shadow(s, lamp_is_hidden(s, u, v) ? 0.0f : 1.0f);
    default:
      return kAlbedo * matt(s);
  }
}

float Shader::object(const SurfacePoint& s, bool* mixed) const {
  *mixed = false;
  if (style_ != Style::kShadowed) return object(s, 0.0f, 0.0f);
  int seen = 0;
  for (int i = 0; i < 4; ++i) seen += !lamp_is_hidden(s, 0.999f, 0.25f * float(i));
  *mixed = seen > 0 && seen < 4;
  return with_shadow(s, float(seen) / 4);
}

float Shader::clutter(const SurfacePoint& s, float size) const {
  const std::uint64_t bits = hash(seed_, std::uint64_t(s.face), 0, 51);
  const float albedo = 0.25f + 0.6f * float(uniform(bits));
  const Vector3f sun(0.48f, -0.36f, 0.8f);
  const float light = 0.3f + 0.5f * std::abs(s.normal.dot(sun));
  const float print = uniform(mix(bits)) < 0.6 ? clutter_print_.ink(s.point / size, s.face) : 0.0f;
  return (style_ == Style::kDark ? kDarkLight : 1.0f) * albedo * light * (1 - print);
}

}  // namespace sketchsplat
