// SPDX-License-Identifier: MIT
#include "sketches/sketch.h"

#include <cassert>
#include <cmath>

namespace sketchsplat {
namespace {

constexpr const char* kNames[] = {"line", "arc", "circle", "ellipse", "bezier"};

void append_column(Eigen::Matrix3Xd* m, const Eigen::Vector3d& p) {
  m->conservativeResize(Eigen::NoChange, m->cols() + 1);
  m->col(m->cols() - 1) = p;
}

}  // namespace

const char* kind_name(StrokeKind kind) { return kNames[int(kind)]; }

bool parse_kind(const std::string& name, StrokeKind* kind) {
  for (int i = 0; i < 5; ++i)
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

ControlPoints control_points(const Sketch& sketch, int stroke) {
  const Stroke& s = sketch.strokes[stroke];
  ControlPoints c;
  if (!is_closed(s.kind)) c.p[c.count++] = sketch.nodes.col(s.begin);
  for (int h = 0; h < num_handles(s.kind); ++h) c.p[c.count++] = sketch.handles.col(s.handle + h);
  if (!is_closed(s.kind)) c.p[c.count++] = sketch.nodes.col(s.end);
  return c;
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
  std::vector<bool> node_used(sketch.nodes.cols()), handle_used(sketch.handles.cols());
  for (int i = 0; i < sketch.size(); ++i) {
    const Stroke& s = sketch.strokes[i];
    const int nh = num_handles(s.kind);
    if (nh > 0) {
      if (s.handle < 0 || s.handle + nh > sketch.handles.cols()) {
        complain(i, "handle index out of range");
        continue;
      }
      for (int h = 0; h < nh; ++h) {
        if (handle_used[s.handle + h]) complain(i, "shares a handle with another stroke");
        handle_used[s.handle + h] = true;
      }
    }
    if (is_closed(s.kind)) {
      if (s.begin >= 0 || s.end >= 0) complain(i, "a closed curve has end nodes");
      if (!(sketch.handles.col(s.handle + 1).norm() > 0)) complain(i, "has no extent");
      continue;
    }
    if (s.begin < 0 || s.begin >= sketch.nodes.cols() || s.end < 0 ||
        s.end >= sketch.nodes.cols()) {
      complain(i, "node index out of range");
      continue;
    }
    node_used[s.begin] = node_used[s.end] = true;
    const double chord = (sketch.nodes.col(s.end) - sketch.nodes.col(s.begin)).norm();
    if (s.kind != StrokeKind::kBezier && !(chord > 0)) complain(i, "has zero length");
  }
  for (size_t n = 0; n < node_used.size(); ++n)
    if (!node_used[n]) complaints.push_back("node " + std::to_string(n) + " belongs to no stroke");
  for (size_t n = 0; n < handle_used.size(); ++n)
    if (!handle_used[n])
      complaints.push_back("handle " + std::to_string(n) + " belongs to no stroke");
  return complaints;
}

}  // namespace sketchsplat
