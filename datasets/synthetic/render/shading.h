// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "datasets/synthetic/render/tracer.h"

namespace sketchsplat {

enum class Style {
  kPlain,     ///< matt grey, as in ABC-NEF
  kTextured,  ///< prints, checks or grain on every face: edges that are no geometry
  kSpeckled,  ///< spots through and through, as of stone or rust: they run on over the edges
  kDark,      ///< dark matt object under little light
  kGlossy,    ///< highlights of the lamps, and the sky mirrored
  kShadowed,  ///< one strong small lamp whose shadows are cast
  kPhoto,     ///< no matter of shading alone: a photograph of a part on a table, see PhotoOptions
};

/// How an object looks.
struct Look {
  Style style = Style::kPlain;
  double texture_strength = 1;  ///< contrast of Style::kTextured and kSpeckled, [0, 1]
  /// Share of the light that comes evenly from all sides, as in a light tent or under an overcast
  /// sky (without what corners shade of it), [0, 1]: at 1 a matt object's faces have one shade.
  double even_light = 0;
};

/// What is printed on the faces of an object. The pattern of a face is one of three: lines of
/// several widths, checks, or the rings of wood; its kind and its direction depend on (seed, face)
/// alone. Its smallest features are 0.012 wide.
class Print {
 public:
  Print(int faces, std::uint64_t seed);
  /// Share of the light that is taken away at a point, in [0, 0.75]; borders are crisp.
  float ink(const Eigen::Vector3f& point, int face) const;

 private:
  struct Pattern {
    std::uint64_t bits;
    Eigen::Matrix3f frame;
  };
  std::vector<Pattern> patterns_;  // one per face
};

/// A point of a surface, as somebody sees it; unit frame.
struct SurfacePoint {
  Eigen::Vector3f point, normal, facet_normal;  ///< normals unit, on the side of the eye
  Eigen::Vector3f to_eye;                       ///< unit
  int face = 0;
};

/// Share of the light that balls of ink in space take away, in [0, 0.7]; one in each cell of side
/// `cell` and inside of it.
float speckles(const Eigen::Vector3f& point, float cell, std::uint64_t seed);

/// A rotation drawn evenly.
Eigen::Matrix3f drawn_rotation(std::uint64_t bits);

/// Microfacets of Walter et al., "Microfacet models for refraction through rough surfaces", 2007
/// (GGX), with the visibility term of Schlick's approximation: what a rough mirror sends to the eye
/// of the light from a direction, times pi and the cosine; all unit. `fresnel` is what the mirror
/// sends back.
float microfacets(const Eigen::Vector3f& normal, const Eigen::Vector3f& to_eye,
                  const Eigen::Vector3f& to_lamp, float roughness, float fresnel);

/// Schlick, "An inexpensive BRDF model", 1994: of a mirror that sends back `straight` head-on.
float schlick(float straight, float cosine);

/// What light a surface sends to the eye: linear, grey, 1 is the white of the picture. Five lamps
/// and a sky stand still in the unit frame.
class Shader {
 public:
  /// `tracer` (of the object, for cast shadows) must live longer. `clutter`: what stands behind it;
  /// null: nothing. `lift`: how far rays of shadows
  /// start above the triangles, further than these stray from the surface.
  Shader(const Tracer& tracer, const Tracer* clutter, const Look& look, std::uint64_t seed,
         double lift);

  /// Light of the object. (u, v) in [0, 1): the point of the strong lamp that throws the shadow.
  float object(const SurfacePoint& s, float u, float v) const;
  /// The same from the middle of the strong lamp; `mixed`: other points of it are hidden.
  float object(const SurfacePoint& s, bool* mixed) const;
  /// Light of what stands far behind the object, `size` times as large; no shadows.
  float clutter(const SurfacePoint& s, float size) const;
  /// Light may change within a face.
  bool patterned() const { return style_ != Style::kPlain && style_ != Style::kDark; }

 private:
  float matt(const SurfacePoint& s) const;
  float glossy(const SurfacePoint& s) const;
  float with_shadow(const SurfacePoint& s, float share) const;
  bool lamp_is_hidden(const SurfacePoint& s, float u, float v) const;

  const Tracer& tracer_;
  Style style_;
  float strength_, even_;
  std::uint64_t seed_;
  float lift_;
  Eigen::Matrix3f stone_;  // axes of what runs through the object
  Print print_;          // of the object
  Print clutter_print_;  // empty if there is none
};

}  // namespace sketchsplat
