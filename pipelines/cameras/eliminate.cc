// SPDX-License-Identifier: MIT
#include "pipelines/cameras/eliminate.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

constexpr double kRank = 1e-7;  // of the largest eigenvalue: strokes slide along themselves
constexpr int kParts = 8;       // sums of their own
constexpr int kTogether = 32;   // strokes: long products are faster than many short ones

}  // namespace

StrokeMatrix root_of_inverse(const StrokeMatrix& A, double damping) {
  StrokeMatrix root = StrokeMatrix::Zero();
  if (!(A.trace() > 0) || !A.allFinite()) return root;
  const auto es = eigen_symmetric(A);
  const double largest = es.values[kStrokeUnknowns - 1];
  for (int k = 0; k < kStrokeUnknowns; ++k)
    if (es.values[k] > kRank * largest)
      root.row(k) = es.vectors.col(k).transpose() / std::sqrt(es.values[k] + damping * largest);
  return root;
}

void eliminate(const std::vector<StrokeNormal>& strokes, Eigen::MatrixXd* hessian,
               Eigen::VectorXd* gradient) {
  const int n = int(strokes.size()), size = int(gradient->size());
  const int blocks = (n + kTogether - 1) / kTogether, parts = std::min(kParts, blocks);
  std::vector<Eigen::MatrixXd> taken(parts, Eigen::MatrixXd::Zero(size, size));
  std::vector<Eigen::VectorXd> slope(parts, Eigen::VectorXd::Zero(size));
  parallel_for(parts, 1, [&](int part) {
    Eigen::MatrixXd rows(kTogether * kStrokeUnknowns, size);
    for (int b = part; b < blocks; b += parts) {
      const int begin = b * kTogether, count = std::min(kTogether, n - begin);
      for (int k = 0; k < count; ++k) {
        const StrokeNormal& s = strokes[begin + k];
        auto mine = rows.middleRows<kStrokeUnknowns>(k * kStrokeUnknowns);
        mine.noalias() = s.root * s.cross;
        slope[part].noalias() += mine.transpose() * (s.root * s.gradient);
      }
      taken[part].selfadjointView<Eigen::Lower>().rankUpdate(
          rows.topRows(count * kStrokeUnknowns).transpose());
    }
  });
  for (int part = 0; part < parts; ++part) {
    *hessian -= taken[part].selfadjointView<Eigen::Lower>();
    *gradient -= slope[part];
  }
}

}  // namespace sketchsplat
