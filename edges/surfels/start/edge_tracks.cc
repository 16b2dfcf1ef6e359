// SPDX-License-Identifier: MIT
#include "edges/surfels/start/edge_tracks.h"

#include <algorithm>

#include "datasets/types/median.h"

namespace sketchsplat {
namespace {

constexpr int kFewestViews = 3;  // that tell what a point is
constexpr int kBeside = 2;       // measured points to either side that have a say
constexpr double kSome = 0.75;   // of the views say no more than print may
constexpr double kSure = 0.5;    // that there is an edge: at the thresholds

// How surely a point is on an edge of the shape: a quantile over the views; -1: too few tell.
std::vector<float> gather(int points, double share, const std::vector<TrackSightings>& sightings,
                          const std::vector<std::vector<EdgelSupport>>& support, double reach_px) {
  std::vector<std::vector<float>> edge(points);
  for (size_t v = 0; v < sightings.size(); ++v)
    for (size_t k = 0; k < sightings[v].point.size(); ++k)
      if (support[v][k].edge >= 0 && support[v][k].off_px <= reach_px)
        edge[sightings[v].point[k]].push_back(support[v][k].edge);
  std::vector<float> out(points, -1);
  for (int i = 0; i < points; ++i)
    if (int(edge[i].size()) >= kFewestViews) out[i] = float(quantile(edge[i], share));
  return out;
}

// Median of values[told[k]] and its neighbours.
double around(const std::vector<float>& values, const std::vector<int>& told, int k) {
  std::vector<float> near;
  for (int j = std::max(0, k - kBeside); j <= std::min(int(told.size()) - 1, k + kBeside); ++j)
    near.push_back(values[told[j]]);
  return quantile(near, 0.5);
}

// Not round a corner, where what is printed meets an edge?
bool runs_on(const Edgel& a, const Edgel& b) {
  constexpr double kCosine = 0.94;  // of 20 deg
  return a.nx * b.nx + a.ny * b.ny > kCosine;
}

}  // namespace

CurvePoints track_points(const std::vector<EdgePoint>& points, double footprint, int min_points) {
  const std::vector<EdgePoint> thin = thin_points(points, footprint);
  std::vector<int> order;
  CurvePoints tracks;
  tracks.first = {0};
  for (const PointChain& chain : link_points(thin, footprint)) {
    if (int(chain.points.size()) < min_points) continue;
    order.insert(order.end(), chain.points.begin(), chain.points.end());
    tracks.first.push_back(int(order.size()));
  }
  tracks.position.resize(3, order.size());
  tracks.tangent.resize(3, order.size());
  for (size_t k = 0; k < order.size(); ++k) {
    tracks.position.col(k) = thin[order[k]].position;
    tracks.tangent.col(k) = thin[order[k]].tangent;
  }
  return tracks;
}

std::vector<TrackSightings> track_sightings(const EdgeWorld& world, const CurvePoints& tracks,
                                            int every) {
  MatchOptions options;
  options.reach_px = 1.0;
  options.angle_deg = 12;
  options.exclusive = false;
  const Matches matches = match_samples(world, tracks, options);
  std::vector<TrackSightings> out(world.views.size());
  for (size_t c = 0; c + 1 < tracks.first.size(); ++c) {
    const int begin = tracks.first[c], end = tracks.first[c + 1];
    for (int i = begin + std::min(every, end - begin) / 2; i < end; i += every)
      for (int m = matches.first[i]; m < matches.first[i + 1]; ++m) {
        const SampleMatch& match = matches.matches[m];
        double depth;
        world.views[match.view].project(tracks.position.col(i), &depth);
        out[match.view].point.push_back(i);
        out[match.view].place.push_back({match.edgel, depth});
      }
  }
  return out;
}

std::vector<EdgeKind> judge_tracks(const CurvePoints& tracks,
                                   const std::vector<TrackSightings>& sightings,
                                   const std::vector<std::vector<EdgelSupport>>& support,
                                   double reach_px) {
  const int n = int(tracks.position.cols());
  const std::vector<float> half = gather(n, 0.5, sightings, support, reach_px);
  const std::vector<float> some = gather(n, kSome, sightings, support, reach_px);
  std::vector<EdgeKind> kinds(n, EdgeKind::kUnknown);
  for (size_t c = 0; c + 1 < tracks.first.size(); ++c) {
    std::vector<int> told;
    for (int i = tracks.first[c]; i < tracks.first[c + 1]; ++i)
      if (half[i] >= 0) told.push_back(i);
    for (int k = 0; k < int(told.size()); ++k) {
      const EdgeKind kind = around(half, told, k) >= kSure   ? EdgeKind::kShape
                            : around(some, told, k) >= kSure ? EdgeKind::kUnknown
                                                             : EdgeKind::kPrint;
      // And the points that were not measured, up to half-way to the next that was.
      const int begin = k == 0 ? tracks.first[c] : (told[k - 1] + told[k]) / 2 + 1;
      const int end =
          k + 1 == int(told.size()) ? tracks.first[c + 1] : (told[k] + told[k + 1]) / 2 + 1;
      std::fill(kinds.begin() + begin, kinds.begin() + end, kind);
    }
  }
  return kinds;
}

std::vector<std::vector<EdgeKind>> edgel_kinds(
    const EdgeWorld& world, const std::vector<TrackSightings>& sightings,
    const std::vector<std::vector<EdgelSupport>>& support, const std::vector<EdgeKind>& kinds,
    double reach_px, int along) {
  std::vector<std::vector<EdgeKind>> out;
  for (size_t v = 0; v < world.maps.size(); ++v) {
    const EdgelMap& map = world.maps[v];
    out.emplace_back(map.edgels.size(), EdgeKind::kUnknown);
    std::vector<int> away(map.edgels.size(), along + 1);
    for (size_t k = 0; k < sightings[v].point.size(); ++k) {
      const EdgelSupport& own = support[v][k];
      const EdgeKind kind = kinds[sightings[v].point[k]];
      const bool flat = own.edge < kSure;
      if (!(own.off_px <= reach_px) || (kind == EdgeKind::kShape && flat)) continue;
      const int at = sightings[v].place[k].edgel;
      const auto end = std::upper_bound(map.chain.begin(), map.chain.end(), at);
      for (const int step : {-1, 1})
        for (int i = at, d = 0; d <= along && i >= *(end - 1) && i < *end; i += step, ++d) {
          if (!runs_on(map.edgels[at], map.edgels[i])) break;
          if (d < away[i]) away[i] = d, out[v][i] = kind;
        }
    }
  }
  return out;
}

}  // namespace sketchsplat
