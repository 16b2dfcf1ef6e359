// SPDX-License-Identifier: MIT
#include "sketches/graph/sketch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

namespace sketchsplat {
namespace {

constexpr const char* kNames[kNumKinds] = {"line",    "arc",    "circle",
                                           "ellipse", "bezier", "elliptic_arc"};

void append_column(Eigen::Matrix3Xd* m, const Eigen::Vector3d& p) {
  m->conservativeResize(Eigen::NoChange, m->cols() + 1);
  m->col(m->cols() - 1) = p;
}

// Sine between the axes of an ellipse, 1 for a circle; 0 if there is no axis, NaN if not finite.
double axes_sine(const Sketch& sketch, const Stroke& s) {
  const Eigen::Vector3d u = sketch.handles.col(s.handle + 1);
  if (s.kind == StrokeKind::kCircle) return u.stableNormalized().norm();
  return u.stableNormalized().cross(sketch.handles.col(s.handle + 2).stableNormalized()).norm();
}

// Chord of a line or an arc of either kind (it closes up without one); of a cubic, that of its
// control polygon.
double extent(const Sketch& sketch, int stroke) {
  const ControlPoints c = control_points(sketch, stroke);
  double largest = (c.p[c.count - 1] - c.p[0]).norm();
  if (sketch.strokes[stroke].kind == StrokeKind::kBezier)
    largest += (c.p[1] - c.p[0]).norm() + (c.p[2] - c.p[0]).norm();
  return largest;
}

}  // namespace

const char* kind_name(StrokeKind kind) { return kNames[int(kind)]; }

bool parse_kind(const std::string& name, StrokeKind* kind) {
  for (int i = 0; i < kNumKinds; ++i)
    if (name == kNames[i]) {
      *kind = StrokeKind(i);
      return true;
    }
  return false;
}

int Sketch::add_node(const Eigen::Vector3d& p) {
  append_column(&nodes, p);
  return int(nodes.cols()) - 1;
}

int Sketch::add_stroke(StrokeKind kind, int begin, int end,
                       const std::vector<Eigen::Vector3d>& new_handles, const Evidence& e) {
  assert(int(new_handles.size()) == num_handles(kind));
  Stroke s{kind, begin, end, new_handles.empty() ? -1 : int(handles.cols())};
  for (const auto& h : new_handles) append_column(&handles, h);
  strokes.push_back(s);
  evidence.push_back(e);
  return size() - 1;
}

void append_strokes(const Sketch& more, Sketch* sketch) {
  const auto append = [](const Eigen::Matrix3Xd& from, Eigen::Matrix3Xd* to) {
    to->conservativeResize(3, to->cols() + from.cols());
    to->rightCols(from.cols()) = from;
  };
  const int nodes = int(sketch->nodes.cols()), handles = int(sketch->handles.cols());
  append(more.nodes, &sketch->nodes);
  append(more.handles, &sketch->handles);
  for (Stroke s : more.strokes) {
    if (!is_closed(s.kind)) s.begin += nodes, s.end += nodes;
    if (num_handles(s.kind) > 0) s.handle += handles;
    sketch->strokes.push_back(s);
  }
  sketch->evidence.insert(sketch->evidence.end(), more.evidence.begin(), more.evidence.end());
}

ControlPoints control_points(const Sketch& sketch, int stroke) {
  const Stroke& s = sketch.strokes[stroke];
  ControlPoints c;
  if (!is_closed(s.kind)) c.p[c.count++] = sketch.nodes.col(s.begin);
  for (int h = 0; h < num_handles(s.kind); ++h) c.p[c.count++] = sketch.handles.col(s.handle + h);
  if (!is_closed(s.kind)) c.p[c.count++] = sketch.nodes.col(s.end);
  return c;
}

Sketch with_control_points(const Sketch& sketch, const std::vector<ControlPoints>& controls) {
  Sketch out = sketch;
  std::vector<int> ends(sketch.nodes.cols());
  out.nodes.setZero();
  const auto add = [&](int node, const Eigen::Vector3d& place) {
    out.nodes.col(node) += place;
    ++ends[node];
  };
  for (int s = 0; s < sketch.size(); ++s) {
    const Stroke& stroke = sketch.strokes[s];
    const ControlPoints& c = controls[s];
    const bool closed = is_closed(stroke.kind);
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      out.handles.col(stroke.handle + h) = c.p[h + !closed];
    if (!closed) add(stroke.begin, c.p[0]), add(stroke.end, c.p[c.count - 1]);
  }
  for (int n = 0; n < int(ends.size()); ++n)
    out.nodes.col(n) = ends[n] ? Eigen::Vector3d(out.nodes.col(n) / ends[n])
                               : Eigen::Vector3d(sketch.nodes.col(n));
  return out;
}

std::vector<int> node_degrees(const Sketch& sketch) {
  std::vector<int> degree(sketch.nodes.cols());
  for (const Stroke& s : sketch.strokes)
    if (!is_closed(s.kind)) ++degree[s.begin], ++degree[s.end];
  return degree;
}

Sketch keep_strokes(const Sketch& sketch, const std::vector<bool>& keep) {
  Sketch out;
  std::vector<int> node(sketch.nodes.cols(), -1);
  const auto renumber = [&](int old) {
    if (old < 0) return -1;
    if (node[old] < 0) node[old] = out.add_node(sketch.nodes.col(old));
    return node[old];
  };
  for (int i = 0; i < sketch.size(); ++i) {
    if (!keep[i]) continue;
    const Stroke& s = sketch.strokes[i];
    std::vector<Eigen::Vector3d> handles;
    for (int h = 0; h < num_handles(s.kind); ++h)
      handles.push_back(sketch.handles.col(s.handle + h));
    const int begin = renumber(s.begin), end = renumber(s.end);
    out.add_stroke(s.kind, begin, end, handles, sketch.evidence[i]);
  }
  return out;
}

std::vector<std::string> validate(const Sketch& sketch) {
  std::vector<std::string> complaints;
  const auto complain = [&](int i, const std::string& what) {
    complaints.push_back("stroke " + std::to_string(i) + ": " + what);
  };
  if (!sketch.nodes.allFinite()) complaints.push_back("a node is not finite");
  if (!sketch.handles.allFinite()) complaints.push_back("a handle is not finite");
  if (sketch.evidence.size() != sketch.strokes.size())
    complaints.push_back("evidence has " + std::to_string(sketch.evidence.size()) +
                         " entries for " + std::to_string(sketch.strokes.size()) + " strokes");
  for (size_t i = 0; i < sketch.evidence.size(); ++i) {
    const Evidence& e = sketch.evidence[i];
    if (!(e.opacity >= 0 && e.opacity <= 1)) complain(int(i), "has an opacity outside [0, 1]");
    if (e.confidence < 0 || e.confidence > 1) complain(int(i), "has a confidence outside [0, 1]");
    if (e.support_views < 0 || !std::isfinite(e.rms_px) || !std::isfinite(e.sigma) ||
        !std::isfinite(e.bias_px) || e.rms_px < 0 || e.sigma < 0 || e.bias_px < 0)
      complain(int(i), "has negative or infinite evidence");
    if (!e.views.empty() && e.views[0] < 0) complain(int(i), "is seen by a view below 0");
    if (!std::is_sorted(e.views.begin(), e.views.end(), std::less_equal<int>()))
      complain(int(i), "lists its views out of order");
    const size_t n = i < sketch.strokes.size() ? 3 * num_controls(sketch.strokes[i].kind) : 0;
    if (!e.covariance.empty() && e.covariance.size() != n * (n + 1) / 2)
      complain(int(i), "has a covariance of another size");
    for (double c : e.covariance)
      if (!std::isfinite(c)) {
        complain(int(i), "has an infinite covariance");
        break;
      }
    if (e.determined < 0 || e.determined > int(n)) complain(int(i), "determines too much");
  }
  const auto in_range = [&](int node) { return node >= 0 && node < sketch.nodes.cols(); };
  std::vector<bool> node_used(sketch.nodes.cols()), handle_used(sketch.handles.cols());
  for (int i = 0; i < sketch.size(); ++i) {
    const Stroke& s = sketch.strokes[i];
    const int nh = num_handles(s.kind);
    if (nh > 0) {
      if (s.handle < 0 || s.handle + nh > sketch.handles.cols()) {
        complain(i, "handle index out of range");
        if (in_range(s.begin) && in_range(s.end)) node_used[s.begin] = node_used[s.end] = true;
        continue;
      }
      for (int h = 0; h < nh; ++h) {
        if (handle_used[s.handle + h]) complain(i, "shares a handle with another stroke");
        handle_used[s.handle + h] = true;
      }
    }
    if (is_closed(s.kind)) {
      if (s.begin >= 0 || s.end >= 0) complain(i, "a closed curve has end nodes");
      if (!(axes_sine(sketch, s) > 1e-9)) complain(i, "has no extent");
      continue;
    }
    if (!in_range(s.begin) || !in_range(s.end)) {
      complain(i, "node index out of range");
      continue;
    }
    node_used[s.begin] = node_used[s.end] = true;
    if (!(extent(sketch, i) > 0)) complain(i, "has zero length");
  }
  for (size_t n = 0; n < node_used.size(); ++n)
    if (!node_used[n]) complaints.push_back("node " + std::to_string(n) + " belongs to no stroke");
  for (size_t n = 0; n < handle_used.size(); ++n)
    if (!handle_used[n])
      complaints.push_back("handle " + std::to_string(n) + " belongs to no stroke");
  return complaints;
}

}  // namespace sketchsplat
