// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "datasets/types/dense.h"
#include "topology/core/description.h"
#include "topology/core/end_clusters.h"
#include "topology/core/refit.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// A gap is closed if the way round is so many times as long.
constexpr double kWayRound = 3;
// Two strokes between the same ends are doubles of one if their middles are nearer than this share
// of their lengths (an arc over its chord: up to about 100 deg).
constexpr double kFlat = 0.15;
// Strokes up to so many reaches make the loop that keeps a short one alive.
constexpr double kLoopStroke = 2;
// Tangents closer to parallel than this leave the position along them open: sin^2 of 10 deg, which
// is half the angle between two lines.
constexpr double kLeastInformation = 0.03;
constexpr int kMaxRounds = 20;

struct EndLine {
  Vector3d point, tangent;
  double weight;
};

// Point nearest to the lines, within `reach` of all members (which are so of each other).
Vector3d corner(const std::vector<EndLine>& lines, const std::vector<Vector3d>& members,
                double reach) {
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
  const auto solver = eigen_symmetric(normal);
  Vector3d step = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vector3d axis = solver.vectors.col(k);
    if (solver.values[k] >= kLeastInformation) step += axis * (axis.dot(pull) / solver.values[k]);
  }
  double share = 1;
  for (const Vector3d& m : members) {
    // |mean + s step - m| = reach; the mean itself is inside.
    const double a = step.squaredNorm(), b = step.dot(mean - m);
    const double c = (mean - m).squaredNorm() - reach * reach;
    if (a > 0) share = std::min(share, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a);
  }
  return mean + std::max(0.0, share) * step;
}

Vector3d middle_of(const PlainCurve& curve) {
  Vector3d p, d;
  evaluate_curve<double>(curve.kind, curve.p.data(), 0.5, &p, &d);
  return p;
}

// One round of joining ends.
class Joiner {
 public:
  Joiner(Draft* draft, const TopologyOptions& options)
      : draft_(*draft),
        options_(options),
        reach_(options.endpoint_px * options.footprint),
        clusters_(*draft),
        ways_(*draft, clusters_) {}

  // Returns the number of nodes that were joined to another one.
  int run() {
    link();
    collapse_short();
    follow();
    int joined = 0;
    for (const auto& members : clusters_.members) joined += std::max(0, int(members.size()) - 1);
    return joined;
  }

 private:
  // What a join would make of the strokes that end there.
  struct Join {
    Vector3d at;
    std::vector<PlainCurve> curves;  // of the strokes around
    double growth = 0;               // [nat] of their description
  };

  // The stroke between its clusters, where those of them that are a or b are at `at`.
  PlainCurve between(const Piece& p, int a, int b, const Vector3d& at) const {
    const int u = clusters_.label[p.begin], v = clusters_.label[p.end];
    const auto is_joint = [&](int c) { return c == a || c == b; };
    if (u == v || (is_joint(u) && is_joint(v))) {
      if (p.begin != p.end && p.curve.kind == StrokeKind::kArc) return circle_of_arc(p.curve);
    }
    const Vector3d begin = is_joint(u) ? at : clusters_.at[u];
    const Vector3d end = is_joint(v) ? at : clusters_.at[v];
    if (begin == p.curve.begin() && end == p.curve.end()) return p.curve;
    const PlainCurve moved = move_ends(p.curve, begin, end);
    const PlainCurve fit = refit_between(moved, p.points);
    return misfit(fit, p.points, options_) < misfit(moved, p.points, options_) ? fit : moved;
  }

  // Point nearest to the tangents of all strokes that end in a or b, but for the one that goes.
  Vector3d corner_of(int a, int b, const std::vector<int>& around) const {
    std::vector<EndLine> lines;
    const auto is_joint = [&](int node) {
      return clusters_.label[node] == a || clusters_.label[node] == b;
    };
    for (int i : around) {
      const Piece& p = draft_.pieces[i];
      const bool loop = is_joint(p.begin) && is_joint(p.end);
      if (loop && p.curve.kind == StrokeKind::kArc) continue;  // becomes a circle
      const double weight = p.samples.length;                  // for the number of places that tell
      if (is_joint(p.begin))
        lines.push_back({p.curve.begin(), outward_tangent(p.curve, false), weight});
      if (is_joint(p.end)) lines.push_back({p.curve.end(), outward_tangent(p.curve, true), weight});
    }
    std::vector<Vector3d> members;
    for (int c : {a, b})
      for (int n : clusters_.members[c]) members.push_back(draft_.nodes[n]);
    return corner(lines, members, reach_);
  }

  // What joining two clusters does to the description of the strokes that end there. The stroke
  // `gone`, if any, is removed with it.
  Join judge(int a, int b, int gone) const {
    std::vector<int> around = ways_.strokes_at(a);
    for (int i : ways_.strokes_at(b))
      if (std::find(around.begin(), around.end(), i) == around.end()) around.push_back(i);
    around.erase(std::remove(around.begin(), around.end(), gone), around.end());
    Join join;
    join.at = corner_of(a, b, around);
    int before = a == b ? 1 : 2, ends = 0, own = 0;
    for (int i : around) {
      const Piece& p = draft_.pieces[i];
      const PlainCurve now = between(p, -1, -1, join.at), then = between(p, a, b, join.at);
      if (!is_sound(then)) join.growth = INFINITY;
      ends += !then.closed();
      own += own_parameters(then.kind) - own_parameters(now.kind);
      join.growth += misfit(then, p.points, options_) - misfit(now, p.points, options_);
      join.curves.push_back(then);
    }
    if (gone >= 0) {
      const Piece& p = draft_.pieces[gone];
      own -= own_parameters(p.curve.kind);
      join.growth += misfit(join.curves, p.points, options_) - misfit(p.curve, p.points, options_);
    }
    join.growth += options_.price * own + options_.node_price * ((ends > 0) - before);
    return join;
  }

  // Agglomerates nodes, nearest first, by complete linkage; never folds a stroke or a short way.
  void link() {
    const int count = int(draft_.nodes.size());
    const std::vector<int> degrees = draft_.degrees();
    std::vector<std::map<int, double>> near(count);  // clusters that may still be joined
    std::set<std::tuple<double, int, int>> queue;
    const auto add = [&](int a, int b, double d) {
      near[a][b] = near[b][a] = d;
      queue.insert({d, std::min(a, b), std::max(a, b)});
    };
    const auto drop = [&](int a, int b) {
      queue.erase({near[a][b], std::min(a, b), std::max(a, b)});
      near[a].erase(b);
      near[b].erase(a);
    };
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b) {
        const double d = (draft_.nodes[a] - draft_.nodes[b]).norm();
        if (d <= reach_ && degrees[a] > 0 && degrees[b] > 0) add(a, b, d);
      }
    while (!queue.empty()) {
      const auto [d, a, b] = *queue.begin();
      const bool folds = ways_.shortest(a, b, kWayRound * d, [](int) { return true; }) < INFINITY;
      const Join join = folds ? Join{} : judge(a, b, -1);
      if (folds || !(join.growth < 0)) {
        drop(a, b);
        continue;
      }
      const std::map<int, double> to_a = near[a], to_b = near[b];
      for (const auto& [c, dc] : to_a) drop(a, c);
      for (const auto& [c, dc] : to_b)
        if (c != a) drop(b, c);
      const int joint = clusters_.join(a, b, join.at);
      for (const auto& [c, dc] : to_a) {
        const auto other = to_b.find(c);
        if (c != b && other != to_b.end()) add(joint, c, std::max(dc, other->second));
      }
    }
  }

  // Whether a short stroke is one side of a small closed shape, which would vanish with it.
  bool is_in_loop(int stroke) const {
    const Piece& own = draft_.pieces[stroke];
    const int a = clusters_.label[own.begin], b = clusters_.label[own.end];
    const auto is_other = [&](int i) {
      if (i == stroke) return false;
      const Piece& p = draft_.pieces[i];
      const std::pair<int, int> ends =
          std::minmax(clusters_.label[p.begin], clusters_.label[p.end]);
      if (ends != std::pair<int, int>(std::minmax(a, b))) return true;
      return (middle_of(p.curve) - middle_of(own.curve)).norm() >
             kFlat * (p.samples.length + own.samples.length);
    };
    const auto is_small = [&](int i) {
      return is_other(i) && draft_.pieces[i].samples.length <= kLoopStroke * reach_;
    };
    return ways_.shortest(a, b, kWayRound * own.samples.length, is_other) < INFINITY ||
           ways_.shortest(a, b, INFINITY, is_small) < INFINITY;
  }

  // Largest distance between nodes of two clusters.
  double spread(int a, int b) const {
    double worst = 0;
    for (int m : clusters_.members[a])
      for (int n : clusters_.members[b])
        worst = std::max(worst, (draft_.nodes[m] - draft_.nodes[n]).norm());
    return worst;
  }

  // Removes strokes shorter than the reach and joins their ends, shortest first.
  void collapse_short() {
    std::vector<std::pair<double, int>> strokes;
    for (int i = 0; i < draft_.size(); ++i) {
      const Piece& p = draft_.pieces[i];
      if (!is_open(p) || p.samples.length > reach_) continue;
      const bool folded = clusters_.label[p.begin] == clusters_.label[p.end];
      if (folded || !is_in_loop(i)) strokes.push_back({p.samples.length, i});
    }
    std::sort(strokes.begin(), strokes.end());
    for (const auto& [length, i] : strokes) {
      const int a = clusters_.label[draft_.pieces[i].begin];
      const int b = clusters_.label[draft_.pieces[i].end];
      if (spread(a, b) > reach_) continue;
      const Join join = judge(a, b, i);
      if (!(join.growth < 0)) continue;
      if (a != b) clusters_.join(a, b, join.at);
      draft_.remove(i);
    }
  }

  // Lets the strokes end where their clusters are.
  void follow() {
    for (int i = 0; i < draft_.size(); ++i) {
      const Piece& p = draft_.pieces[i];
      if (!is_open(p)) continue;
      const int a = clusters_.label[p.begin], b = clusters_.label[p.end];
      if (clusters_.members[a].size() < 2 && clusters_.members[b].size() < 2) continue;
      const PlainCurve curve = between(p, -1, -1, Vector3d::Zero());
      draft_.replace(i, curve, curve.closed() ? -1 : a, curve.closed() ? -1 : b);
    }
  }

  Draft& draft_;
  const TopologyOptions& options_;
  const double reach_;
  EndClusters clusters_;
  Ways ways_;
};

}  // namespace

PassResult merge_endpoints(const Sketch& sketch, const TopologyOptions& options,
                           const StrokePoints& points) {
  Draft draft(sketch, points.empty() ? drawn_points(sketch, options) : points);
  for (int round = 0; round < kMaxRounds; ++round) {
    const int before = draft.changes;
    const int joined = Joiner(&draft, options).run();
    draft.changes += joined;
    if (draft.changes == before) break;
  }
  return draft.finish();
}

}  // namespace sketchsplat
