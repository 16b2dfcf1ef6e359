// SPDX-License-Identifier: MIT
#include "sketches/curve_chain.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// One of a cubic's ends.
struct CubicEnd {
  int stroke = -1;
  bool at_begin = false;
};

// Nodes where two ends of cubics meet, and nothing else does; others are empty.
std::vector<std::vector<CubicEnd>> cubic_joints(const Sketch& sketch,
                                                const std::vector<bool>& alone) {
  std::vector<std::vector<CubicEnd>> at(sketch.nodes.cols());
  std::vector<bool> taken(sketch.nodes.cols());
  for (int s = 0; s < sketch.size(); ++s) {
    const Stroke& stroke = sketch.strokes[s];
    if (is_closed(stroke.kind)) continue;
    at[stroke.begin].push_back({s, true});
    at[stroke.end].push_back({s, false});
    if (stroke.kind != StrokeKind::kBezier || (!alone.empty() && alone[s]))
      taken[stroke.begin] = taken[stroke.end] = true;
  }
  for (size_t n = 0; n < at.size(); ++n)
    if (taken[n] || at[n].size() != 2) at[n].clear();
  return at;
}

int handle_of(const Sketch& sketch, const CubicEnd& e) {
  return sketch.strokes[e.stroke].handle + (e.at_begin ? 0 : 1);
}

// From the node to the handle beside it.
Vector3d leg(const Sketch& sketch, const CubicEnd& e, int node) {
  return sketch.handles.col(handle_of(sketch, e)) - sketch.nodes.col(node);
}

// Cosine of the turn of the tangent in a joint; -1 where there is no tangent.
double turn_cosine(const Vector3d& a, const Vector3d& b) {
  const double norms = a.norm() * b.norm();
  return norms > 0 ? -a.dot(b) / norms : -1;
}

double cosine(double degrees) { return std::cos(degrees * M_PI / 180); }

struct Walker {
  const Sketch& sketch;
  std::vector<std::vector<CubicEnd>> joints;
  std::vector<bool> done;

  // Follows the curve out of a stroke's end (or begin) as far as it is smooth; the strokes met, and
  // whether they run against the walk. Returns the last node.
  int follow(int stroke, bool out_of_begin, std::vector<int>* strokes, std::vector<bool>* against) {
    const Stroke* s = &sketch.strokes[stroke];
    int node = out_of_begin ? s->begin : s->end;
    while (node >= 0 && !joints[node].empty()) {
      const std::vector<CubicEnd>& ends = joints[node];
      if (ends[0].stroke == ends[1].stroke) break;  // a loop of one stroke
      const CubicEnd& next = ends[ends[0].stroke == stroke ? 1 : 0];
      if (done[next.stroke]) break;  // closed
      done[next.stroke] = true;
      strokes->push_back(next.stroke);
      against->push_back(!next.at_begin);
      stroke = next.stroke;
      s = &sketch.strokes[stroke];
      node = next.at_begin ? s->end : s->begin;
    }
    return node;
  }
};

}  // namespace

void smooth_joints(Sketch* sketch, double within_deg) {
  const auto joints = cubic_joints(*sketch, {});
  for (int n = 0; n < int(joints.size()); ++n) {
    if (joints[n].empty()) continue;
    const CubicEnd &a = joints[n][0], &b = joints[n][1];
    const Vector3d u = leg(*sketch, a, n), v = leg(*sketch, b, n);
    const double turn = turn_cosine(u, v);
    if (turn < cosine(within_deg) || turn >= cosine(kSmoothDeg / 2)) continue;
    // Moving a leg of length l by an angle moves its handle by l times the angle.
    const Vector3d along = (u.norm() * u - v.norm() * v).normalized();
    sketch->handles.col(handle_of(*sketch, a)) = sketch->nodes.col(n) + u.norm() * along;
    sketch->handles.col(handle_of(*sketch, b)) = sketch->nodes.col(n) - v.norm() * along;
  }
}

std::vector<CurveChain> curve_chains(const Sketch& sketch, const std::vector<bool>& alone) {
  Walker walker{sketch, cubic_joints(sketch, alone), std::vector<bool>(sketch.size())};
  for (int n = 0; n < int(walker.joints.size()); ++n) {
    std::vector<CubicEnd>& ends = walker.joints[n];
    if (!ends.empty() &&
        turn_cosine(leg(sketch, ends[0], n), leg(sketch, ends[1], n)) < cosine(kSmoothDeg))
      ends.clear();
  }
  std::vector<CurveChain> out;
  for (int s = 0; s < sketch.size(); ++s) {
    if (walker.done[s]) continue;
    walker.done[s] = true;
    CurveChain chain;
    chain.begin = walker.follow(s, true, &chain.strokes, &chain.reversed);
    std::reverse(chain.strokes.begin(), chain.strokes.end());
    std::reverse(chain.reversed.begin(), chain.reversed.end());
    chain.reversed.flip();
    chain.strokes.push_back(s);
    chain.reversed.push_back(false);
    chain.end = walker.follow(s, false, &chain.strokes, &chain.reversed);
    out.push_back(std::move(chain));
  }
  return out;
}

Eigen::Matrix3Xd chain_points(const Sketch& sketch, const CurveChain& chain) {
  Eigen::Matrix3Xd points(3, 3 * chain.strokes.size() + 1);
  for (size_t k = 0; k < chain.strokes.size(); ++k) {
    const ControlPoints c = control_points(sketch, chain.strokes[k]);
    for (int i = 0; i < 4; ++i) points.col(3 * k + i) = c.p[chain.reversed[k] ? 3 - i : i];
  }
  return points;
}

std::vector<double> span_intervals(const Eigen::Matrix3Xd& p) {
  std::vector<double> out = {1};
  for (int j = 3; j + 1 < p.cols(); j += 3)
    out.push_back(out.back() * (p.col(j + 1) - p.col(j)).norm() / (p.col(j) - p.col(j - 1)).norm());
  return out;
}

Spline chain_spline(const Sketch& sketch, const CurveChain& chain) {
  const Eigen::Matrix3Xd p = chain_points(sketch, chain);
  const int n = int(chain.strokes.size());
  Spline out;
  out.points.resize(3, 2 * n + 2);
  out.points.leftCols<2>() = p.leftCols<2>();
  for (int k = 0; k < n; ++k) out.points.col(2 * k + 2) = p.col(3 * k + 2);
  for (int k = 1; k < n; ++k) out.points.col(2 * k + 1) = p.col(3 * k + 1);
  out.points.rightCols<1>() = p.rightCols<1>();
  out.breaks = {0};
  for (double h : span_intervals(p)) out.breaks.push_back(out.breaks.back() + h);
  const double total = out.breaks.back();
  for (double& b : out.breaks) b /= total;
  out.breaks.back() = 1;
  return out;
}

std::vector<int> chain_of_strokes(const std::vector<CurveChain>& chains, int strokes) {
  std::vector<int> out(strokes, -1);
  for (size_t c = 0; c < chains.size(); ++c)
    for (int s : chains[c].strokes) out[s] = int(c);
  return out;
}

std::vector<bool> inner_joints(const Sketch& sketch, const std::vector<CurveChain>& chains) {
  std::vector<bool> inner(sketch.nodes.cols());
  for (const CurveChain& chain : chains)
    for (size_t k = 1; k < chain.strokes.size(); ++k) {
      const Stroke& s = sketch.strokes[chain.strokes[k]];
      inner[chain.reversed[k] ? s.end : s.begin] = true;
    }
  return inner;
}

Eigen::Matrix3Xd sample_chain(const Sketch& sketch, const CurveChain& chain, double spacing) {
  Eigen::Matrix3Xd out(3, 0);
  for (size_t k = 0; k < chain.strokes.size(); ++k) {
    Eigen::Matrix3Xd piece = sample_stroke(sketch, chain.strokes[k], spacing);
    if (chain.reversed[k]) piece = piece.rowwise().reverse().eval();
    const int first = k > 0;  // a joint is in both spans
    const int n = int(out.cols());
    out.conservativeResize(3, n + piece.cols() - first);
    out.rightCols(piece.cols() - first) = piece.rightCols(piece.cols() - first);
  }
  return out;
}

Evidence chain_evidence(const Sketch& sketch, const CurveChain& chain) {
  Evidence out = sketch.evidence[chain.strokes[0]];
  if (chain.strokes.size() == 1) return out;
  double total = 0, opacity = 0, squares = 0;
  for (int s : chain.strokes) {
    const Evidence& e = sketch.evidence[s];
    const double length = stroke_length(sketch, s);
    total += length;
    opacity += length * e.opacity;
    squares += length * e.rms_px * e.rms_px;
    out.support_views = std::min(out.support_views, e.support_views);
    out.sigma = std::max(out.sigma, e.sigma);
    out.views.insert(out.views.end(), e.views.begin(), e.views.end());
    if (std::isnan(e.confidence) || e.confidence < out.confidence) out.confidence = e.confidence;
  }
  std::sort(out.views.begin(), out.views.end());
  out.views.erase(std::unique(out.views.begin(), out.views.end()), out.views.end());
  if (!out.views.empty()) out.support_views = int(out.views.size());
  out.covariance.clear(), out.determined = 0;
  if (total > 0) out.opacity = opacity / total, out.rms_px = std::sqrt(squares / total);
  return out;
}

}  // namespace sketchsplat
