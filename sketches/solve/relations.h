// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sketches/graph/sketch.h"

namespace sketchsplat {

/// What strokes of a part have in common, estimated along with them. `value` holds
///   direction  a unit vector
///   plane      its offset from the origin along its direction, in the first place
///   axis       a point on it
///   radius     the radius, in the first place
enum class SharedKind { kDirection, kPlane, kAxis, kRadius };
struct SharedQuantity {
  SharedKind kind = SharedKind::kDirection;
  int direction = -1;  ///< plane and axis: the shared direction that is normal to it, or along it
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

/// How one stroke or point keeps to a shared quantity:
///   parallel       a line, or the normal of a conic, along a shared direction    2 residuals
///   perpendicular  two shared directions                                         1
///   coplanar       a node or a handle in a shared plane                          1
///   coaxial        the centre of an arc, circle or ellipse on a shared axis      2
///   equal radius   of an arc or a circle                                         1
///   symmetric      two points that mirror one another in a shared plane          3
///   tangent        an arc, and a line or an arc that goes on from it: nothing    2
///                  is shared
enum class RelationKind {
  kParallel,
  kPerpendicular,
  kCoplanar,
  kCoaxial,
  kEqualRadius,
  kSymmetric,
  kTangent
};
constexpr int kRelationKinds = 7;
const char* relation_name(RelationKind kind);

struct Relation {
  RelationKind kind = RelationKind::kParallel;
  int shared = -1;  ///< index of the quantity; tangent: none
  int other = -1;   ///< perpendicular: the second direction
  int stroke = -1;  ///< parallel, coaxial, equal radius, tangent
  /// Coplanar, symmetric: a node, or the number of nodes plus a handle; tangent: the node.
  int point = -1;
  int twin = -1;  ///< symmetric: the other point
  /// Parallel, coaxial, symmetric, tangent: unit vectors across the direction, in which residuals
  /// are stated.
  Eigen::Matrix<double, 2, 3> across = Eigen::Matrix<double, 2, 3>::Zero();
  double sign = 1;   ///< parallel: -1 if the stroke runs against the direction
  double scale = 1;  ///< [px per unit of the residual], the unit being a radian or a world length
  double sigma = 1;  ///< [px] standard deviation at which it is imposed
  int partner = -1;  ///< tangent: the other stroke
};

struct Relations {
  std::vector<SharedQuantity> shared;
  std::vector<Relation> list;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the planes' offsets
};

/// Strokes that keep to one shared quantity, to two directions with a right angle between them, or
/// that are tangent where they meet.
struct Regularity {
  RelationKind kind = RelationKind::kParallel;
  std::vector<int> strokes;  ///< ascending
};

/// Blocks of three numbers that a relation reads: b < N is node b, b < N + M handle b - N, others
/// are shared quantities.
std::vector<int> relation_blocks(const Sketch& sketch, const Relations& relations,
                                 const Relation& relation);

/// Residuals [px] and their derivatives by the relation's blocks.
struct RelationRows {
  std::vector<int> blocks;   ///< B, as relation_blocks
  Eigen::VectorXd residual;  ///< R
  Eigen::MatrixXd jacobian;  ///< R x 3 B
};
RelationRows linearize(const Sketch& sketch, const Relations& relations, const Relation& relation);

/// Of all joints that may be tangent (find_tangent_joints), with scale and sigma 1 [rad].
std::vector<Relation> tangent_relations(const Sketch& sketch, double angle);

/// Direction of a line, or unit normal of a plane conic; zero if the stroke has none.
Eigen::Vector3d stroke_direction(const Sketch& sketch, int stroke);

}  // namespace sketchsplat
