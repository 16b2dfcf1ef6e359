// SPDX-License-Identifier: MIT
#include "edges/image/chain.h"

#include <algorithm>
#include <cmath>

namespace sketchsplat {
namespace {

// The neighbour that continues edgel i in direction `side` (+1/-1) of its tangent; -1 if there is
// none.
int continuation(const Candidates& c, int i, int side, bool signed_normals) {
  const Edgel& e = c.edgels[i];
  const float tx = -e.ny * side, ty = e.nx * side;
  const int px = int(std::lround(e.x)), py = int(std::lround(e.y));
  int best = -1;
  float best_cost = 1e9f;
  for (int y = std::max(0, py - 2); y <= std::min(c.at.height - 1, py + 2); ++y)
    for (int x = std::max(0, px - 2); x <= std::min(c.at.width - 1, px + 2); ++x) {
      const int j = c.at.at(x, y);
      if (j < 0 || j == i) continue;
      const Edgel& f = c.edgels[j];
      const float dx = f.x - e.x, dy = f.y - e.y;
      const float ahead = dx * tx + dy * ty, aside = std::abs(dx * e.nx + dy * e.ny);
      const float dot = e.nx * f.nx + e.ny * f.ny;
      const float agree = signed_normals ? dot : std::abs(dot);
      if (ahead < 0.3f || ahead > 2.3f || aside > 0.9f * ahead || agree < 0.6f) continue;
      const float cost = std::sqrt(dx * dx + dy * dy) + aside + 2 * (1 - agree);
      if (cost < best_cost) best_cost = cost, best = j;
    }
  return best;
}

// Follows continuations from `seed`, which leaves by `side` of its tangent. Where normals have no
// sign, the side changes with it.
template <typename Visit>
void follow(const Candidates& c, const std::vector<int> (&next)[2], int seed, int side,
            const Visit& visit) {
  for (int i = seed;;) {
    const int j = next[side][i];
    if (j < 0 || !visit(j)) return;
    if (c.edgels[i].nx * c.edgels[j].nx + c.edgels[i].ny * c.edgels[j].ny < 0) side = 1 - side;
    i = j;
  }
}

}  // namespace

void chain_edgels(const Candidates& c, float high, int min_chain, bool signed_normals,
                  EdgelMap* map) {
  const int n = int(c.edgels.size());
  std::vector<int> next[2] = {std::vector<int>(n), std::vector<int>(n)};
  for (int i = 0; i < n; ++i) {
    next[0][i] = continuation(c, i, -1, signed_normals);
    next[1][i] = continuation(c, i, +1, signed_normals);
  }
  std::vector<bool> done(n);
  map->chain.assign(1, 0);
  for (int seed = 0; seed < n; ++seed) {
    if (done[seed] || c.edgels[seed].strength < high) continue;
    std::vector<int> back, run;
    const auto append_to = [&done](std::vector<int>* list) {
      return [&done, list](int i) {
        if (done[i]) return false;
        done[i] = true;
        list->push_back(i);
        return true;
      };
    };
    done[seed] = true;
    follow(c, next, seed, 0, append_to(&back));
    run.assign(back.rbegin(), back.rend());
    run.push_back(seed);
    follow(c, next, seed, 1, append_to(&run));
    if (int(run.size()) < min_chain) continue;
    for (int i : run) map->edgels.push_back(c.edgels[i]);
    map->chain.push_back(int(map->edgels.size()));
  }
}

}  // namespace sketchsplat
