// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "raster/surfels/surfel.h"

namespace sketchsplat {

/// Number of second-order polynomials of a normal: all that a matt surface shows of far light, but
/// for one per cent (Ramamoorthi and Hanrahan, An efficient representation for irradiance
/// environment maps, SIGGRAPH 2001).
constexpr int kShadingTerms = 9;

/// Light that stands still in the world, shared by all surfels. The illumination varies linearly
/// with the place, for lamps that are not far: E(n, p) = sum_k b_k(n) (L_k0 + L_k1..3 . q), q =
/// (p - center) / extent, b the polynomials 1, x, y, z, xy, xz, yz, x^2 - y^2, 3 z^2 - 1 of the
/// unit normal n. A surfel's colour is albedo * E: in the spirit of Normal-GS (Wei et al., NeurIPS
/// 2024), whose colours come from normals and illumination too, so that pictures turn normals.
struct Illumination {
  Eigen::Matrix<double, kShadingTerms, 4> light =
      Eigen::Matrix<double, kShadingTerms, 4>::Zero();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double extent = 1;  ///< world units
};

/// The polynomials b(n), and their 9 x 3 derivatives if asked for.
Eigen::Matrix<double, kShadingTerms, 1> shading_basis(
    const Eigen::Vector3d& n, Eigen::Matrix<double, kShadingTerms, 3>* by_normal = nullptr);

/// Unit normal of a surfel from its quaternion (w, x, y, z) of any length, and the 3 x 4
/// derivative.
Eigen::Vector3d surfel_normal(const Eigen::Vector4d& rotation,
                              Eigen::Matrix<double, 3, 4>* by_rotation = nullptr);

/// Quaternion whose third axis is the unit vector n.
Eigen::Vector4d rotation_to(const Eigen::Vector3d& n);

/// 3 x N colours of surfels with the 3 x N albedo.
Eigen::Matrix3Xd shade(const SurfelCloud& cloud, const Eigen::Matrix3Xd& albedo,
                       const Illumination& illumination);

/// From dL/dcolor (`gradient->color`) to the albedo, the light, and, added to what is there, to the
/// rotations and centres of `gradient`.
void shade_backward(const SurfelCloud& cloud, const Eigen::Matrix3Xd& albedo,
                    const Illumination& illumination, SurfelCloud* gradient,
                    Eigen::Matrix3Xd* by_albedo,
                    Eigen::Matrix<double, kShadingTerms, 4>* by_light);

/// Light under which surfels of one common albedo, 1, have these greys: least squares, `weight` per
/// surfel, damped where the normals do not tell.
Illumination fit_illumination(const SurfelCloud& cloud, const Eigen::VectorXd& grey,
                              const Eigen::VectorXd& weight, const Eigen::AlignedBox3d& bounds);

}  // namespace sketchsplat
