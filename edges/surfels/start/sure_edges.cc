// SPDX-License-Identifier: MIT
#include "edges/surfels/start/sure_edges.h"

#include <algorithm>
#include <limits>

#include "edges/surfels/start/edge_tracks.h"

namespace sketchsplat {
namespace {

struct Sighting {
  int view, point, edgel;
  float depth;
  bool follows;  // the sighting before it, along the track
};

// Whose points follow one another in a view, long enough to be no accident.
std::vector<Sighting> sightings_in_runs(const EdgeWorld& world, const CurvePoints& tracks,
                                        int shortest) {
  std::vector<int> track(tracks.position.cols());
  for (size_t c = 0; c + 1 < tracks.first.size(); ++c)
    std::fill(track.begin() + tracks.first[c], track.begin() + tracks.first[c + 1], int(c));
  const std::vector<TrackSightings> seen = track_sightings(world, tracks, 1);
  std::vector<Sighting> out;
  for (size_t v = 0; v < seen.size(); ++v) {
    const std::vector<int>& point = seen[v].point;
    for (size_t a = 0, b = 0; a < point.size(); a = b) {
      const auto next = [&] { return b < point.size() && point[b] <= point[b - 1] + 1; };
      for (b = a + 1; next() && track[point[b]] == track[point[a]];) ++b;
      if (int(b - a) < shortest) continue;
      for (size_t k = a; k < b; ++k) {
        const EdgelPlace& place = seen[v].place[k];
        out.push_back({int(v), point[k], place.edgel, float(place.depth), k > a});
      }
    }
  }
  return out;
}

class Claims {
 public:
  Claims(const EdgeWorld& world, const CurvePoints& tracks, const SureEdgeOptions& options)
      : world_(world), options_(options), views_(tracks.position.cols()) {
    sightings_ = sightings_in_runs(world, tracks, options.run);
  }

  // Drops what points that more views see have a better claim to, then points that few views see.
  void settle() {
    count_views();
    std::vector<std::vector<int>> most = per_edgel(0);
    for (const Sighting& s : sightings_)
      for_claimed(s, [&](int e) { most[s.view][e] = std::max(most[s.view][e], views_[s.point]); });
    keep([&](const Sighting& s) {
      return views_[s.point] >= options_.claim * most[s.view][s.edgel];
    });
    count_views();
    keep([&](const Sighting& s) { return sure(s.point); });
  }

  // Drops what may be of either of two points. `all`: before any was dropped.
  void drop_ambiguous(const std::vector<Sighting>& all) {
    constexpr float kFar = std::numeric_limits<float>::max();
    std::vector<std::vector<float>> nearest = per_edgel(kFar), farthest = per_edgel(-kFar);
    for (const Sighting& s : all)
      if (sure(s.point))
        for_claimed(s, [&](int e) {
          nearest[s.view][e] = std::min(nearest[s.view][e], s.depth);
          farthest[s.view][e] = std::max(farthest[s.view][e], s.depth);
        });
    keep([&](const Sighting& s) {
      return farthest[s.view][s.edgel] - nearest[s.view][s.edgel] <
             options_.apart_px * world_.footprint;
    });
  }

  bool sure(int point) const { return views_[point] >= options_.views; }
  const std::vector<Sighting>& sightings() const { return sightings_; }

 private:
  template <typename T>
  std::vector<std::vector<T>> per_edgel(T value) const {
    std::vector<std::vector<T>> out;
    for (const EdgelMap& map : world_.maps) out.emplace_back(map.edgels.size(), value);
    return out;
  }

  void count_views() {
    std::fill(views_.begin(), views_.end(), 0);
    for (const Sighting& s : sightings_) ++views_[s.point];
  }

  // The edgels beside that of the sighting, of the same chain.
  template <typename F>
  void for_claimed(const Sighting& s, const F& f) const {
    const std::vector<int>& chain = world_.maps[s.view].chain;
    const auto end = std::upper_bound(chain.begin(), chain.end(), s.edgel);
    const int last = std::min(s.edgel + options_.beside, *end - 1);
    for (int e = std::max(s.edgel - options_.beside, *(end - 1)); e <= last; ++e) f(e);
  }

  // A sighting that is dropped ends its run.
  template <typename F>
  void keep(const F& wanted) {
    std::vector<Sighting> kept;
    bool before = false;
    for (Sighting s : sightings_) {
      const bool stays = wanted(s);
      s.follows = s.follows && before;
      if (stays) kept.push_back(s);
      before = stays;
    }
    sightings_.swap(kept);
  }

  const EdgeWorld& world_;
  const SureEdgeOptions& options_;
  std::vector<Sighting> sightings_;
  std::vector<int> views_;  // that see a point
};

}  // namespace

SureEdges sure_edges(const EdgeWorld& world, const CurvePoints& tracks,
                     const SureEdgeOptions& options) {
  Claims claims(world, tracks, options);
  const std::vector<Sighting> all = claims.sightings();
  claims.settle();
  claims.drop_ambiguous(all);
  SureEdges out;
  out.footprint = world.footprint;
  std::vector<int> points;
  for (int i = 0; i < tracks.position.cols(); ++i)
    if (claims.sure(i)) points.push_back(i);
  out.position.resize(3, points.size()), out.tangent.resize(3, points.size());
  for (size_t k = 0; k < points.size(); ++k) {
    out.position.col(k) = tracks.position.col(points[k]);
    out.tangent.col(k) = tracks.tangent.col(points[k]);
  }
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (const Sighting& s : claims.sightings()) {
    const Eigen::Vector3d eye = world.views[s.view].center_in_world();
    const Eigen::Vector3d point = tracks.position.col(s.point);
    for (int k = 1; s.follows && k < options.fan; ++k)
      out.lines.push_back({eye, before + double(k) / options.fan * (point - before)});
    out.lines.push_back({eye, point});
    before = point;
  }
  return out;
}

}  // namespace sketchsplat
