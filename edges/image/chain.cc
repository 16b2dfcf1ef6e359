// SPDX-License-Identifier: MIT
#include "edges/image/chain.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sketchsplat {
namespace {

// The neighbours that continue edgel i against its tangent and along it; -1 where there is none.
std::array<int, 2> continuations(const Candidates& c, int i, bool signed_normals) {
  const Edgel& e = c.edgels[i];
  const int px = int(std::lround(e.x)), py = int(std::lround(e.y));
  const int left = std::max(0, px - 2), right = std::min(c.at.width - 1, px + 2);
  std::array<int, 2> best = {-1, -1};
  std::array<float, 2> best_cost = {1e9f, 1e9f};
  for (int y = std::max(0, py - 2); y <= std::min(c.at.height - 1, py + 2); ++y) {
    const int* row = c.at.row(y);
    for (int x = left; x <= right; ++x) {
      const int j = row[x];
      if (j < 0 || j == i) continue;
      const Edgel& f = c.edgels[j];
      const float dx = f.x - e.x, dy = f.y - e.y;
      const float along = dy * e.nx - dx * e.ny, ahead = std::abs(along);
      const float aside = std::abs(dx * e.nx + dy * e.ny);
      const float dot = e.nx * f.nx + e.ny * f.ny;
      const float agree = signed_normals ? dot : std::abs(dot);
      if (ahead < 0.3f || ahead > 2.3f || aside > 0.9f * ahead || agree < 0.6f) continue;
      const float cost = std::sqrt(dx * dx + dy * dy) + aside + 2 * (1 - agree);
      const int side = along > 0;
      if (cost < best_cost[side]) best_cost[side] = cost, best[side] = j;
    }
  }
  return best;
}

// Continuations of those that anybody asks for.
class Continuations {
 public:
  Continuations(const Candidates& c, bool signed_normals)
      : c_(c), signed_normals_(signed_normals), known_(c.edgels.size(), {kUnknown, kUnknown}) {}
  int of(int i, int side) {
    if (known_[i][0] == kUnknown) known_[i] = continuations(c_, i, signed_normals_);
    return known_[i][side];
  }

 private:
  static constexpr int kUnknown = -2;
  const Candidates& c_;
  const bool signed_normals_;
  std::vector<std::array<int, 2>> known_;
};

// Follows continuations from `seed`, which leaves by `side` of its tangent. Where normals have no
// sign, the side changes with it.
template <typename Visit>
void follow(const Candidates& c, Continuations* next, int seed, int side, const Visit& visit) {
  for (int i = seed;;) {
    const int j = next->of(i, side);
    if (j < 0 || !visit(j)) return;
    if (c.edgels[i].nx * c.edgels[j].nx + c.edgels[i].ny * c.edgels[j].ny < 0) side = 1 - side;
    i = j;
  }
}

}  // namespace

void chain_edgels(const Candidates& c, float high, int min_chain, bool signed_normals,
                  EdgelMap* map) {
  const int n = int(c.edgels.size());
  Continuations next(c, signed_normals);
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
    follow(c, &next, seed, 0, append_to(&back));
    run.assign(back.rbegin(), back.rend());
    run.push_back(seed);
    follow(c, &next, seed, 1, append_to(&run));
    if (int(run.size()) < min_chain) continue;
    for (int i : run) map->edgels.push_back(c.edgels[i]);
    map->chain.push_back(int(map->edgels.size()));
  }
}

}  // namespace sketchsplat
