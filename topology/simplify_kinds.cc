// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <algorithm>
#include <optional>

#include "topology/draft.h"
#include "topology/passes.h"
#include "topology/refit.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

Run points_of(const CurveSamples& samples) { return {samples.position, samples.weight}; }

// Both curves keep within the tolerance of each other and are about as long.
bool are_close(const PlainCurve& a, const CurveSamples& sa, const PlainCurve& b, double tolerance) {
  const CurveSamples sb = sample_curve(b);
  return std::abs(sa.length - sb.length) <= 0.1 * sa.length + tolerance &&
         max_distance(b, sa.position) <= tolerance && max_distance(a, sb.position) <= tolerance;
}

// Line between the ends, unless the curve leaves it or turns back on the way.
std::optional<PlainCurve> as_line(const PlainCurve& curve, const CurveSamples& samples,
                                  double tolerance) {
  PlainCurve line;
  line.p[0] = curve.begin();
  line.p[1] = curve.end();
  if (!is_sound(line)) return std::nullopt;
  const Vector3d chord = line.p[1] - line.p[0];
  if ((chord.transpose() * samples.tangent).minCoeff() < 0) return std::nullopt;
  if (!(max_distance(line, samples.position) <= tolerance)) return std::nullopt;
  return line;
}

// Circle of an open curve that all but closes.
std::optional<PlainCurve> as_circle(const Piece& piece, double closing, double tolerance) {
  const double gap = (piece.curve.end() - piece.curve.begin()).norm();
  if (gap > closing || 3 * gap > piece.samples.length) return std::nullopt;
  if (piece.curve.kind == StrokeKind::kArc) {
    const PlainCurve circle = circle_of_arc(piece.curve);
    const double missing = 2 * M_PI * circle.p[1].norm() - piece.samples.length;
    return missing <= closing ? std::optional<PlainCurve>(circle) : std::nullopt;
  }
  const auto circle = refit_circle(points_of(piece.samples));
  if (!circle) return std::nullopt;
  if (max_distance(*circle, piece.samples.position) > tolerance) return std::nullopt;
  // The way round must be made once: neither to and fro nor twice.
  const double around = 2 * M_PI * circle->p[1].norm();
  if (std::abs(around - gap - piece.samples.length) > 0.1 * around) return std::nullopt;
  if (max_distance(piece.curve, sample_curve(*circle).position) > gap + tolerance)
    return std::nullopt;
  return circle;
}

std::optional<PlainCurve> ellipse_as_circle(const PlainCurve& curve, double tolerance) {
  const PlainCurve e = with_principal_axes(curve);
  const double a = e.p[1].norm(), b = e.p[2].norm();
  if (!(b > 0) || !((a - b) / 2 <= tolerance) || !(2 * b > a)) return std::nullopt;
  PlainCurve circle;
  circle.kind = StrokeKind::kCircle;
  circle.p[0] = e.p[0];
  circle.p[1] = e.p[1].cross(e.p[2]).normalized() * ((a + b) / 2);
  return circle;
}

std::optional<PlainCurve> simpler(const Piece& piece, bool ends_are_free,
                                  const TopologyOptions& options) {
  const StrokeKind kind = piece.curve.kind;
  const double tolerance = options.kind_px * options.footprint;
  if (kind == StrokeKind::kEllipse) return ellipse_as_circle(piece.curve, tolerance);
  if (kind == StrokeKind::kLine || kind == StrokeKind::kCircle) return std::nullopt;
  if (auto line = as_line(piece.curve, piece.samples, tolerance)) return line;
  const double closing = ends_are_free ? options.gap_px : options.endpoint_px;
  if (auto circle = as_circle(piece, closing * options.footprint, tolerance)) return circle;
  if (kind == StrokeKind::kArc) return std::nullopt;
  const auto arc = refit_arc_between(points_of(piece.samples));
  if (arc && are_close(piece.curve, piece.samples, *arc, tolerance)) return arc;
  return std::nullopt;
}

}  // namespace

PassResult simplify_kinds(const Sketch& sketch, const TopologyOptions& options) {
  Draft draft(sketch);
  for (int i = 0; i < draft.size(); ++i) {
    // At most cubic or elliptic arc -> arc -> circle.
    while (draft.pieces[i].alive) {
      const Piece& piece = draft.pieces[i];
      bool free = true;
      if (!piece.curve.closed()) {
        const std::vector<int> degrees = draft.degrees();
        const int own = piece.begin == piece.end ? 2 : 1;
        free = degrees[piece.begin] == own && degrees[piece.end] == own;
      }
      const auto curve = simpler(piece, free, options);
      if (!curve) break;
      const bool closed = curve->closed();
      draft.replace(i, *curve, closed ? -1 : piece.begin, closed ? -1 : piece.end);
      ++draft.changes;
    }
  }
  return draft.finish();
}

}  // namespace sketchsplat
