// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/mesh_runs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "sketches/curve/curve.h"
#include "sketches/fit/fit.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kArcEdges = 3;       // any three points lie on a circle: no fewer edges tell of one
constexpr int kLoopEdges = 6;      // of a circle
constexpr int kCubicEdges = 8;     // a cubic through fewer points says little
constexpr double kStretch = 0.03;  // a cubic that is longer than its points swings between them

bool line_fits(const Matrix3Xd& p, double tolerance) {
  const Vector3d a = p.col(0), d = p.col(p.cols() - 1) - a;
  double along = 0;
  for (int i = 1; i < p.cols(); ++i) {
    const double t = (p.col(i) - a).dot(d) / d.squaredNorm();
    if (!(t > along) || (p.col(i) - a - t * d).norm() > tolerance) return false;
    along = t;
  }
  return true;
}

bool arc_fits(const Matrix3Xd& p, double tolerance, Vector3d* apex) {
  if (p.cols() < kArcEdges + 1 || fit_circle(p).max_distance > tolerance) return false;
  if (!fit_arc(p).success) return false;
  const Vector3d begin = p.col(0), end = p.col(p.cols() - 1);
  const ArcFit arc = fit_arc(p.middleCols(1, p.cols() - 2), begin, end);
  *apex = arc.apex;
  return arc.success && arc.max_distance <= tolerance;
}

bool cubic_fits(const Matrix3Xd& p, double tolerance, std::vector<Vector3d>* handles) {
  if (p.cols() < kCubicEdges + 1) return false;
  const Vector3d begin = p.col(0), end = p.col(p.cols() - 1);
  const BezierFit fit = fit_bezier(p, begin, end);
  if (!fit.success || fit.max_distance > tolerance) return false;
  *handles = {fit.control[1], fit.control[2]};
  Sketch one;
  one.add_node(begin), one.add_node(end);
  one.add_stroke(StrokeKind::kBezier, 0, 1, *handles);
  const double length =
      (p.rightCols(p.cols() - 1) - p.leftCols(p.cols() - 1)).colwise().norm().sum();
  return stroke_length(one, 0) < (1 + kStretch) * length;
}

// Most edges, at least `fewest`, for which a fit holds that holds for all smaller numbers; 0 if
// none.
int reach(int fewest, int most, const std::function<bool(int)>& fits) {
  if (fewest > most || !fits(fewest)) return 0;
  int good = fewest, bad = most + 1;
  for (int step = 1; good + step <= most; step *= 2) {
    if (!fits(good + step)) {
      bad = good + step;
      break;
    }
    good += step;
  }
  while (bad - good > 1) {
    const int middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

double mean_edge(const Matrix3Xd& p, int first, int last) {
  double sum = 0;
  for (int i = first; i < last; ++i) sum += (p.col(i + 1) - p.col(i)).norm();
  return sum / (last - first);
}

MeshCurve longest_piece(const Matrix3Xd& p, int first, double tolerance) {
  const int most = int(p.cols()) - 1 - first;
  const auto part = [&](int edges) { return Matrix3Xd(p.middleCols(first, edges + 1)); };
  MeshCurve piece;
  piece.first = first;
  Vector3d apex;
  std::vector<Vector3d> handles;
  int edges = std::max(1, reach(1, most, [&](int n) { return line_fits(part(n), tolerance); }));
  const int arc =
      reach(kArcEdges, most, [&](int n) { return arc_fits(part(n), tolerance, &apex); });
  if (arc > edges) {
    piece.kind = StrokeKind::kArc;
    edges = arc;
  }
  const int cubic =
      reach(kCubicEdges, most, [&](int n) { return cubic_fits(part(n), tolerance, &handles); });
  const bool scraps =
      edges < most && most - edges < kArcEdges &&
      mean_edge(p, first + edges, first + most) <= 2 * mean_edge(p, first, first + edges);
  // A cubic bends to nearly everything: it has to explain much more, or spare the run an end of
  // edges too few to tell what they are.
  if (cubic >= 2 * edges || (scraps && cubic == most)) {
    piece.kind = StrokeKind::kBezier;
    edges = cubic;
  }
  piece.last = first + edges;
  if (piece.kind == StrokeKind::kArc) {
    arc_fits(part(edges), tolerance, &apex);
    piece.handles = {apex};
  } else if (piece.kind == StrokeKind::kBezier) {
    cubic_fits(part(edges), tolerance, &piece.handles);
  }
  return piece;
}

bool loop_fits(const Matrix3Xd& points, double tolerance, MeshCurve* piece) {
  const int n = int(points.cols()) - 1;
  if (n < kLoopEdges) return false;
  const Matrix3Xd once = points.leftCols(n);
  const CircleFit circle = fit_circle(once);
  piece->first = 0, piece->last = n;
  if (circle.success && circle.max_distance <= tolerance) {
    piece->kind = StrokeKind::kCircle;
    piece->handles = {circle.centre, circle.normal * circle.radius};
    return true;
  }
  if (n < 2 * kLoopEdges) return false;
  const EllipseFit ellipse = fit_ellipse(once);
  piece->kind = StrokeKind::kEllipse;
  piece->handles = {ellipse.centre, ellipse.u, ellipse.v};
  return ellipse.success && ellipse.max_distance <= tolerance;
}

// The few edges that a cubic leaves over, too few to tell what they are, are more of its curve
// where two cubics of equal shares fit and the edges are no longer than its own.
void share_remainders(const Matrix3Xd& p, double tolerance, std::vector<MeshCurve>* pieces) {
  for (size_t i = 1; i < pieces->size(); ++i) {
    MeshCurve a = (*pieces)[i - 1], b = (*pieces)[i];
    if (a.kind != StrokeKind::kBezier || b.last - b.first >= kCubicEdges) continue;
    if (mean_edge(p, b.first, b.last) > 2 * mean_edge(p, a.first, a.last)) continue;
    a.last = b.first = (a.first + b.last) / 2;
    b.kind = StrokeKind::kBezier;
    const auto fits = [&](MeshCurve* piece) {
      return cubic_fits(p.middleCols(piece->first, piece->last - piece->first + 1), tolerance,
                        &piece->handles);
    };
    if (!fits(&a) || !fits(&b)) continue;
    (*pieces)[i - 1] = a;
    (*pieces)[i] = b;
  }
}

}  // namespace

std::vector<MeshCurve> cut_run(const Matrix3Xd& points, double tolerance) {
  const int n = int(points.cols()) - 1;
  MeshCurve loop;
  if (points.col(0) == points.col(n) && loop_fits(points, tolerance, &loop)) return {loop};
  std::vector<MeshCurve> pieces;
  for (int first = 0; first < n; first = pieces.back().last)
    pieces.push_back(longest_piece(points, first, tolerance));
  share_remainders(points, tolerance, &pieces);
  return pieces;
}

}  // namespace sketchsplat
