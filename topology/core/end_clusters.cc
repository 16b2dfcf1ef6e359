// SPDX-License-Identifier: MIT
#include "topology/core/end_clusters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sketchsplat {

EndClusters::EndClusters(const Draft& draft)
    : label(draft.nodes.size()), members(draft.nodes.size()), at(draft.nodes) {
  for (int n = 0; n < int(label.size()); ++n) {
    label[n] = n;
    members[n] = {n};
  }
}

int EndClusters::join(int a, int b, const Eigen::Vector3d& where) {
  if (b < a) std::swap(a, b);
  for (int n : members[b]) label[n] = a;
  members[a].insert(members[a].end(), members[b].begin(), members[b].end());
  members[b].clear();
  at[a] = where;
  return a;
}

bool is_open(const Piece& piece) { return piece.alive && !piece.curve.closed(); }

Ways::Ways(const Draft& draft, const EndClusters& clusters)
    : draft_(draft), clusters_(clusters), at_(draft.nodes.size()) {
  for (int i = 0; i < draft.size(); ++i) {
    if (!is_open(draft.pieces[i])) continue;
    at_[draft.pieces[i].begin].push_back(i);
    at_[draft.pieces[i].end].push_back(i);
  }
}

std::vector<int> Ways::strokes_at(int cluster) const {
  std::set<int> out;
  for (int n : clusters_.members[cluster])
    for (int i : at_[n])
      if (draft_.pieces[i].alive) out.insert(i);
  return {out.begin(), out.end()};
}

double Ways::shortest(int a, int b, double limit, const std::function<bool(int)>& use) const {
  std::map<int, double> best = {{a, 0.0}};
  std::set<std::pair<double, int>> open = {{0.0, a}};
  while (!open.empty()) {
    const auto [d, c] = *open.begin();
    open.erase(open.begin());
    if (c == b) return d;
    if (d > best[c]) continue;
    for (int n : clusters_.members[c])
      for (int i : at_[n]) {
        const Piece& p = draft_.pieces[i];
        const double far = d + p.samples.length;
        if (!p.alive || !(far < limit) || !use(i)) continue;
        const int u = clusters_.label[p.begin], v = clusters_.label[p.end];
        const int next = u == c ? v : u;
        const auto it = best.find(next);
        if (it != best.end() && it->second <= far) continue;
        best[next] = far;
        open.insert({far, next});
      }
  }
  return INFINITY;
}

}  // namespace sketchsplat
