// SPDX-License-Identifier: MIT
#include "edges/surfels/model/surfel_shading.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Basis = Eigen::Matrix<double, kShadingTerms, 1>;
using Light = Eigen::Matrix<double, kShadingTerms, 4>;

Eigen::Vector4d place(const Illumination& illumination, const Eigen::Vector3d& p) {
  Eigen::Vector4d q;
  q << 1, (p - illumination.center) / illumination.extent;
  return q;
}

}  // namespace

Basis shading_basis(const Eigen::Vector3d& n, Eigen::Matrix<double, kShadingTerms, 3>* by_normal) {
  const double x = n.x(), y = n.y(), z = n.z();
  Basis b;
  b << 1, x, y, z, x * y, x * z, y * z, x * x - y * y, 3 * z * z - 1;
  if (by_normal)
    *by_normal << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, y, x, 0, z, 0, x, 0, z, y, 2 * x, -2 * y, 0,
        0, 0, 6 * z;
  return b;
}

Eigen::Vector3d surfel_normal(const Eigen::Vector4d& rotation,
                              Eigen::Matrix<double, 3, 4>* by_rotation) {
  const double length = rotation.norm();
  const Eigen::Vector4d q = rotation / length;
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  if (by_rotation) {
    Eigen::Matrix<double, 3, 4> by_unit;
    by_unit << 2 * y, 2 * z, 2 * w, 2 * x,  //
        -2 * x, -2 * w, 2 * z, 2 * y,       //
        2 * w, -2 * x, -2 * y, 2 * z;
    *by_rotation = by_unit * (Eigen::Matrix4d::Identity() - q * q.transpose()) / length;
  }
  return {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z};
}

Eigen::Vector4d rotation_to(const Eigen::Vector3d& n) {
  const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n);
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Matrix3Xd shade(const SurfelCloud& cloud, const Eigen::Matrix3Xd& albedo,
                       const Illumination& illumination) {
  Eigen::Matrix3Xd color(3, cloud.size());
  for (int i = 0; i < cloud.size(); ++i) {
    const Basis b = shading_basis(surfel_normal(cloud.rotation.col(i)));
    color.col(i) =
        albedo.col(i) * b.dot(illumination.light * place(illumination, cloud.center.col(i)));
  }
  return color;
}

void shade_backward(const SurfelCloud& cloud, const Eigen::Matrix3Xd& albedo,
                    const Illumination& illumination, SurfelCloud* gradient,
                    Eigen::Matrix3Xd* by_albedo, Light* by_light) {
  by_albedo->resize(3, cloud.size());
  by_light->setZero();
  for (int i = 0; i < cloud.size(); ++i) {
    Eigen::Matrix<double, 3, 4> by_rotation;
    Eigen::Matrix<double, kShadingTerms, 3> by_normal;
    const Eigen::Vector3d n = surfel_normal(cloud.rotation.col(i), &by_rotation);
    const Basis b = shading_basis(n, &by_normal);
    const Eigen::Vector4d q = place(illumination, cloud.center.col(i));
    const Basis l = illumination.light * q;
    const Eigen::Vector3d g = gradient->color.col(i);
    by_albedo->col(i) = g * b.dot(l);
    const double by_shade = g.dot(albedo.col(i));
    *by_light += by_shade * b * q.transpose();
    const Eigen::Vector3d to_normal = by_shade * by_normal.transpose() * l;
    gradient->rotation.col(i) += by_rotation.transpose() * to_normal;
    gradient->center.col(i) +=
        by_shade / illumination.extent * (illumination.light.rightCols<3>().transpose() * b);
  }
}

Illumination fit_illumination(const SurfelCloud& cloud, const Eigen::VectorXd& grey,
                              const Eigen::VectorXd& weight, const Eigen::AlignedBox3d& bounds) {
  constexpr int kUnknowns = 4 * kShadingTerms;
  Illumination out;
  out.center = bounds.center();
  out.extent = std::max(1e-300, bounds.sizes().maxCoeff());
  Eigen::Matrix<double, kUnknowns, kUnknowns> A =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Eigen::Matrix<double, kUnknowns, 1> rhs = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  for (int i = 0; i < cloud.size(); ++i) {
    if (!(weight[i] > 0)) continue;
    const Light row = shading_basis(surfel_normal(cloud.rotation.col(i))) *
                      place(out, cloud.center.col(i)).transpose();
    const Eigen::Map<const Eigen::Matrix<double, kUnknowns, 1>> r(row.data());
    A.selfadjointView<Eigen::Lower>().rankUpdate(r, weight[i]);
    rhs += weight[i] * grey[i] * r;
  }
  const double total = weight.sum();
  for (int k = 0; k < kUnknowns; ++k) A(k, k) += (k < kShadingTerms ? 1e-4 : 3e-3) * total + 1e-12;
  const Eigen::Matrix<double, kUnknowns, 1> x = solve_symmetric(A, rhs);
  out.light = Eigen::Map<const Light>(x.data());
  return out;
}

}  // namespace sketchsplat
