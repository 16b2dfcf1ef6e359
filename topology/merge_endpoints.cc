// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <tuple>

#include "topology/draft.h"
#include "topology/passes.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// A gap is closed if the way round is so many times as long.
constexpr double kWayRound = 3;
// Two strokes between the same ends are doubles of one if their middles are nearer than this share
// of their lengths (an arc over its chord: up to about 100 deg).
constexpr double kFlat = 0.15;
// Strokes up to so many tolerances make the loop that keeps a short one alive.
constexpr double kLoopStroke = 2;
// Tangents closer to parallel than this leave the position along them open: sin^2 of 10 deg, which
// is half the angle between two lines.
constexpr double kLeastInformation = 0.03;
constexpr int kMaxRounds = 20;

struct Clusters {
  std::vector<int> label;                 // cluster of each node: its least member
  std::vector<std::vector<int>> members;  // nodes of each cluster, by label

  explicit Clusters(int nodes) : label(nodes), members(nodes) {
    for (int n = 0; n < nodes; ++n) {
      label[n] = n;
      members[n] = {n};
    }
  }
  int join(int a, int b) {
    if (b < a) std::swap(a, b);
    for (int n : members[b]) label[n] = a;
    members[a].insert(members[a].end(), members[b].begin(), members[b].end());
    members[b].clear();
    return a;
  }
};

bool is_open(const Piece& p) { return p.alive && !p.curve.closed(); }

// The strokes as edges between clusters.
class Ways {
 public:
  Ways(const Draft& draft, const Clusters& clusters)
      : draft_(draft), clusters_(clusters), at_(draft.nodes.size()) {
    for (int i = 0; i < draft.size(); ++i) {
      if (!is_open(draft.pieces[i])) continue;
      at_[draft.pieces[i].begin].push_back(i);
      at_[draft.pieces[i].end].push_back(i);
    }
  }

  // Length of the shortest way from cluster a to b along strokes that pass `use`; infinite if it
  // is `limit` or longer.
  template <typename Use>
  double shortest(int a, int b, double limit, Use use) const {
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

 private:
  const Draft& draft_;
  const Clusters& clusters_;
  std::vector<std::vector<int>> at_;  // strokes that end in each node
};

// Largest distance between nodes of two clusters.
double spread(const Draft& draft, const Clusters& clusters, int a, int b) {
  double worst = 0;
  for (int m : clusters.members[a])
    for (int n : clusters.members[b])
      worst = std::max(worst, (draft.nodes[m] - draft.nodes[n]).norm());
  return worst;
}

// Agglomerates nodes, nearest first, by complete linkage; never folds a stroke or a short way.
Clusters linked_nodes(const Draft& draft, double tolerance) {
  const int count = int(draft.nodes.size());
  const std::vector<int> degrees = draft.degrees();
  Clusters clusters(count);
  const Ways ways(draft, clusters);
  std::vector<std::map<int, double>> link(count);  // clusters that may still be joined
  std::set<std::tuple<double, int, int>> queue;
  const auto add = [&](int a, int b, double d) {
    link[a][b] = link[b][a] = d;
    queue.insert({d, std::min(a, b), std::max(a, b)});
  };
  const auto drop = [&](int a, int b) {
    queue.erase({link[a][b], std::min(a, b), std::max(a, b)});
    link[a].erase(b);
    link[b].erase(a);
  };
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const double d = (draft.nodes[a] - draft.nodes[b]).norm();
      if (d <= tolerance && degrees[a] > 0 && degrees[b] > 0) add(a, b, d);
    }
  while (!queue.empty()) {
    const auto [d, a, b] = *queue.begin();
    const std::map<int, double> la = link[a], lb = link[b];
    if (ways.shortest(a, b, kWayRound * d, [](int) { return true; }) < INFINITY) {
      drop(a, b);
      continue;
    }
    for (const auto& [c, dc] : la) drop(a, c);
    for (const auto& [c, dc] : lb)
      if (c != a) drop(b, c);
    const int joint = clusters.join(a, b);
    for (const auto& [c, dc] : la) {
      const auto other = lb.find(c);
      if (c != b && other != lb.end()) add(joint, c, std::max(dc, other->second));
    }
  }
  return clusters;
}

Vector3d middle_of(const PlainCurve& curve) {
  Vector3d p, d;
  evaluate_curve<double>(curve.kind, curve.p.data(), 0.5, &p, &d);
  return p;
}

// Whether a short stroke is one side of a small closed shape, which would vanish with it.
bool is_in_loop(const Draft& draft, const Clusters& clusters, const Ways& ways, int stroke,
                double tolerance) {
  const Piece& own = draft.pieces[stroke];
  const int a = clusters.label[own.begin], b = clusters.label[own.end];
  const auto is_other = [&](int i) {
    if (i == stroke) return false;
    const Piece& p = draft.pieces[i];
    const std::pair<int, int> ends = std::minmax(clusters.label[p.begin], clusters.label[p.end]);
    if (ends != std::pair<int, int>(std::minmax(a, b))) return true;
    return (middle_of(p.curve) - middle_of(own.curve)).norm() >
           kFlat * (p.samples.length + own.samples.length);
  };
  const auto is_small = [&](int i) {
    return is_other(i) && draft.pieces[i].samples.length <= kLoopStroke * tolerance;
  };
  return ways.shortest(a, b, kWayRound * own.samples.length, is_other) < INFINITY ||
         ways.shortest(a, b, INFINITY, is_small) < INFINITY;
}

// Removes strokes shorter than the tolerance and joins their ends.
void collapse_short(Draft* draft, Clusters* clusters, double tolerance) {
  std::vector<std::pair<double, int>> short_strokes;
  {
    const Ways ways(*draft, *clusters);
    for (int i = 0; i < draft->size(); ++i) {
      const Piece& p = draft->pieces[i];
      if (!is_open(p) || p.samples.length > tolerance) continue;
      const bool folded = clusters->label[p.begin] == clusters->label[p.end];
      if (folded || !is_in_loop(*draft, *clusters, ways, i, tolerance))
        short_strokes.push_back({p.samples.length, i});
    }
  }
  std::sort(short_strokes.begin(), short_strokes.end());
  for (const auto& [length, i] : short_strokes) {
    const int a = clusters->label[draft->pieces[i].begin];
    const int b = clusters->label[draft->pieces[i].end];
    if (spread(*draft, *clusters, a, b) > tolerance) continue;
    if (a != b) clusters->join(a, b);
    draft->remove(i);
  }
}

struct EndLine {
  Vector3d point, tangent;
  double weight;
};

// Point nearest to the lines, within `tolerance` of all members (which are so of each other).
Vector3d corner(const std::vector<EndLine>& lines, const std::vector<Vector3d>& members,
                double tolerance) {
  Vector3d mean = Vector3d::Zero(), pull = Vector3d::Zero();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  double total = 0;
  for (const EndLine& l : lines) {
    mean += l.weight * l.point;
    total += l.weight;
  }
  if (!(total > 0)) return members[0];
  mean /= total;
  for (const EndLine& l : lines) {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - l.tangent * l.tangent.transpose();
    normal += l.weight / total * across;
    pull += l.weight / total * (across * (l.point - mean));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal);
  Vector3d step = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vector3d axis = solver.eigenvectors().col(k);
    if (solver.eigenvalues()[k] >= kLeastInformation)
      step += axis * (axis.dot(pull) / solver.eigenvalues()[k]);
  }
  double share = 1;
  for (const Vector3d& m : members) {
    // |mean + s step - m| = tolerance; the mean itself is inside.
    const double a = step.squaredNorm(), b = step.dot(mean - m);
    const double c = (mean - m).squaredNorm() - tolerance * tolerance;
    if (a > 0) share = std::min(share, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a);
  }
  return mean + std::max(0.0, share) * step;
}

// New position of each cluster, by label; those of a single node stay.
std::vector<Vector3d> corners(const Draft& draft, const Clusters& clusters, double tolerance) {
  std::vector<std::vector<EndLine>> lines(draft.nodes.size());
  for (const Piece& p : draft.pieces) {
    if (!is_open(p)) continue;
    const int a = clusters.label[p.begin], b = clusters.label[p.end];
    if (a == b && p.curve.kind == StrokeKind::kArc) continue;  // becomes a circle
    // The tangent of a stroke that is hardly longer than the tolerance is mostly noise.
    const double sure = 3 * tolerance;
    const double weight = p.samples.length < sure ? p.samples.length / sure : 1;
    lines[a].push_back({p.curve.begin(), outward_tangent(p.curve, false), weight});
    lines[b].push_back({p.curve.end(), outward_tangent(p.curve, true), weight});
  }
  std::vector<Vector3d> at = draft.nodes;
  for (size_t c = 0; c < at.size(); ++c) {
    if (clusters.members[c].size() < 2) continue;
    std::vector<Vector3d> members;
    for (int n : clusters.members[c]) members.push_back(draft.nodes[n]);
    at[c] = corner(lines[c], members, tolerance);
  }
  return at;
}

void move_to_corners(Draft* draft, const Clusters& clusters, const std::vector<Vector3d>& at) {
  for (int i = 0; i < draft->size(); ++i) {
    const Piece& p = draft->pieces[i];
    if (!is_open(p)) continue;
    const int a = clusters.label[p.begin], b = clusters.label[p.end];
    const bool moved = clusters.members[a].size() > 1 || clusters.members[b].size() > 1;
    if (!moved) continue;
    if (a == b && p.begin != p.end && p.curve.kind == StrokeKind::kArc)
      draft->replace(i, circle_of_arc(p.curve), -1, -1);
    else
      draft->replace(i, move_ends(p.curve, at[a], at[b]), a, b);
  }
}

// One round; returns the number of nodes that were joined to another one.
int join_once(Draft* draft, double tolerance) {
  Clusters clusters = linked_nodes(*draft, tolerance);
  collapse_short(draft, &clusters, tolerance);
  move_to_corners(draft, clusters, corners(*draft, clusters, tolerance));
  int joined = 0;
  for (const auto& members : clusters.members) joined += std::max(0, int(members.size()) - 1);
  return joined;
}

}  // namespace

PassResult merge_endpoints(const Sketch& sketch, const TopologyOptions& options) {
  Draft draft(sketch);
  for (int round = 0; round < kMaxRounds; ++round) {
    const int before = draft.changes;
    const int joined = join_once(&draft, options.endpoint_px * options.footprint);
    draft.changes += joined;
    if (draft.changes == before) break;
  }
  return draft.finish();
}

}  // namespace sketchsplat
