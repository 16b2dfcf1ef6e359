// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "datasets/synthetic/photo/photo_room.h"
#include "datasets/synthetic/render/shading.h"
#include "datasets/synthetic/render/tracer.h"

namespace sketchsplat {

/// What a point gets of the light: shares of the lamp, of the window and of the walls around that
/// nothing hides, in [0, 1]. They change little from point to point of a face.
using Occlusion = Eigen::Array3f;

/// What is to be photographed: the part and what stands around it; unit frame.
struct PhotoWorld {
  PhotoRoom room;
  int part_faces;  ///< faces below are the part's; the others, less these, the room's
  Tracer tracer;   ///< part and room
};

/// How the part looks.
struct PhotoLook {
  Finish surface = Finish::kPainted;
  std::uint64_t seed = 0;  ///< of its colour
};

/// What light the surfaces of a world send to the eye: linear. Soft shadows of a lamp and a window,
/// dimmer corners, one reflection of the light of the walls.
class PhotoShader {
 public:
  /// `world` must live longer. `lift`: how far rays start above the triangles.
  PhotoShader(const PhotoWorld& world, const PhotoLook& look, double lift);

  /// Costly: a hundred rays.
  Occlusion occlusion(const Eigen::Vector3f& point, const Eigen::Vector3f& facet_normal) const;
  /// `footprint`: of a pixel on the surface, unit lengths; `bits`: of the rays that mirrors send.
  Color color(const SurfacePoint& s, const Occlusion& occlusion, float footprint,
              std::uint64_t bits) const;
  /// The face shines, and no light of others matters.
  bool shines(int face) const;
  bool is_part(int face) const { return face < world_.part_faces; }
  /// Share of the light that is sent back, without what is mirrored.
  Color albedo(const Eigen::Vector3f& point, int face) const;
  /// Something is printed at the place, or it is of a texture.
  bool has_print(int face, const Eigen::Vector3f& point) const;

 private:
  Color irradiance(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                   const Occlusion& occlusion) const;
  Color mirrored_lights(const SurfacePoint& s, const Occlusion& occlusion, float straight,
                        float roughness) const;
  Color mirrored_room(const SurfacePoint& s, std::uint64_t bits) const;
  Color of_part(SurfacePoint s, const Occlusion& occlusion, float footprint,
                std::uint64_t bits) const;
  float into_layers(float footprint, SurfacePoint* s) const;

  const PhotoWorld& world_;
  PhotoLook look_;
  Color paint_;
  float lift_;
  Eigen::Vector3f up_;
  Eigen::Matrix3f stone_;
  std::array<std::vector<Eigen::Vector3f>, 2> targets_;   // places of each light, for shadows
  std::array<std::array<Eigen::Vector3f, 4>, 2> places_;  // a few of them, for angles
  std::array<float, 2> norm_;                             // of the light of these
  std::vector<Eigen::Vector3f> sky_;  // directions about +z, denser near it by the cosine
};

}  // namespace sketchsplat
