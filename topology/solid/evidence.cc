// SPDX-License-Identifier: MIT
#include "topology/solid/evidence.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "topology/solid/cell_index.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

class Scales {
 public:
  Scales(const std::vector<SurfaceStrokes>& surfaces, const std::vector<Cell>& cells)
      : surfaces_(surfaces), of_surface_(surfaces.size()) {
    for (const SurfaceStrokes& s : surfaces) layouts_.push_back(layout_of(s));
    for (int c = 0; c < int(cells.size()); ++c) {
      of_surface_[cells[c].surface].push_back(c);
      index_.emplace_back(cells[c], layouts_[cells[c].surface]);
    }
  }

  // Cells that a segment meets before `end` in [0, 1], ascending.
  std::vector<int> met(const Vector3d& from, const Vector3d& to, double end) const {
    std::vector<int> out;
    for (size_t i = 0; i < surfaces_.size(); ++i) {
      if (of_surface_[i].empty()) continue;
      const Crossings at = crossings(layouts_[i], from, to);
      for (int k = 0; k < at.count && at.t[k] < end; ++k) {
        const Eigen::Vector2d flat = layouts_[i].flat(Vector3d(from + at.t[k] * (to - from)));
        for (const int c : of_surface_[i])
          if (index_[c].holds(flat)) out.push_back(c);
      }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

 private:
  const std::vector<SurfaceStrokes>& surfaces_;
  std::vector<Layout> layouts_;
  std::vector<std::vector<int>> of_surface_;
  std::vector<CellIndex> index_;
};

// Places behind a cell.
struct Seen {
  double all = 0, seen = 0;
  void add(const Sight& s) {
    all += s.weight;
    seen += s.seen ? s.weight : 0;
  }
  // Log-likelihood ratio of no face being there, where others may hide the places, to a face.
  double against(const EvidencePrices& prices) const {
    const double a = prices.seen_through, share = all > 0 ? seen / all : 0;
    if (share <= a) return 0;
    const double b = std::min(share, prices.seen);
    return all * (share * std::log(b / a) + (1 - share) * std::log((1 - b) / (1 - a)));
  }
};

}  // namespace

EvidenceOfCells weigh_cells(const SolidEvidence& evidence,
                            const std::vector<SurfaceStrokes>& surfaces,
                            const std::vector<Cell>& cells, double extent,
                            const EvidencePrices& prices) {
  const Scales scales(surfaces, cells);
  EvidenceOfCells out;
  out.against.assign(cells.size(), 0);
  std::vector<Seen> seen(cells.size());
  for (const Sight& s : evidence.sights) {
    const double end = 1 - prices.near * extent / (s.to - s.from).norm();
    for (const int c : scales.met(s.from, s.to, end)) seen[c].add(s);
  }
  for (size_t c = 0; c < cells.size(); ++c) out.against[c] = seen[c].against(prices);
  std::map<std::vector<int>, int> object, free;
  for (const MaskRay& ray : evidence.rays)
    ++(ray.object ? object : free)[scales.met(ray.from, ray.to, 1)];
  for (const auto& [met, rays] : free)
    for (const int c : met) out.against[c] += prices.ray * rays;
  for (double& against : out.against) against = std::min(against, prices.most);
  for (const auto& [met, rays] : object) out.object.push_back({met, rays});
  for (const auto& [met, rays] : free) out.free.push_back({met, rays});
  return out;
}

int cameras_at_worst(const SolidEvidence& evidence, const std::vector<SurfaceStrokes>& surfaces,
                     const std::vector<Cell>& cells, const std::vector<bool>& chosen, int cell,
                     double near) {
  constexpr int kHeights = 8, kAround = 16;
  const Scales scales(surfaces, cells);
  const Layout layout = layout_of(surfaces[cells[cell].surface]);
  const FlatBox box = box_of(cells[cell]);
  const CellIndex index(cells[cell], layout);
  std::vector<Vector3d> cameras;
  for (const Sight& s : evidence.sights) cameras.push_back(s.from);
  const auto before = [](const Vector3d& a, const Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::sort(cameras.begin(), cameras.end(), before);
  cameras.erase(std::unique(cameras.begin(), cameras.end()), cameras.end());
  const auto sees = [&](const Vector3d& camera, const Vector3d& place) {
    const std::vector<int> met = scales.met(camera, place, 1 - near / (place - camera).norm());
    return std::none_of(met.begin(), met.end(), [&](int c) { return chosen[c]; });
  };
  int fewest = int(cameras.size());
  for (int h = 0; h < kHeights; ++h) {
    std::vector<Vector3d> ring;
    for (int k = 0; k < kAround; ++k) {
      const Eigen::Vector2d flat = box.at((k + 0.5) / kAround, (h + 0.5) / kHeights);
      if (index.holds(flat)) ring.push_back(layout.point(flat));
    }
    if (ring.empty()) continue;
    int count = 0;
    for (const Vector3d& camera : cameras)
      count += std::any_of(ring.begin(), ring.end(),
                           [&](const Vector3d& place) { return sees(camera, place); });
    fewest = std::min(fewest, count);
  }
  return fewest;
}

int contradicted(const EvidenceOfCells& weighed, const std::vector<bool>& chosen) {
  const auto count = [&](const Meeting& m) {
    return std::count_if(m.cells.begin(), m.cells.end(), [&](int c) { return chosen[c]; });
  };
  int rays = 0;
  for (const Meeting& m : weighed.object) rays += count(m) == 0 ? m.rays : 0;
  for (const Meeting& m : weighed.free) rays += count(m) > 0 ? m.rays : 0;
  return rays;
}

}  // namespace sketchsplat
