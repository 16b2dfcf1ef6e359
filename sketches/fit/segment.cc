// SPDX-License-Identifier: MIT
#include "sketches/fit/segment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kRound = 0.25;    // [unit] what lies nearer to its circle is no ellipse
constexpr double kClosing = 6;     // [unit] gap that a circle closes
constexpr int kMostCuts = 24;      // candidates of a run
constexpr int kTries = 4;          // on either side of a cut, at each step
constexpr double kMostSaved = 2;   // parameters, by what goes on smoothly
constexpr double kHopeless = 1e9;  // [nat] of points that no curve can be fitted to

// Distance that 9 in 10 points keep.
double ninth_decile(Eigen::VectorXd d) {
  const Eigen::Index k = std::min(d.size() - 1, d.size() * 9 / 10);
  std::nth_element(d.data(), d.data() + k, d.data() + d.size());
  return d[k];
}

// Kinds that go together in one run.
enum Family { kPlain, kOval, kFree, kFamilies };
Family family_of(StrokeKind kind) {
  return kind == StrokeKind::kBezier                                        ? kFree
         : kind == StrokeKind::kEllipticArc || kind == StrokeKind::kEllipse ? kOval
                                                                            : kPlain;
}
constexpr double kSwitch = 3;  // parameters that a change of the family is worth, and its place

class Cutter {
 public:
  Cutter(const Matrix3Xd& p, const Matrix3Xd& t, double sigma, double unit,
         const SegmentOptions& options)
      : p_(p), t_(t), sigma_(sigma), unit_(unit), options_(options) {}

  // The curve of shortest description for points [a, b).
  RunPiece best(int a, int b, bool closed) const {
    RunPiece out = plain(a, b, closed);
    if (!closed && out.cost > price(StrokeKind::kBezier)) {
      RunPiece other = cubic(a, b);
      if (other.cost < out.cost) out = std::move(other);
    }
    return out;
  }

  std::vector<RunPiece> cut(int a, int b) const {
    if (b - a < options_.min_points) return {};
    const RunPiece whole = best(a, b, false);
    if (whole.cost <= 2 * price(StrokeKind::kLine) || b - a < 2 * options_.min_points)
      return {whole};
    std::vector<RunPiece> pieces = program(a, b);
    settle(&pieces);
    return pieces;
  }

 private:
  double price(StrokeKind kind) const { return options_.price * num_parameters(kind); }
  double joint(const RunPiece& x, const RunPiece& y) const {
    return joint_cost(x.fit.kind, y.fit.kind, options_);
  }

  void consider(RunFit&& fit, RunPiece* out) const {
    if (!fit.ok()) return;
    const double cost = description_length(fit.distance, sigma_, fit.kind, options_);
    if (cost < out->cost) out->cost = cost, out->fit = std::move(fit);
  }

  // All but cubics.
  RunPiece plain(int a, int b, bool closed) const {
    const Matrix3Xd p = p_.middleCols(a, b - a), t = t_.middleCols(a, b - a);
    RunPiece out;
    out.first = a, out.last = b, out.cost = kHopeless;
    if (!closed) consider(line_through(p), &out);
    if (!options_.conics) return out;
    // Not worth a look if the parameters alone cost more.
    if (b - a >= 5 && out.cost > price(StrokeKind::kArc))
      consider(arc_through(p, t, closed, kClosing * unit_), &out);
    // What hides an edge in some views bends it by so much: no reason to take a circle for an
    // ellipse.
    const bool round =
        out.fit.kind != StrokeKind::kLine && ninth_decile(out.fit.distance) < kRound * unit_;
    if (!closed && !round && options_.elliptic && out.cost > price(StrokeKind::kEllipticArc))
      consider(elliptic_arc_through(p, kClosing * unit_), &out);
    if (closed && out.cost > price(StrokeKind::kEllipse)) consider(ellipse_through(p), &out);
    return out;
  }

  RunPiece cubic(int a, int b) const {
    RunPiece out;
    out.first = a, out.last = b, out.cost = kHopeless;
    if (b - a >= 6) consider(cubic_through(p_.middleCols(a, b - a)), &out);
    return out;
  }

  // Shortest description over all ways to cut [a, b) at the candidates. What a piece costs depends
  // on the one before it, so the ways that end with each family are followed apart.
  std::vector<RunPiece> program(int a, int b) const {
    const int step = std::max(1, (b - a + kMostCuts - 1) / kMostCuts);
    std::vector<int> at;
    for (int k = a; k <= b - options_.min_points; k += step) at.push_back(k);
    at.push_back(b);
    const int n = int(at.size());
    struct Way {
      double cost = 1e300;
      int from = -1, from_family = 0;
      RunPiece last;
    };
    std::vector<std::array<Way, kFamilies>> ways(n);
    ways[0][0].cost = 0;
    const auto least = [&](int i) {
      double cost = 1e300;
      for (const Way& way : ways[i]) cost = std::min(cost, way.cost);
      return cost;
    };
    const auto extend = [&](int i, int j, const RunPiece& piece) {
      if (!piece.fit.ok()) return;
      Way& to = ways[j][family_of(piece.fit.kind)];
      for (int f = 0; f < kFamilies; ++f) {
        const Way& way = ways[i][f];
        const double cost = piece.cost + (way.from < 0 ? 0 : joint(way.last, piece));
        if (!(way.cost + cost < to.cost)) continue;
        to = {way.cost + cost, i, f, piece};
        to.last.cost = cost;
      }
    };
    for (int j = 1; j < n; ++j)
      for (int i = j - 1; i >= 0; --i) {
        // Neighbours share the point between them.
        const int end = std::min(b, at[j] + (j + 1 < n ? 1 : 0));
        if (end - at[i] < options_.min_points || least(i) - kMostSaved * options_.price >= least(j))
          continue;
        const RunPiece piece = plain(at[i], end, false);
        if (piece.cost > price(StrokeKind::kBezier) - kMostSaved * options_.price)
          extend(i, j, cubic(at[i], end));
        extend(i, j, piece);
      }
    std::vector<RunPiece> out;
    int family = 0;
    for (int f = 1; f < kFamilies; ++f)
      if (ways[n - 1][f].cost < ways[n - 1][family].cost) family = f;
    for (int j = n - 1; j > 0;) {
      const Way& way = ways[j][family];
      if (way.from < 0) return {};
      out.push_back(way.last);
      j = way.from, family = way.from_family;
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

  // Moves every cut to where its two curves, of whatever kind, cost least.
  void settle(std::vector<RunPiece>* pieces) const {
    std::vector<RunPiece>& p = *pieces;
    for (size_t k = p.size(); k-- > 1;) p[k].cost -= joint(p[k - 1], p[k]);
    const int reach = p.empty() ? 0 : (p.back().last - p[0].first) / kMostCuts + 1;
    for (int sweep = 0; sweep < 2; ++sweep)
      for (size_t k = 0; k + 1 < p.size(); ++k) settle(k, reach, &p);
    for (size_t k = p.size(); k-- > 1;) p[k].cost += joint(p[k - 1], p[k]);
  }

  void settle(size_t k, int reach, std::vector<RunPiece>* pieces) const {
    std::vector<RunPiece>& p = *pieces;
    const int first = p[k].first, last = p[k + 1].last;
    const auto cost = [&](const RunPiece& x, const RunPiece& y) {
      return x.cost + y.cost + joint(x, y) + (k > 0 ? joint(p[k - 1], x) : 0) +
             (k + 2 < p.size() ? joint(y, p[k + 2]) : 0);
    };
    double least = cost(p[k], p[k + 1]);
    for (int step = std::max(1, reach / kTries);; step /= 2) {
      const int middle = p[k + 1].first;
      for (int t = -kTries; t <= kTries; ++t) {
        const int at = middle + t * step;
        if (at + 1 - first < options_.min_points || last - at < options_.min_points) continue;
        RunPiece x = best(first, at + 1, false), y = best(at, last, false);
        const double here = cost(x, y);
        if (here < least - 1e-9) least = here, p[k] = std::move(x), p[k + 1] = std::move(y);
      }
      if (step == 1) return;
    }
  }

  const Matrix3Xd& p_;
  const Matrix3Xd& t_;
  double sigma_, unit_;
  const SegmentOptions& options_;
};

double cost_of(const std::vector<RunPiece>& pieces) {
  double sum = 0;
  for (const RunPiece& piece : pieces) sum += piece.cost;
  return pieces.empty() ? 1e300 : sum;
}

// Does the run turn between points i and j? Tangents are axes: made to point along the run.
bool is_corner(const Matrix3Xd& p, const Matrix3Xd& t, int i, int j, const SegmentOptions& o) {
  const Vector3d v = p.col(j) - p.col(i);
  const Vector3d a = t.col(i) * (t.col(i).dot(v) < 0 ? -1 : 1);
  const Vector3d b = t.col(j) * (t.col(j).dot(v) < 0 ? -1 : 1);
  return a.dot(b) < std::cos(o.corner_deg * M_PI / 180);
}

constexpr double kFar = 4;  // [sigma] pieces whose points lie farther are no curve

}  // namespace

double misfit(const Eigen::VectorXd& distance, double sigma) {
  return ((distance.array() / sigma).square() / 2).min(kOutlierNats).sum();
}

double description_length(const Eigen::VectorXd& distance, double sigma, StrokeKind kind,
                          const SegmentOptions& options) {
  return misfit(distance, sigma) + options.price * num_parameters(kind);
}

double joint_cost(StrokeKind before, StrokeKind after, const SegmentOptions& options) {
  const Family x = family_of(before), y = family_of(after);
  if (x != y) return kSwitch * options.price;
  return x == kFree ? -2 * options.price : 0;
}

std::vector<RunPiece> cut_run(const Matrix3Xd& points, const Matrix3Xd& tangents, bool closed,
                              double sigma, double unit, const SegmentOptions& options) {
  const int n = int(points.cols());
  if (!closed) return Cutter(points, tangents, sigma, unit, options).cut(0, n);
  // Open it anywhere, and again at the cut that was found.
  Matrix3Xd p(3, 2 * n), t(3, 2 * n);
  p << points, points;
  t << tangents, tangents;
  const Cutter cutter(p, t, sigma, unit, options);
  std::vector<RunPiece> whole = {cutter.best(0, n, true)};
  if (whole[0].cost <= 2 * options.price * num_parameters(StrokeKind::kArc)) return whole;
  std::vector<RunPiece> pieces = cutter.cut(0, n);
  if (pieces.size() > 1) {
    const int start = pieces[pieces.size() / 2].first;
    pieces = cutter.cut(start, std::min(2 * n, start + n + 1));
  }
  return cost_of(pieces) < whole[0].cost ? pieces : whole;
}

void segment_chain(const Matrix3Xd& points, const Matrix3Xd& tangents, bool closed, double unit,
                   const SegmentOptions& asked, Sketch* sketch) {
  // Lifted points scatter: an arc of an ellipse would swallow a line and an arc. Who asks the
  // edgels later on can tell.
  SegmentOptions options = asked;
  options.elliptic = false;
  const int n = int(points.cols());
  std::vector<int> corners;
  for (int i = 0; i + 1 < n; ++i)
    if (is_corner(points, tangents, i, i + 1, options)) corners.push_back(i + 1);
  Matrix3Xd p = points, t = tangents;
  if (closed && !corners.empty()) {  // start at a corner: then it is an open run
    const int k = corners.front();
    for (int i = 0; i < n; ++i)
      p.col(i) = points.col((i + k) % n), t.col(i) = tangents.col((i + k) % n);
    for (int& c : corners) c -= k;
    corners.erase(corners.begin());
    closed = false;
  }
  std::vector<RunPiece> pieces;
  corners.push_back(n);
  int a = 0;
  for (int b : corners) {
    for (RunPiece& piece : cut_run(p.middleCols(a, b - a), t.middleCols(a, b - a), closed,
                                   options.sigma * unit, unit, options))
      pieces.push_back(std::move(piece));
    a = b;
  }
  for (const RunPiece& piece : pieces) {
    const RunFit& fit = piece.fit;
    if (!fit.ok() || !(ninth_decile(fit.distance) < kFar * options.sigma * unit)) continue;
    if (is_closed(fit.kind)) {
      sketch->add_stroke(fit.kind, -1, -1, fit.handles);
      continue;
    }
    Sketch alone;
    alone.add_node(fit.begin), alone.add_node(fit.end);
    alone.add_stroke(fit.kind, 0, 1, fit.handles);
    if (stroke_length(alone, 0) < options.min_length * unit) continue;
    const int begin = sketch->add_node(fit.begin), end = sketch->add_node(fit.end);
    sketch->add_stroke(fit.kind, begin, end, fit.handles);
  }
}

}  // namespace sketchsplat
