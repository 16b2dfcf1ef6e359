// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>
#include <ostream>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/io/io.h"
#include "sketches/io/io_number.h"

namespace sketchsplat {
namespace {

// Steps of at most 45 deg whose chords leave a circle of this radius by `deflection` at most.
int steps_of_circle(double radius, double angle, double deflection) {
  const double ratio = std::min(1.0, deflection / radius);
  const double step = std::min(M_PI_4, 2 * std::acos(1 - ratio));
  return std::max(1, int(std::ceil(angle / std::max(step, 1e-4) - 1e-9)));
}

// Pieces, equal in the parameter, whose chords stay within `deflection` of the curve.
int num_chords(const Sketch& sketch, int stroke, double deflection) {
  const ControlPoints c = control_points(sketch, stroke);
  switch (sketch.strokes[stroke].kind) {
    case StrokeKind::kLine:
      return 1;
    case StrokeKind::kArc: {
      const CircleParameters circle = circle_parameters(sketch, stroke);
      return circle.straight ? 1 : steps_of_circle(circle.radius, circle.angle, deflection);
    }
    case StrokeKind::kCircle:
      return steps_of_circle(c.p[1].norm(), 2 * M_PI, deflection);
    case StrokeKind::kEllipse:  // an affine image of a circle, stretched by the major semi-axis
      return steps_of_circle(principal_axes(c.p[1], c.p[2]).major.norm(), 2 * M_PI, deflection);
    case StrokeKind::kEllipticArc: {
      const EllipticArcParameters e = elliptic_arc_parameters(c);
      return e.straight ? 1
                        : steps_of_circle(principal_axes(e.p, e.q).major.norm(), 2 * e.half_angle,
                                          deflection);
    }
    case StrokeKind::kBezier:
      break;
  }
  // A chord over h of the parameter leaves the curve by at most h^2 / 8 of the second derivative.
  const double second =
      6 * std::max((c.p[0] - 2 * c.p[1] + c.p[2]).norm(), (c.p[1] - 2 * c.p[2] + c.p[3]).norm());
  const int least = sketch.strokes[stroke].begin == sketch.strokes[stroke].end ? 3 : 1;
  return std::clamp(int(std::ceil(std::sqrt(second / 8 / deflection))), least, 100000);
}

void write_vertex(std::ostream& out, const Eigen::Vector3d& p) {
  out << "v " << shortest(p.x()) << " " << shortest(p.y()) << " " << shortest(p.z()) << "\n";
}

// `inner`: the stroke's first vertex that is no node.
void write_segments(std::ostream& out, const Stroke& stroke, int chords, int inner) {
  const bool closed = is_closed(stroke.kind);
  const int first = closed ? inner++ : stroke.begin + 1;
  int from = first;
  for (int i = 1; i <= chords; ++i) {
    const int last = closed ? first : stroke.end + 1;
    const int to = i < chords ? inner++ : last;
    out << "l " << from << " " << to << "\n";
    from = to;
  }
}

}  // namespace

void write_obj(std::ostream& out, const Sketch& sketch, double deflection, double scale) {
  assert(deflection > 0);
  const double distance = deflection * largest_extent(sketch);
  std::vector<int> chords(sketch.size());
  out << "# sketchsplat: edges as segments\n";
  for (int i = 0; i < sketch.nodes.cols(); ++i) write_vertex(out, scale * sketch.nodes.col(i));
  for (int s = 0; s < sketch.size(); ++s) {
    chords[s] = num_chords(sketch, s, distance);
    Eigen::Vector3d p, d;
    for (int i = is_closed(sketch.strokes[s].kind) ? 0 : 1; i < chords[s]; ++i) {
      evaluate_stroke(sketch, s, double(i) / chords[s], &p, &d);
      write_vertex(out, scale * p);
    }
  }
  std::vector<int> inner;  // first vertex of every stroke that is no node; OBJ counts from 1
  int next = int(sketch.nodes.cols()) + 1;
  for (int s = 0; s < sketch.size(); ++s) {
    inner.push_back(next);
    next += chords[s] - (is_closed(sketch.strokes[s].kind) ? 0 : 1);
  }
  const std::vector<CurveChain> chains = curve_chains(sketch);
  for (size_t c = 0; c < chains.size(); ++c) {
    out << "o " << kind_name(sketch.strokes[chains[c].strokes[0]].kind) << "_" << c << "\n";
    for (int s : chains[c].strokes) write_segments(out, sketch.strokes[s], chords[s], inner[s]);
  }
}

}  // namespace sketchsplat
