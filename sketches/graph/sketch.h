// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace sketchsplat {

// clang-format off
/// Kinds of curve and the columns of control points that define them:
///   line          begin, end
///   arc           begin, apex, end           circular, < 360 deg; of apex only what is square to
///                                            the chord counts
///   circle        centre, axis               closed; axis = unit normal times radius
///   ellipse       centre, u, v               closed; centre + cos u + sin v
///   bezier        begin, h0, h1, end         cubic
///   elliptic_arc  begin, apex, quarter, end  < 360 deg; of quarter only what is along apex
///                                            - middle of the chord counts; see EllipticFrame
// clang-format on
enum class StrokeKind { kLine, kArc, kCircle, kEllipse, kBezier, kEllipticArc };
constexpr int kNumKinds = 6;

constexpr int num_handles(StrokeKind kind) {
  return kind == StrokeKind::kLine      ? 0
         : kind == StrokeKind::kArc     ? 1
         : kind == StrokeKind::kEllipse ? 3
                                        : 2;
}
constexpr bool is_closed(StrokeKind kind) {
  return kind == StrokeKind::kCircle || kind == StrokeKind::kEllipse;
}
/// Control points, ends included.
constexpr int num_controls(StrokeKind kind) {
  return num_handles(kind) + (is_closed(kind) ? 0 : 2);
}
const char* kind_name(StrokeKind kind);                      ///< "line", "arc", ...
bool parse_kind(const std::string& name, StrokeKind* kind);  ///< false if there is no such kind

struct Stroke {
  StrokeKind kind = StrokeKind::kLine;
  int begin = -1;  ///< column of Sketch::nodes; -1 if closed
  int end = -1;    ///< column of Sketch::nodes; -1 if closed
  int handle =
      -1;  ///< first of num_handles(kind) consecutive columns of Sketch::handles; -1 if none
};

/// Of an open stroke that ends in this node.
inline int other_end(const Stroke& stroke, int node) {
  return stroke.begin == node ? stroke.end : stroke.begin;
}

/// What the images say about a stroke. Filled by the pipeline; zeros if nobody looked.
struct Evidence {
  double opacity = 1.0;   ///< share of its visible length that lies on edges, in [0, 1]
  int support_views = 0;  ///< views that see it
  double rms_px = 0;      ///< root mean square distance to the edgels that it explains
  /// Largest standard deviation of a point of it, across it, world units.
  double sigma = 0;
  /// Probability that it is an edge of the object, in [0, 1]; NaN if unknown.
  double confidence = std::numeric_limits<double>::quiet_NaN();
  std::vector<int> views = {};  ///< that see it, ascending: indices into a list kept elsewhere
  /// Upper triangle of the covariance of its control points, and how many directions of it the
  /// images determine, see sketches/solve/covariance.h. Empty if unknown.
  std::vector<double> covariance = {};
  int determined = 0;
  /// [px] by which its views disagree: median over them of the middle distance to their edgels.
  double bias_px = 0;
};

/// Curves over shared nodes: strokes that meet hold the same column of `nodes`. World units.
struct Sketch {
  Eigen::Matrix3Xd nodes;    ///< 3 x N end points
  Eigen::Matrix3Xd handles;  ///< 3 x M inner control points
  std::vector<Stroke> strokes;
  std::vector<Evidence> evidence;  ///< one per stroke

  int size() const { return int(strokes.size()); }

  int add_node(const Eigen::Vector3d& p);
  /// Appends a stroke and its handles (as many as the kind has); returns its index.
  int add_stroke(StrokeKind kind, int begin, int end, const std::vector<Eigen::Vector3d>& handles,
                 const Evidence& evidence = {});
};

/// Appends the strokes of another sketch, with nodes of their own.
void append_strokes(const Sketch& more, Sketch* sketch);

/// Control points of a stroke in the order of StrokeKind: at most four.
struct ControlPoints {
  std::array<Eigen::Vector3d, 4> p;
  int count = 0;
};
ControlPoints control_points(const Sketch& sketch, int stroke);
/// The sketch with these control points, one set per stroke: strokes that share a node meet
/// half-way between where they would end.
Sketch with_control_points(const Sketch& sketch, const std::vector<ControlPoints>& controls);

/// Of every node, how many ends of strokes lie in it.
std::vector<int> node_degrees(const Sketch& sketch);

/// Removes strokes marked false, and the nodes and handles that nobody uses then.
Sketch keep_strokes(const Sketch& sketch, const std::vector<bool>& keep);

/// Every broken invariant as one sentence (index out of range, NaN, unused column, zero length,
/// evidence of another size); empty if the sketch is sound.
std::vector<std::string> validate(const Sketch& sketch);

}  // namespace sketchsplat
