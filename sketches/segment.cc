// SPDX-License-Identifier: MIT
#include "sketches/segment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

#include "sketches/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A curve through a run of points, as add_stroke wants it, and how far the points are from it.
struct Piece {
  StrokeKind kind = StrokeKind::kLine;
  Vector3d begin, end;
  std::vector<Vector3d> handles;
  double error = 1e300;  ///< distance that 9 in 10 points keep
};

double ninth_decile(std::vector<double> d) {
  if (d.empty()) return 1e300;
  const size_t k = std::min(d.size() - 1, d.size() * 9 / 10);
  std::nth_element(d.begin(), d.begin() + k, d.end());
  return d[k];
}

Piece line_through(const Matrix3Xd& p) {
  Piece out;
  const Vector3d c = p.rowwise().mean();
  const Matrix3Xd q = p.colwise() - c;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> es(q * q.transpose());
  Vector3d u = es.eigenvectors().col(2);
  if (u.dot(p.col(p.cols() - 1) - p.col(0)) < 0) u = -u;
  double lo = 1e300, hi = -1e300;
  std::vector<double> d;
  for (int i = 0; i < q.cols(); ++i) {
    const double s = u.dot(q.col(i));
    lo = std::min(lo, s), hi = std::max(hi, s);
    d.push_back((q.col(i) - s * u).norm());
  }
  out.begin = c + lo * u, out.end = c + hi * u;
  out.error = ninth_decile(d);
  return out;
}

struct CircleFit {
  Vector3d centre, normal;
  double radius = 0;
  bool ok = false;
};

// Plane from positions and tangents (a short arc bends too little for positions alone), then
// Kasa's algebraic circle in it, sharpened by Gauss-Newton on the distances.
CircleFit circle_through(const Matrix3Xd& p, const Matrix3Xd& t) {
  CircleFit fit;
  const Vector3d c = p.rowwise().mean();
  const Matrix3Xd q = p.colwise() - c;
  const double spread = std::sqrt(q.squaredNorm() / q.cols());
  if (!(spread > 0)) return fit;
  const Eigen::Matrix3d M = q * q.transpose() / (spread * spread) + t * t.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> es(M);
  fit.normal = es.eigenvectors().col(0);
  const Vector3d x = es.eigenvectors().col(2), y = fit.normal.cross(x);
  Eigen::MatrixXd A(p.cols(), 3);
  Eigen::VectorXd b(p.cols());
  for (int i = 0; i < p.cols(); ++i) {
    const double u = x.dot(q.col(i)) / spread, v = y.dot(q.col(i)) / spread;
    A.row(i) << 2 * u, 2 * v, 1;
    b[i] = u * u + v * v;
  }
  Vector3d s = A.colPivHouseholderQr().solve(b);
  double r = std::sqrt(std::max(0.0, s[2] + s[0] * s[0] + s[1] * s[1]));
  for (int it = 0; it < 8; ++it) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    for (int i = 0; i < p.cols(); ++i) {
      const double u = A(i, 0) / 2 - s[0], v = A(i, 1) / 2 - s[1], d = std::hypot(u, v);
      if (!(d > 0)) continue;
      const Vector3d j(-u / d, -v / d, -1);
      H += j * j.transpose();
      g += j * (d - r);
    }
    const Vector3d step = (H + 1e-12 * Eigen::Matrix3d::Identity()).ldlt().solve(g);
    s[0] -= step[0], s[1] -= step[1], r -= step[2];
  }
  fit.centre = c + spread * (s[0] * x + s[1] * y);
  fit.radius = spread * r;
  fit.ok = std::isfinite(fit.radius) && fit.radius > 0 && fit.centre.allFinite() && r < 200;
  return fit;
}

Piece arc_through(const Matrix3Xd& p, const Matrix3Xd& t, bool closed, double unit) {
  Piece out;
  const CircleFit fit = circle_through(p, t);
  if (!fit.ok) return out;
  std::vector<double> d;
  // Signed sweep along the run: tells full circles from arcs and the side of the apex.
  double sweep = 0;
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i < p.cols(); ++i) {
    const Vector3d v = p.col(i) - fit.centre;
    const double h = v.dot(fit.normal);
    const Vector3d w = v - h * fit.normal;
    d.push_back(std::hypot(h, w.norm() - fit.radius));
    if (i > 0) sweep += std::atan2(before.cross(w).dot(fit.normal), before.dot(w));
    before = w;
  }
  out.error = ninth_decile(d);
  const double gap = 2 * M_PI - std::abs(sweep);
  if (closed || gap * fit.radius < 6 * unit || gap < 0.2) {
    out.kind = StrokeKind::kCircle;
    out.handles = {fit.centre, fit.normal * fit.radius};
    if (std::abs(sweep) < 5) out.error = 1e300;  // closed, but not around the centre
    return out;
  }
  const auto on_circle = [&](const Vector3d& q) {
    const Vector3d v = q - fit.centre;
    return Vector3d(fit.centre + (v - v.dot(fit.normal) * fit.normal).normalized() * fit.radius);
  };
  out.kind = StrokeKind::kArc;
  out.begin = on_circle(p.col(0)), out.end = on_circle(p.col(p.cols() - 1));
  const Vector3d start = out.begin - fit.centre;
  out.handles = {fit.centre + Eigen::AngleAxisd(sweep / 2, fit.normal) * start};
  return out;
}

Piece cubic_through(const Matrix3Xd& p) {
  Piece out;
  const int n = int(p.cols());
  if (n < 6) return out;
  out.kind = StrokeKind::kBezier;
  std::vector<double> t(n, 0.0);
  for (int i = 1; i < n; ++i) t[i] = t[i - 1] + (p.col(i) - p.col(i - 1)).norm();
  if (!(t[n - 1] > 0)) return out;
  for (double& v : t) v /= t[n - 1];
  Eigen::Matrix<double, 3, 4> c;
  std::vector<double> d(n);
  for (int it = 0; it < 6; ++it) {
    Eigen::MatrixXd B(n, 4);
    for (int i = 0; i < n; ++i) {
      const double s = 1 - t[i];
      B.row(i) << s * s * s, 3 * s * s * t[i], 3 * s * t[i] * t[i], t[i] * t[i] * t[i];
    }
    c = B.colPivHouseholderQr().solve(p.transpose()).transpose();
    for (int i = 0; i < n; ++i) {  // one Newton step towards the closest parameter
      const double s = 1 - t[i];
      const Vector3d q = c * B.row(i).transpose();
      const Vector3d v = 3 * s * s * (c.col(1) - c.col(0)) + 6 * s * t[i] * (c.col(2) - c.col(1)) +
                         3 * t[i] * t[i] * (c.col(3) - c.col(2));
      d[i] = (p.col(i) - q).norm();
      if (v.squaredNorm() > 0)
        t[i] = std::clamp(t[i] + v.dot(p.col(i) - q) / v.squaredNorm(), 0.0, 1.0);
    }
  }
  out.begin = c.col(0), out.end = c.col(3);
  out.handles = {c.col(1), c.col(2)};
  out.error = ninth_decile(d);
  return out;
}

class Segmenter {
 public:
  Segmenter(const Matrix3Xd& p, const Matrix3Xd& t, double unit, const SegmentOptions& options)
      : p_(p), t_(t), unit_(unit), options_(options) {}

  // The simplest curve for points [a, b), or an error above the tolerance.
  Piece fit(int a, int b, bool closed) const {
    const Matrix3Xd p = p_.middleCols(a, b - a), t = t_.middleCols(a, b - a);
    const double tolerance = options_.tolerance * unit_;
    Piece line;
    if (!closed) line = line_through(p);
    if (line.error <= tolerance || b - a < 5) return line;
    const Piece arc = arc_through(p, t, closed, unit_);
    if (arc.error <= tolerance) return arc;
    const Piece cubic = closed ? Piece() : cubic_through(p);
    return cubic.error < arc.error ? cubic : arc;
  }

  void run(int a, int b, bool closed, std::vector<Piece>* out) const {
    if (b - a < options_.min_points) return;
    const Piece whole = fit(a, b, closed);
    if (whole.error <= options_.tolerance * unit_ || b - a < 2 * options_.min_points) {
      if (whole.error < 2 * options_.tolerance * unit_) out->push_back(whole);
      return;
    }
    const int cut = best_cut(a, b);
    run(a, cut + 1, false, out);
    run(cut, b, false, out);
  }

 private:
  // Where two curves of any kind fit best: the worse side counts.
  int best_cut(int a, int b) const {
    const int margin = options_.min_points;
    const int step = std::max(1, (b - a) / 24);
    int best = (a + b) / 2;
    double best_error = 1e300;
    const auto consider = [&](int cut) {
      if (cut < a + margin || cut > b - margin) return;
      const double e = std::max(fit(a, cut + 1, false).error, fit(cut, b, false).error);
      if (e < best_error) best_error = e, best = cut;
    };
    for (int cut = a + margin; cut <= b - margin; cut += step) consider(cut);
    const int coarse = best;
    for (int cut = coarse - step + 1; cut < coarse + step; ++cut) consider(cut);
    return best;
  }

  const Matrix3Xd& p_;
  const Matrix3Xd& t_;
  double unit_;
  const SegmentOptions& options_;
};

// Does the run turn between points i and j? Tangents are axes: made to point along the run.
bool is_corner(const Matrix3Xd& p, const Matrix3Xd& t, int i, int j, const SegmentOptions& o) {
  const Vector3d v = p.col(j) - p.col(i);
  const Vector3d a = t.col(i) * (t.col(i).dot(v) < 0 ? -1 : 1);
  const Vector3d b = t.col(j) * (t.col(j).dot(v) < 0 ? -1 : 1);
  return a.dot(b) < std::cos(o.corner_deg * M_PI / 180);
}

}  // namespace

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
  const Segmenter segmenter(p, t, unit, options);
  std::vector<Piece> pieces;
  corners.push_back(n);
  int a = 0;
  for (int b : corners) {
    segmenter.run(a, b, closed, &pieces);
    a = b;
  }
  for (const Piece& piece : pieces) {
    if (is_closed(piece.kind)) {
      sketch->add_stroke(piece.kind, -1, -1, piece.handles);
      continue;
    }
    Sketch alone;
    alone.add_node(piece.begin), alone.add_node(piece.end);
    alone.add_stroke(piece.kind, 0, 1, piece.handles);
    if (stroke_length(alone, 0) < options.min_length * unit) continue;
    const int begin = sketch->add_node(piece.begin), end = sketch->add_node(piece.end);
    sketch->add_stroke(piece.kind, begin, end, piece.handles);
  }
}

}  // namespace sketchsplat
