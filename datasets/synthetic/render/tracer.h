// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>

#include "datasets/synthetic/cad/brep.h"

namespace sketchsplat {

/// What a ray meets first.
struct Hit {
  int face = -1;                 ///< of the B-rep; -1 if nothing
  float depth = 0;               ///< along the ray, in lengths of its direction
  Eigen::Vector3f normal;        ///< of the exact surface, towards the origin of the ray
  Eigen::Vector3f facet_normal;  ///< of the triangle, towards the origin of the ray
};

/// Casts rays at a mesh (Embree). Any number of threads may ask at once.
class Tracer {
 public:
  explicit Tracer(const SurfaceMesh& mesh);
  Hit cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  /// `n` rays from one point, neighbours in nearly one direction: faster than one by one.
  void cast(const Eigen::Vector3f& origin, const Eigen::Vector3f* directions, int n,
            Hit* hits) const;
  int num_faces() const;  ///< Hit::face is less
  /// Something lies on the way from one point to the other.
  bool blocked(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;
  /// Of how many of `n` points nothing lies on the way from `from`; neighbours lie side by side.
  int count_visible(const Eigen::Vector3f& from, const Eigen::Vector3f* to, int n) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace sketchsplat
