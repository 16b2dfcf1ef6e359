// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/photo/photo_options.h"
#include "datasets/synthetic/photo/photo_patterns.h"

namespace sketchsplat {

// The room's own axes: z up, the table at z = 0, the part above the origin.

/// A card: something printed that lies flat on a face.
struct Card {
  Eigen::Vector2f centre, along;  ///< places on the face; `along` is unit
  Eigen::Vector2f half;           ///< sides
  Pattern pattern;
  float margin = 0;  ///< blank border

  /// A place of the face, from the card's first corner along its sides.
  Eigen::Vector2f inside(const Eigen::Vector2f& place) const {
    const Eigen::Vector2f from = place - centre;
    return half + Eigen::Vector2f(along.dot(from), along.x() * from.y() - along.y() * from.x());
  }
};

/// What a face of the room looks like. A place on it: (u . x, v . x) of x = point - origin; around
/// a cylinder about the axis v, the length of the arc from u, and v . x.
struct RoomFace {
  Eigen::Vector3f origin, u, v;  ///< unit frame
  float radius = 0;              ///< of a cylinder; 0: flat
  Pattern pattern;
  std::vector<Card> cards;
  float emission = 0;  ///< light of its own
};

/// A rectangle that shines to one side.
struct AreaLight {
  Eigen::Vector3f centre, u, v, normal;  ///< u, v: half sides
  Color color;  ///< of a white surface on the table below the part that faces it
};

/// What stands around the part of a photograph; unit frame.
struct PhotoRoom {
  SurfaceMesh mesh;
  std::vector<RoomFace> faces;      ///< one per face of the mesh
  std::array<AreaLight, 2> lights;  ///< a lamp at the ceiling, a window
  Eigen::Affine3d unit_from_room = Eigen::Affine3d::Identity();
  bool has_tag = false;
  Eigen::Matrix<double, 3, 4> tag_corners;  ///< of the black square, in the order of libapriltag

  Eigen::Vector3d up() const { return unit_from_room.linear().col(2); }
  /// Share of the light that a place sends back; `footprint`: of a pixel.
  Color albedo(const Eigen::Vector3f& point, int face, float footprint) const;
  /// What is printed there.
  PatternKind kind_at(const Eigen::Vector3f& point, int face) const;

 private:
  Eigen::Vector2f place_of(const Eigen::Vector3f& point, int face) const;
  const Card* card_at(const Eigen::Vector2f& place, int face, Eigen::Vector2f* inside) const;
};

/// From the part's points (unit frame), the distance of the cameras and the tag's size, both in the
/// unit frame, too. Throws InputError if the tag finds no place on the table.
PhotoRoom make_room(const PhotoOptions& options, const std::vector<Eigen::Vector3f>& part,
                    double distance, double tag_size, std::uint64_t seed);

}  // namespace sketchsplat
