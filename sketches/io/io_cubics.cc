// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <ostream>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "sketches/io/io_number.h"

namespace sketchsplat {
namespace {

double turned_angle(const Sketch& sketch, int stroke) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  if (is_closed(kind)) return 2 * M_PI;
  if (kind == StrokeKind::kEllipticArc)
    return 2 * elliptic_arc_parameters(control_points(sketch, stroke)).half_angle;
  return circle_parameters(sketch, stroke).angle;
}

// Pieces of a circular arc so that cubics with handles of length 4/3 tan(angle / 4) stay within
// tolerance * min(radius, arc length): their radial error is 2/27 sin^6(a/4) / cos^2(a/4).
int num_pieces(double angle, double tolerance) {
  for (int n = std::max(1, int(std::ceil(angle / M_PI_2)));; ++n) {
    const double s = std::sin(angle / n / 4), c = std::cos(angle / n / 4);
    if (2.0 / 27 * std::pow(s, 6) / (c * c) <= tolerance * std::min(1.0, angle)) return n;
  }
}

}  // namespace

std::vector<Eigen::Matrix<double, 3, 4>> to_cubics(const Sketch& sketch, int stroke,
                                                   double tolerance) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  const ControlPoints c = control_points(sketch, stroke);
  Eigen::Matrix<double, 3, 4> piece;
  if (kind == StrokeKind::kLine) {
    piece << c.p[0], (2 * c.p[0] + c.p[1]) / 3, (c.p[0] + 2 * c.p[1]) / 3, c.p[1];
    return {piece};
  }
  if (kind == StrokeKind::kBezier) {
    piece << c.p[0], c.p[1], c.p[2], c.p[3];
    return {piece};
  }
  const double angle = turned_angle(sketch, stroke);
  const int n = angle > 0 ? num_pieces(angle, tolerance) : 1;
  // Handle length per derivative by t; its limit for a straight arc is that of a Hermite cubic.
  const double step = angle > 0 ? 4.0 / 3 * std::tan(angle / n / 4) / angle : 1.0 / 3;
  std::vector<Eigen::Matrix<double, 3, 4>> pieces;
  Eigen::Vector3d p0, d0, p1, d1;
  for (int i = 0; i < n; ++i) {
    evaluate_stroke(sketch, stroke, double(i) / n, &p0, &d0);
    evaluate_stroke(sketch, stroke, double(i + 1) / n, &p1, &d1);
    piece << p0, p0 + step * d0, p1 - step * d1, p1;
    pieces.push_back(piece);
  }
  if (!is_closed(kind)) {  // the ends are the nodes, to the last bit
    pieces.front().col(0) = c.p[0];
    pieces.back().col(3) = c.p[c.count - 1];
  } else {
    pieces.back().col(3) = pieces.front().col(0);
  }
  return pieces;
}

void write_parametric_edges(std::ostream& out, const Sketch& sketch) {
  std::string curves, lines;
  const auto row = [](const Eigen::Vector3d& p) {
    return shortest(p.x()) + "," + shortest(p.y()) + "," + shortest(p.z());
  };
  for (int i = 0; i < sketch.size(); ++i) {
    if (sketch.strokes[i].kind == StrokeKind::kLine) {
      const ControlPoints c = control_points(sketch, i);
      lines += (lines.empty() ? "\n    [" : ",\n    [") + row(c.p[0]) + "," + row(c.p[1]) + "]";
      continue;
    }
    for (const Eigen::Matrix<double, 3, 4>& piece : to_cubics(sketch, i)) {
      curves += curves.empty() ? "\n    [" : ",\n    [";
      for (int k = 0; k < 4; ++k) curves += (k ? ",[" : "[") + row(piece.col(k)) + "]";
      curves += "]";
    }
  }
  out << "{\n  \"curves_ctl_pts\": [" << curves << "\n  ],\n  \"lines_end_pts\": [" << lines
      << "\n  ]\n}\n";
}

}  // namespace sketchsplat
