// SPDX-License-Identifier: MIT
#include "datasets/synthetic/photo/photo_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kLampRays = 48, kSkyRays = 32, kMirrorRays = 12;
constexpr float kSkyReach = 1.3f;  // what is further away hides no light of the walls
constexpr float kBounce = 0.3f;    // light of what hides the walls, against that of the walls
const Color kWalls(0.27f, 0.262f, 0.25f), kFloor(0.16f, 0.14f, 0.12f);

constexpr float kLayer = 0.0075f;  // height of printed layers
constexpr float kSpeckleCell = 0.025f;

// Point k of a sequence that fills the unit square evenly: Roberts, "The unreasonable effectiveness
// of quasirandom sequences", 2018.
Vector2f spread(int k) {
  const double g = 1.32471795724474602596, x = 0.5 + k / g, y = 0.5 + k / (g * g);
  return {float(x - std::floor(x)), float(y - std::floor(y))};
}

// A light's places for shadows differ from point to point only by where they are, not by which they
// are: shadows are free of noise, and their steps are too small to see.
std::vector<Vector3f> places_on(const AreaLight& light, int n) {
  std::vector<Vector3f> places;
  for (int k = 0; k < n; ++k) {
    const Vector2f q = 2 * spread(k) - Vector2f::Ones();
    places.push_back(light.centre + q.x() * light.u + q.y() * light.v);
  }
  return places;
}

// Light of one place on a surface that looks along `normal`; not yet normalised.
float light_from(const Vector3f& place, const Vector3f& light_normal, const Vector3f& point,
                 const Vector3f& normal) {
  const Vector3f to = place - point;
  const float d2 = to.squaredNorm(), d = std::sqrt(d2);
  return std::max(0.0f, normal.dot(to) / d) * std::max(0.0f, -light_normal.dot(to) / d) / d2;
}

// Cosine-weighted directions about z (Malley's method).
std::vector<Vector3f> hemisphere(int n) {
  std::vector<Vector3f> all;
  for (int k = 0; k < n; ++k) {
    const Vector2f q = spread(k);
    const float r = std::sqrt(q.x()), a = float(2 * M_PI) * q.y();
    all.push_back({r * std::cos(a), r * std::sin(a), std::sqrt(1 - q.x())});
  }
  return all;
}

// Axes of a surface, z its normal.
Matrix3f axes_of(const Vector3f& normal) {
  Matrix3f axes;
  axes.col(2) = normal;
  axes.col(0) = normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

Color color_of_part(const PhotoLook& look) {
  const std::uint64_t bits = hash(look.seed, 0, 0, 70);
  const float hue = float(uniform(bits)), value = float(uniform(mix(bits)));
  switch (look.surface) {
    case Finish::kMetal:
      return Color(0.62f, 0.615f, 0.6f) * (0.85f + 0.2f * value);
    case Finish::kPrinted:
      return color_of(hue, 0.75f, 0.45f + 0.25f * value);
    case Finish::kSpeckled:
      return color_of(0.05f + 0.1f * hue, 0.2f, 0.5f + 0.2f * value);
    default:
      return color_of(hue, 0.3f, 0.35f + 0.35f * value);
  }
}

}  // namespace

PhotoShader::PhotoShader(const PhotoWorld& world, const PhotoLook& look, double lift)
    : world_(world),
      look_(look),
      paint_(color_of_part(look)),
      lift_(float(lift)),
      up_(world.room.up().cast<float>()),
      stone_(drawn_rotation(hash(look.seed, 0, 0, 71))),
      sky_(hemisphere(kSkyRays)) {
  const Vector3f table = world.room.unit_from_room.translation().cast<float>();
  for (int i = 0; i < 2; ++i) {
    const AreaLight& light = world.room.lights[i];
    targets_[i] = places_on(light, kLampRays);
    norm_[i] = 0;
    for (int k = 0; k < 4; ++k) {
      const float x = k & 1 ? 0.5f : -0.5f, y = k & 2 ? 0.5f : -0.5f;
      places_[i][k] = light.centre + x * light.u + y * light.v;
      norm_[i] +=
          light_from(places_[i][k], light.normal, table, (places_[i][k] - table).normalized());
    }
  }
}

bool PhotoShader::shines(int face) const {
  return !is_part(face) && world_.room.faces[face - world_.part_faces].emission > 0;
}

Color PhotoShader::albedo(const Vector3f& point, int face) const {
  return is_part(face) ? paint_ : world_.room.albedo(point, face - world_.part_faces, 1e-3f);
}

bool PhotoShader::has_print(int face, const Vector3f& point) const {
  if (is_part(face)) return look_.surface == Finish::kSpeckled;
  return world_.room.kind_at(point, face - world_.part_faces) != PatternKind::kPlaster;
}

Occlusion PhotoShader::occlusion(const Vector3f& point, const Vector3f& facet_normal) const {
  const Vector3f from = point + lift_ * facet_normal;
  Occlusion out = Occlusion::Zero();
  for (int i = 0; i < 2; ++i) {
    // What lies below the horizon is the cosine's affair.
    std::array<Vector3f, kLampRays> above;
    int n = 0;
    for (const Vector3f& place : targets_[i])
      if (facet_normal.dot(place - from) > 0)
        above[n++] = place + 1e-3f * world_.room.lights[i].normal;
    if (n > 0) out[i] = float(world_.tracer.count_visible(from, above.data(), n)) / float(n);
  }
  const Matrix3f axes = axes_of(facet_normal);
  std::array<Vector3f, kSkyRays> ends;
  for (int k = 0; k < kSkyRays; ++k) ends[k] = from + kSkyReach * (axes * sky_[k]);
  out[2] = float(world_.tracer.count_visible(from, ends.data(), kSkyRays)) / kSkyRays;
  return out;
}

// Of a white matt surface.
Color PhotoShader::irradiance(const Vector3f& point, const Vector3f& normal,
                              const Occlusion& occlusion) const {
  const float high = 0.5f + 0.5f * normal.dot(up_);
  Color light = (kFloor + (kWalls - kFloor) * high) * (kBounce + (1 - kBounce) * occlusion[2]);
  for (int i = 0; i < 2; ++i) {
    const AreaLight& from = world_.room.lights[i];
    float sum = 0;
    for (const Vector3f& place : places_[i]) sum += light_from(place, from.normal, point, normal);
    light += from.color * (occlusion[i] * sum / norm_[i]);
  }
  return light;
}

Color PhotoShader::mirrored_lights(const SurfacePoint& s, const Occlusion& occlusion,
                                   float straight, float roughness) const {
  const float fresnel = schlick(straight, s.normal.dot(s.to_eye));
  Color light = fresnel * kWalls * occlusion[2];
  for (int i = 0; i < 2; ++i) {
    const AreaLight& from = world_.room.lights[i];
    float sum = 0;
    for (const Vector3f& place : places_[i]) {
      const Vector3f to = place - s.point;
      const float d2 = to.squaredNorm(), d = std::sqrt(d2);
      const float strength = std::max(0.0f, -from.normal.dot(to) / d) / d2;
      sum += strength * microfacets(s.normal, s.to_eye, to / d, roughness, fresnel);
    }
    light += from.color * (occlusion[i] * sum / norm_[i]);
  }
  return light;
}

// What rays about the mirrored direction meet, as if nothing hid the light there.
Color PhotoShader::mirrored_room(const SurfacePoint& s, std::uint64_t bits) const {
  constexpr float kRough = 0.38f;
  const Vector3f from = s.point + lift_ * s.facet_normal;
  const Matrix3f axes = axes_of(s.normal);
  const float turn = float(uniform(bits));
  Color sum = Color::Zero();
  for (int k = 0; k < kMirrorRays; ++k) {
    // Normals of microfacets (GGX).
    const Vector2f q = spread(k);
    const float x = std::fmod(q.x() + turn, 1.0f), a = float(2 * M_PI) * (q.y() + turn);
    const float cosine = std::sqrt((1 - x) / (1 + (kRough * kRough * kRough * kRough - 1) * x));
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const Vector3f h = axes * Vector3f(sine * std::cos(a), sine * std::sin(a), cosine);
    Vector3f way = 2 * h.dot(s.to_eye) * h - s.to_eye;
    const float above = s.facet_normal.dot(way);
    if (above < 0) way -= 2 * above * s.facet_normal;
    const Hit hit = world_.tracer.cast(from, way);
    if (hit.face < 0) continue;
    const Vector3f place = from + hit.depth * way;
    if (shines(hit.face))
      sum += world_.room.faces[hit.face - world_.part_faces].emission;
    else
      sum += albedo(place, hit.face) * irradiance(place, hit.normal, Occlusion::Constant(0.8f));
  }
  return sum / kMirrorRays;
}

// Bends the normal as layers do; returns how much darker or lighter this layer is.
float PhotoShader::into_layers(float footprint, SurfacePoint* s) const {
  const float visible = std::clamp(kLayer / footprint - 1.3f, 0.0f, 1.0f);
  if (visible <= 0) return 1;
  const bool flat = std::abs(s->normal.dot(up_)) > 0.9f;
  // Sides show layers; floors and ceilings the strokes of the nozzle, in one direction each.
  Vector3f across = up_;
  if (flat) across = (up_.unitOrthogonal() + 0.7f * up_.cross(up_.unitOrthogonal())).normalized();
  const float at = across.dot(s->point) / (flat ? 1.5f * kLayer : kLayer), layer = std::floor(at);
  const std::uint64_t bits =
      hash(look_.seed, std::uint64_t(std::int64_t(layer) + 100000), flat, 72);
  const Vector3f along = across - across.dot(s->normal) * s->normal;
  const float strength = 0.3f * visible * (0.6f + 0.8f * float(uniform(bits)));
  s->normal = (s->normal - strength * std::cos(float(2 * M_PI) * at) * along).normalized();
  return 1 + visible * 0.05f * (2 * float(uniform(mix(bits))) - 1);
}

Color PhotoShader::of_part(SurfacePoint s, const Occlusion& occlusion, float footprint,
                           std::uint64_t bits) const {
  switch (look_.surface) {
    case Finish::kMetal:
      return 0.08f * paint_ * irradiance(s.point, s.normal, occlusion) +
             (paint_ + (1 - paint_) * (schlick(0, s.normal.dot(s.to_eye)))) *
                 mirrored_room(s, bits) * (0.35f + 0.65f * occlusion[2]);
    case Finish::kPrinted: {
      const float shade = into_layers(footprint, &s);
      return shade * paint_ * irradiance(s.point, s.normal, occlusion) +
             mirrored_lights(s, occlusion, 0.04f, 0.45f);
    }
    case Finish::kSpeckled: {
      const float ink = 1.2f * speckles(stone_ * s.point, kSpeckleCell, look_.seed);
      return (1 - ink) * paint_ * irradiance(s.point, s.normal, occlusion) +
             mirrored_lights(s, occlusion, 0.03f, 0.6f);
    }
    default:
      return paint_ * irradiance(s.point, s.normal, occlusion) +
             mirrored_lights(s, occlusion, 0.04f, 0.35f);
  }
}

Color PhotoShader::color(const SurfacePoint& s, const Occlusion& occlusion, float footprint,
                         std::uint64_t bits) const {
  if (is_part(s.face)) return of_part(s, occlusion, footprint, bits);
  const int face = s.face - world_.part_faces;
  const float emission = world_.room.faces[face].emission;
  if (emission > 0) return Color::Constant(emission);
  return world_.room.albedo(s.point, face, footprint) * irradiance(s.point, s.normal, occlusion);
}

}  // namespace sketchsplat
