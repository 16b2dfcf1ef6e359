// SPDX-License-Identifier: MIT
#include "sketches/segment.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kOutlier = 8;     // [nat]
constexpr double kClosing = 6;     // [unit] gap that a circle closes
constexpr int kMostCuts = 24;      // candidates of a run
constexpr double kHopeless = 1e9;  // [nat] of points that no curve can be fitted to

class Cutter {
 public:
  Cutter(const Matrix3Xd& p, const Matrix3Xd& t, double sigma, double unit,
         const SegmentOptions& options)
      : p_(p), t_(t), sigma_(sigma), unit_(unit), options_(options) {}

  // The curve of shortest description for points [a, b).
  RunPiece best(int a, int b, bool closed) const {
    const Matrix3Xd p = p_.middleCols(a, b - a), t = t_.middleCols(a, b - a);
    RunPiece out;
    out.first = a, out.last = b, out.cost = kHopeless;
    const auto consider = [&](RunFit&& fit) {
      if (!fit.ok()) return;
      const double cost = description_length(fit.distance, sigma_, fit.kind, options_);
      if (cost < out.cost) out.cost = cost, out.fit = std::move(fit);
    };
    if (!closed) consider(line_through(p));
    // Not worth a look if the parameters alone cost more.
    if (b - a >= 5 && out.cost > price(StrokeKind::kArc))
      consider(arc_through(p, t, closed, kClosing * unit_));
    if (b - a >= 6 && !closed && out.cost > price(StrokeKind::kBezier)) consider(cubic_through(p));
    if (closed && out.cost > price(StrokeKind::kEllipse)) consider(ellipse_through(p));
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

  // Shortest description over all ways to cut [a, b) at the candidates.
  std::vector<RunPiece> program(int a, int b) const {
    const int step = std::max(1, (b - a + kMostCuts - 1) / kMostCuts);
    std::vector<int> at;
    for (int k = a; k <= b - options_.min_points; k += step) at.push_back(k);
    at.push_back(b);
    const int n = int(at.size());
    std::vector<double> least(n, 1e300);
    std::vector<int> from(n, 0);
    std::vector<RunPiece> last(n);
    least[0] = 0;
    for (int j = 1; j < n; ++j)
      for (int i = j - 1; i >= 0; --i) {
        // Neighbours share the point between them.
        const int end = std::min(b, at[j] + (j + 1 < n ? 1 : 0));
        if (end - at[i] < options_.min_points || !(least[i] < least[j])) continue;
        RunPiece piece = best(at[i], end, false);
        const double sum = least[i] + piece.cost;
        if (sum < least[j]) least[j] = sum, from[j] = i, last[j] = std::move(piece);
      }
    std::vector<RunPiece> out;
    for (int j = n - 1; j > 0; j = from[j]) out.push_back(last[j]);
    std::reverse(out.begin(), out.end());
    return out;
  }

  // Moves every cut to where its two curves cost least.
  void settle(std::vector<RunPiece>* pieces) const {
    for (size_t k = 0; k + 1 < pieces->size(); ++k) {
      RunPiece &x = (*pieces)[k], &y = (*pieces)[k + 1];
      for (int step = std::max(1, (y.last - x.first) / (2 * kMostCuts)); step > 0; step /= 2)
        for (int way : {-step, step})
          while (true) {
            const int cut = y.first + way;
            if (cut + 1 - x.first < options_.min_points || y.last - cut < options_.min_points)
              break;
            RunPiece u = best(x.first, cut + 1, false), v = best(cut, y.last, false);
            if (!(u.cost + v.cost < x.cost + y.cost - 1e-9)) break;
            x = std::move(u), y = std::move(v);
          }
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

// Distance that 9 in 10 points keep.
double ninth_decile(Eigen::VectorXd d) {
  const Eigen::Index k = std::min(d.size() - 1, d.size() * 9 / 10);
  std::nth_element(d.data(), d.data() + k, d.data() + d.size());
  return d[k];
}

constexpr double kFar = 4;  // [sigma] pieces whose points lie farther are no curve

}  // namespace

double description_length(const Eigen::VectorXd& distance, double sigma, StrokeKind kind,
                          const SegmentOptions& options) {
  const auto nats = (distance.array() / sigma).square() / 2;
  return nats.min(kOutlier).sum() + options.price * num_parameters(kind);
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
                   const SegmentOptions& options, Sketch* sketch) {
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
