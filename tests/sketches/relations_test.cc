// SPDX-License-Identifier: MIT
#include "sketches/solve/relations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sketches/solve/gaussian.h"
#include "tests/support/strokes.h"

namespace sketchsplat {
namespace {

using namespace test;  // NOLINT
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// A turned cylinder's rims, an arc about its axis, a line along it, all exact, with all relations.
struct Cylinder {
  Sketch sketch;
  Relations relations;
};
Cylinder cylinder() {
  Cylinder c;
  const Vector3d axis = Vector3d(1, -2, 4).normalized(), centre(0.3, 0.2, 0.7);
  Vector3d x, y;
  frame_of<double>(axis, &x, &y);
  add_line(&c.sketch, centre + 0.5 * x, centre + 0.5 * x + 0.7 * axis);
  add_arc(&c.sketch, centre + 0.4 * x, centre + 0.4 * (x + y).normalized(), centre + 0.4 * y);
  add_circle(&c.sketch, centre + 0.7 * axis, 0.4 * axis);
  c.sketch.add_stroke(StrokeKind::kEllipse, -1, -1, {centre, 0.3 * x + 0.1 * y, 0.2 * y});
  Relations& r = c.relations;
  r.origin = Vector3d(0.1, 0.1, 0.1);
  r.shared = {{SharedKind::kDirection, -1, axis},
              {SharedKind::kDirection, -1, x},
              {SharedKind::kPlane, 0, Vector3d(axis.dot(centre - r.origin), 0, 0)},
              {SharedKind::kAxis, 0, centre - 3 * axis},
              {SharedKind::kRadius, -1, Vector3d(0.4, 0, 0)}};
  Eigen::Matrix<double, 2, 3> across;
  across << x.transpose(), y.transpose();
  for (int i = 0; i < 4; ++i) {
    const double sign = stroke_direction(c.sketch, i).dot(axis) < 0 ? -1 : 1;
    r.list.push_back({RelationKind::kParallel, 0, -1, i, -1, -1, across, sign, 100, 0.05});
    if (i > 0) r.list.push_back({RelationKind::kCoaxial, 3, -1, i, -1, -1, across, 1, 100, 0.05});
    if (i == 1 || i == 2)
      r.list.push_back({RelationKind::kEqualRadius, 4, -1, i, -1, -1, across, 1, 100, 0.05});
  }
  const int handle = int(c.sketch.nodes.cols()) + c.sketch.strokes[3].handle;
  for (int point : {0, 2, 3, handle})
    r.list.push_back({RelationKind::kCoplanar, 2, -1, -1, point, -1, across, 1, 100, 0.05});
  r.list.push_back({RelationKind::kPerpendicular, 0, 1, -1, -1, -1, across, 1, 100, 0.05});
  // Two points that mirror one another in the plane.
  const int a = c.sketch.add_node(centre + 0.2 * x + 0.3 * axis),
            b = c.sketch.add_node(centre + 0.2 * x - 0.3 * axis);
  c.sketch.add_stroke(StrokeKind::kLine, a, b, {});
  for (Relation& relation : r.list)
    if (relation.point >= 6) relation.point += 2;  // a handle
  r.list.push_back({RelationKind::kSymmetric, 2, -1, -1, a, b, across, 1, 100, 0.05});
  return c;
}

double* block_of(Cylinder* c, int b) {
  const int nodes = int(c->sketch.nodes.cols()), all = nodes + int(c->sketch.handles.cols());
  return b < nodes ? c->sketch.nodes.col(b).data()
         : b < all ? c->sketch.handles.col(b - nodes).data()
                   : c->relations.shared[b - all].value.data();
}

TEST(Relations, HoldOnAnExactCylinder) {
  const Cylinder c = cylinder();
  for (const Relation& r : c.relations.list)
    EXPECT_LT(linearize(c.sketch, c.relations, r).residual.cwiseAbs().maxCoeff(), 1e-10)
        << relation_name(r.kind) << " of stroke " << r.stroke;
}

TEST(Relations, DerivativesAreThoseOfTheResiduals) {
  Cylinder c = cylinder();
  for (const double turn : {0.1, 1.1}) {  // a line and an arc, two arcs, that nearly go on
    const int first = c.sketch.size(), a = c.sketch.add_node({2, 0, 0}),
              b = c.sketch.add_node({3, 0, 0}),
              far = c.sketch.add_node({3 + std::cos(turn), std::sin(turn), 0.1});
    if (turn < 1)
      c.sketch.add_stroke(StrokeKind::kLine, a, b, {});
    else
      c.sketch.add_stroke(StrokeKind::kArc, a, b, {Vector3d(2.5, 0.2, 0)});
    c.sketch.add_stroke(StrokeKind::kArc, far, b, {Vector3d(3.5, turn < 1 ? 0 : 0.2, 0)});
    Relation r{RelationKind::kTangent, -1, -1, first + 1, b, -1};
    r.partner = first;
    r.across << 0.1, 0.9, 0.2, 0, 0.1, 1;
    c.relations.list.push_back(r);
  }
  c.sketch.handles.array() += 0.01 * (c.sketch.handles.array() * 37).sin();  // off, a little
  for (const Relation& r : c.relations.list) {
    const RelationRows rows = linearize(c.sketch, c.relations, r);
    ASSERT_EQ(rows.jacobian.cols(), 3 * int(rows.blocks.size()));
    for (int j = 0; j < rows.jacobian.cols(); ++j) {
      double* x = block_of(&c, rows.blocks[j / 3]) + j % 3;
      const double at = *x, step = 1e-6;
      *x = at + step;
      const VectorXd up = linearize(c.sketch, c.relations, r).residual;
      *x = at - step;
      const VectorXd down = linearize(c.sketch, c.relations, r).residual;
      *x = at;
      EXPECT_LT(((up - down) / (2 * step) - rows.jacobian.col(j)).norm(),
                1e-5 * (1 + rows.jacobian.norm()))
          << relation_name(r.kind) << " of stroke " << r.stroke << ", column " << j;
    }
  }
}

TEST(Gaussian, IsTheDenseOneAfterObservationsOfOldAndNewVariables) {
  const int n = 6;
  MatrixXd a = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a(i, j) = std::sin(3.0 * i + 7 * j + i * j);
  const MatrixXd information = a * a.transpose() + 0.5 * MatrixXd::Identity(n, n);
  Gaussian gaussian(information.sparseView());
  ASSERT_TRUE(gaussian.ok());
  MatrixXd dense = MatrixXd::Zero(n + 1, n + 1);  // information of all, with the variable to come
  dense.topLeftCorner(n, n) = information;
  dense(n, n) = 1 / 9.0;
  const auto observe = [&](const MatrixXd& rows, const VectorXd& residual, double sigma) {
    dense.topLeftCorner(rows.cols(), rows.cols()) += rows.transpose() * rows / (sigma * sigma);
    const VectorXd expected = -dense.inverse().topLeftCorner(rows.cols(), rows.cols()) *
                              rows.transpose() * residual / (sigma * sigma);
    const VectorXd move = gaussian.observe(rows.sparseView(), residual, sigma);
    EXPECT_LT((move - expected).norm(), 1e-9 * (1 + expected.norm()));
  };
  MatrixXd rows = MatrixXd::Zero(2, n);
  rows << 1, 0, 2, 0, 0, -1, 0, 1, 0, 3, 0, 0;
  observe(rows, Eigen::Vector2d(0.3, -0.2), 0.1);
  gaussian.add_variable(9);
  MatrixXd more = MatrixXd::Zero(1, n + 1);
  more(0, 4) = 1, more(0, n) = -1;
  observe(more, VectorXd::Constant(1, 0.7), 0.05);
  MatrixXd last = MatrixXd::Random(2, n + 1);
  EXPECT_LT(
      (gaussian.covariance(last.sparseView()) - last * dense.inverse() * last.transpose()).norm(),
      1e-9);
}

}  // namespace
}  // namespace sketchsplat
