// SPDX-License-Identifier: MIT
#include "pipelines/cameras/eliminate.h"

#include <gtest/gtest.h>

#include <random>

#include "datasets/types/dense.h"

namespace sketchsplat {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr int kCameras = 9, kStrokes = 40;  // more than are taken together

// Random normal equations of cameras and strokes that share rows, of a given rank per stroke.
struct Whole {
  explicit Whole(int rank) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const int size = kCameras + kStrokes * kStrokeUnknowns;
    H = MatrixXd::Identity(kCameras, kCameras);
    g = VectorXd::Zero(kCameras);
    full = MatrixXd::Zero(size, size);
    full_g = VectorXd::Zero(size);
    for (int s = 0; s < kStrokes; ++s) {
      const auto draw = [&](int rows, int columns) {
        return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }));
      };
      MatrixXd J = draw(30, kStrokeUnknowns);
      J.rightCols(kStrokeUnknowns - rank) = J.leftCols(kStrokeUnknowns - rank);  // it slides
      const MatrixXd C = draw(30, kCameras);
      const VectorXd r = draw(30, 1);
      const MatrixXd A = J.transpose() * J;
      StrokeNormal stroke;
      stroke.root = root_of_inverse(A, 0);
      stroke.gradient = J.transpose() * r;
      stroke.cross = J.transpose() * C;
      H += C.transpose() * C;
      g += C.transpose() * r;
      const int at = kCameras + s * kStrokeUnknowns;
      full.block(at, at, kStrokeUnknowns, kStrokeUnknowns) = A;
      full.block(at, 0, kStrokeUnknowns, kCameras) = stroke.cross;
      full.block(0, at, kCameras, kStrokeUnknowns) = stroke.cross.transpose();
      full_g.segment(at, kStrokeUnknowns) = stroke.gradient;
      strokes.push_back(stroke);
    }
    full.topLeftCorner(kCameras, kCameras) = H;
    full_g.head(kCameras) = g;
  }
  std::vector<StrokeNormal> strokes;
  MatrixXd H, full;
  VectorXd g, full_g;
};

// Cameras that are solved for without the strokes, and strokes that follow them, step like `whole`.
void expect_steps(Whole w, const VectorXd& whole) {
  eliminate(w.strokes, &w.H, &w.g);
  const VectorXd cameras = solve_symmetric(w.H, -w.g);
  EXPECT_LT((cameras - whole.head(kCameras)).norm(), 1e-7 * cameras.norm());
  for (int s = 0; s < kStrokes; ++s) {
    const auto expected = whole.segment<kStrokeUnknowns>(kCameras + s * kStrokeUnknowns);
    EXPECT_LT((w.strokes[s].step(cameras) - expected).norm(), 1e-6 * expected.norm()) << s;
  }
}

TEST(Eliminate, CamerasAndStrokesStepAsInTheWholeSystem) {
  const Whole w(kStrokeUnknowns);
  expect_steps(w, solve_symmetric(w.full, -w.full_g));
}

TEST(Eliminate, StrokesThatSlideAlongThemselvesDoNotSlide) {
  const Whole w(kStrokeUnknowns - 3);
  const auto e = eigen_symmetric(w.full);
  const double least = 1e-9 * e.values.maxCoeff();
  const VectorXd inverse = e.values.unaryExpr([&](double v) { return v > least ? 1 / v : 0; });
  // Of all least-squares solutions the shortest.
  expect_steps(w, e.vectors * inverse.asDiagonal() * (e.vectors.transpose() * -w.full_g));
}

TEST(Eliminate, NothingIsTakenWhereNothingIsKnown) {
  EXPECT_TRUE(root_of_inverse(StrokeMatrix::Zero(), 0.1).isZero(0));
  MatrixXd H = MatrixXd::Identity(2, 2);
  VectorXd g = VectorXd::Ones(2);
  eliminate({}, &H, &g);
  EXPECT_EQ(H, MatrixXd(MatrixXd::Identity(2, 2)));
  EXPECT_EQ(g, VectorXd(VectorXd::Ones(2)));
}

}  // namespace
}  // namespace sketchsplat
