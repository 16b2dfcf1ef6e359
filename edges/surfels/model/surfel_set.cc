// SPDX-License-Identifier: MIT
#include "edges/surfels/model/surfel_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/neighbours/kd_tree.h"
#include "datasets/types/dense.h"
#include "datasets/types/parallel.h"
#include "edges/surfels/model/surfel_shading.h"

namespace sketchsplat {
namespace {

using Column = Eigen::Matrix<double, SurfelSet::kRows, 1>;

double alpha_of(double logit) { return 1 / (1 + std::exp(-logit)); }
double logit_of(double alpha) {
  alpha = std::clamp(alpha, 1e-6, 1 - 1e-6);
  return std::log(alpha / (1 - alpha));
}

Eigen::Matrix3d frame_of(const Column& s) {
  const Eigen::Vector4d q = s.segment<4>(SurfelSet::kRotation).normalized();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

// Surfels that become two each.
struct Halves {
  std::vector<int> parents;
  std::vector<Column> children;
  // A step to either side of where `child` is.
  void add(int parent, Column child, const Eigen::Vector3d& step) {
    parents.push_back(parent);
    child.segment<3>(SurfelSet::kCenter) += step;
    children.push_back(child);
    child.segment<3>(SurfelSet::kCenter) -= 2 * step;
    children.push_back(child);
  }
};

bool is_faint(const SurfelSet& set, int i, const Eigen::VectorXd& weight, double min_alpha,
              double min_weight) {
  return alpha_of(set.values(SurfelSet::kOpacity, i)) < min_alpha || weight[i] < min_weight;
}

// Keeps what is neither faint nor unseen nor halved, adds the halves.
DensityChange replace(const SurfelSet& set, const Eigen::VectorXd& weight, double min_alpha,
                      double min_weight, const Halves& halves) {
  std::vector<char> gone(set.size(), 0);
  for (const int parent : halves.parents) gone[parent] = 1;
  DensityChange change;
  for (int i = 0; i < set.size(); ++i) {
    if (gone[i]) continue;
    if (is_faint(set, i, weight, min_alpha, min_weight))
      ++change.pruned;
    else
      change.kept.push_back(i);
  }
  change.split = int(halves.parents.size());
  change.added.resize(SurfelSet::kRows, halves.children.size());
  for (size_t c = 0; c < halves.children.size(); ++c) change.added.col(c) = halves.children[c];
  return change;
}

// The `most` indices with the largest positive score, ties by index.
std::vector<int> highest(const Eigen::VectorXd& score, int most) {
  std::vector<int> order;
  for (int i = 0; i < score.size(); ++i)
    if (score[i] > 0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return score[a] > score[b]; });
  if (int(order.size()) > most) order.resize(std::max(0, most));
  return order;
}

}  // namespace

Eigen::Vector3d SurfelSet::normal(int i) const {
  return surfel_normal(values.col(i).segment<4>(kRotation));
}

void SurfelSet::lay(int i, const Eigen::Vector3d& center, const Eigen::Vector3d& normal) {
  const Eigen::Vector4d q = values.col(i).segment<4>(kRotation);
  const Eigen::Quaterniond now = Eigen::Quaterniond::FromTwoVectors(this->normal(i), normal) *
                                 Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  values.col(i).segment<3>(kCenter) = center;
  values.col(i).segment<4>(kRotation) << now.w(), now.x(), now.y(), now.z();
}

SurfelCloud SurfelSet::cloud(const Eigen::Matrix3Xd& color) const {
  SurfelCloud c;
  if (values.cols() == 0) return c;  // nothing has no rows in memory
  c.center = values.middleRows<3>(kCenter);
  c.rotation = values.middleRows<4>(kRotation);
  c.log_scale = values.middleRows<2>(kLogScale);
  c.opacity = values.row(kOpacity);
  c.skew = values.middleRows<2>(kSkew);
  c.color = color;
  return c;
}

Eigen::MatrixXd SurfelSet::gradient(const SurfelCloud& by_cloud,
                                    const Eigen::Matrix3Xd& by_albedo) {
  Eigen::MatrixXd g(kRows, by_cloud.size());
  g << by_cloud.center, by_cloud.rotation, by_cloud.log_scale, by_cloud.opacity.transpose(),
      by_cloud.skew, by_albedo;
  return g;
}

SurfelCloud facing_surfels(const SurfelCloud& cloud, const View& view, std::vector<int>* indices) {
  constexpr double kGrazing = -0.1;  // cosine; contours are made of what is seen edge-on
  const Eigen::Vector3d eye = view.center_in_world();
  indices->clear();
  for (int i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d to_eye = eye - cloud.center.col(i);
    if (surfel_normal(cloud.rotation.col(i)).dot(to_eye) > kGrazing * to_eye.norm())
      indices->push_back(i);
  }
  return {cloud.center(Eigen::all, *indices),    cloud.rotation(Eigen::all, *indices),
          cloud.log_scale(Eigen::all, *indices), cloud.opacity(*indices),
          cloud.color(Eigen::all, *indices),     cloud.skew(Eigen::all, *indices)};
}

SurfelGradient spread_gradient(const SurfelGradient& part, const std::vector<int>& indices, int n) {
  SurfelGradient out = SurfelGradient::zero(n);
  const auto& all = Eigen::all;
  out.center(all, indices) = part.center, out.rotation(all, indices) = part.rotation;
  out.log_scale(all, indices) = part.log_scale, out.opacity(indices) = part.opacity;
  out.color(all, indices) = part.color, out.skew(all, indices) = part.skew;
  out.in_image(all, indices) = part.in_image;
  out.in_image_abs(all, indices) = part.in_image_abs;
  out.splitting(all, indices) = part.splitting, out.weight(indices) = part.weight;
  return out;
}

DensityChange steep_split(const SurfelSet& set, const Eigen::Matrix3Xd& splitting,
                          const Eigen::VectorXd& weight, double min_alpha, double min_weight,
                          int most) {
  Eigen::VectorXd steepness = Eigen::VectorXd::Zero(set.size());
  Eigen::Matrix2Xd axis(2, set.size());
  for (int i = 0; i < set.size(); ++i) {
    if (is_faint(set, i, weight, min_alpha, min_weight)) continue;
    Eigen::Matrix2d S;
    S << splitting(0, i), splitting(1, i), splitting(1, i), splitting(2, i);
    const auto eigen = eigen_symmetric(S);
    steepness[i] = -eigen.values[0];
    axis.col(i) = eigen.vectors.col(0);
  }
  Halves halves;
  for (const int i : highest(steepness, most)) {
    Column child = set.values.col(i);
    const Eigen::Vector2d scale = child.segment<2>(SurfelSet::kLogScale).array().exp();
    const Eigen::Vector3d step =
        frame_of(child).leftCols<2>() * (0.5 * scale.cwiseProduct(axis.col(i)));
    child[SurfelSet::kOpacity] = logit_of(alpha_of(child[SurfelSet::kOpacity]) / 2);
    halves.add(i, child, step);
  }
  return replace(set, weight, min_alpha, min_weight, halves);
}

DensityChange clone_split(const SurfelSet& set, const Eigen::Matrix2Xd& pull,
                          const Eigen::VectorXd& weight, double min_alpha, double min_weight,
                          int most) {
  Eigen::VectorXd strength = pull.colwise().norm();
  for (int i = 0; i < set.size(); ++i)
    if (is_faint(set, i, weight, min_alpha, min_weight)) strength[i] = 0;
  Halves halves;
  for (const int i : highest(strength, most)) {
    Column child = set.values.col(i);
    const int longer = child[SurfelSet::kLogScale] >= child[SurfelSet::kLogScale + 1] ? 0 : 1;
    const Eigen::Vector3d step =
        0.8 * std::exp(child[SurfelSet::kLogScale + longer]) * frame_of(child).col(longer);
    child.segment<2>(SurfelSet::kLogScale).array() -= std::log(1.6);
    halves.add(i, child, step);
  }
  return replace(set, weight, min_alpha, min_weight, halves);
}

std::vector<std::pair<int, int>> neighbour_pairs(const SurfelSet& set, int count, double reach,
                                                 double max_angle_deg) {
  const int n = set.size();
  if (n == 0) return {};
  Eigen::Matrix3Xd normal(3, n);
  for (int i = 0; i < n; ++i) normal.col(i) = set.normal(i);
  const Eigen::Matrix3Xd p = set.values.middleRows<3>(SurfelSet::kCenter);
  const double least = std::cos(max_angle_deg * M_PI / 180);
  const KdTree tree(p);
  std::vector<std::vector<std::pair<double, int>>> near(n);
  parallel_for(n, 64, [&](int i) {
    for (const int j : tree.within(p.col(i), reach))
      if (j != i && normal.col(i).dot(normal.col(j)) > least)
        near[i].push_back({(p.col(j) - p.col(i)).squaredNorm(), j});
    const auto last = near[i].begin() + std::min<size_t>(count, near[i].size());
    std::partial_sort(near[i].begin(), last, near[i].end());
    near[i].erase(last, near[i].end());
  });
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < n; ++i)
    for (const auto& [d2, j] : near[i]) pairs.push_back(std::minmax(i, j));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

DensityChange merge_pairs(const SurfelSet& set, const std::vector<std::pair<int, int>>& pairs,
                          const Eigen::VectorXd& cosine, double min_cosine) {
  std::vector<int> order;
  for (size_t k = 0; k < pairs.size(); ++k)
    if (cosine[k] > min_cosine) order.push_back(int(k));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cosine[a] > cosine[b]; });
  std::vector<char> used(set.size(), 0);
  std::vector<Column> made;
  for (const int k : order) {
    const auto [i, j] = pairs[k];
    if (used[i] || used[j]) continue;
    used[i] = used[j] = 1;
    const Column a = set.values.col(i), b = set.values.col(j);
    const auto mass = [](const Column& s) {
      return alpha_of(s[SurfelSet::kOpacity]) *
             std::exp(s[SurfelSet::kLogScale] + s[SurfelSet::kLogScale + 1]);
    };
    const double t = mass(b) / (mass(a) + mass(b));
    Column c = (1 - t) * a + t * b;
    const Column& heavy = t > 0.5 ? b : a;
    c.segment<4>(SurfelSet::kRotation) = heavy.segment<4>(SurfelSet::kRotation);
    const Eigen::Matrix3d frame = frame_of(heavy);
    // Second moments about the common centre, along the axes of the heavier one.
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (const auto& [s, share] : {std::pair<Column, double>{a, 1 - t}, {b, t}}) {
      const Eigen::Matrix3d own = frame_of(s);
      const Eigen::Vector3d away =
          s.segment<3>(SurfelSet::kCenter) - c.segment<3>(SurfelSet::kCenter);
      for (int m = 0; m < 2; ++m) {
        double along = std::pow(frame.col(m).dot(away), 2);
        for (int o = 0; o < 2; ++o)
          along +=
              std::exp(2 * s[SurfelSet::kLogScale + o]) * std::pow(frame.col(m).dot(own.col(o)), 2);
        moment[m] += share * along;
      }
    }
    c.segment<2>(SurfelSet::kLogScale) = 0.5 * moment.array().log();
    const double aa = alpha_of(a[SurfelSet::kOpacity]), ab = alpha_of(b[SurfelSet::kOpacity]);
    c[SurfelSet::kOpacity] = logit_of(1 - (1 - aa) * (1 - ab));
    made.push_back(c);
  }
  DensityChange change;
  for (int i = 0; i < set.size(); ++i)
    if (!used[i]) change.kept.push_back(i);
  change.merged = int(made.size());
  change.added.resize(SurfelSet::kRows, made.size());
  for (size_t c = 0; c < made.size(); ++c) change.added.col(c) = made[c];
  return change;
}

Eigen::MatrixXd apply_change(const Eigen::MatrixXd& columns, const DensityChange& change,
                             const Eigen::MatrixXd& fresh) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(columns.rows(), change.kept.size() + change.added.cols());
  for (size_t k = 0; k < change.kept.size(); ++k) out.col(k) = columns.col(change.kept[k]);
  if (fresh.cols() > 0) out.rightCols(change.added.cols()) = fresh;
  return out;
}

}  // namespace sketchsplat
