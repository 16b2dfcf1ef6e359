// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include "datasets/types/parallel.h"
#include "raster/surfels/surfel.h"

namespace sketchsplat {
namespace {

double product(const SurfelInfluence& view, int i, int j) {
  double sum = 0;
  int a = view.first[i], b = view.first[j];
  while (a < view.first[i + 1] && b < view.first[j + 1]) {
    if (view.pixel[a] < view.pixel[b]) {
      ++a;
    } else if (view.pixel[b] < view.pixel[a]) {
      ++b;
    } else {
      sum += double(view.weight[a++]) * view.weight[b++];
    }
  }
  return sum;
}

}  // namespace

Eigen::VectorXd influence_cosines(const std::vector<SurfelInfluence>& views,
                                  const std::vector<std::pair<int, int>>& pairs) {
  const int count = views.empty() ? 0 : int(views[0].first.size()) - 1;
  Eigen::VectorXd norm2 = Eigen::VectorXd::Zero(count);
  for (const SurfelInfluence& view : views) {
    assert(int(view.first.size()) == count + 1);
    for (int i = 0; i < count; ++i) norm2[i] += product(view, i, i);
  }
  Eigen::VectorXd cosines = Eigen::VectorXd::Zero(pairs.size());
  if (count == 0) return cosines;
  parallel_for(int(pairs.size()), [&](int k) {
    const auto [i, j] = pairs[k];
    double sum = 0;
    for (const SurfelInfluence& view : views) sum += product(view, i, j);
    const double norms = std::sqrt(norm2[i] * norm2[j]);
    if (norms > 0) cosines[k] = std::min(sum / norms, 1.0);
  });
  return cosines;
}

}  // namespace sketchsplat
