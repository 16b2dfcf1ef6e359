// SPDX-License-Identifier: MIT
#include "sketches/curve/curve_chain.h"

#include <algorithm>
#include <cmath>

#include "sketches/curve/curve.h"
#include "sketches/graph/smooth_joint.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

double radians(double degrees) { return degrees * M_PI / 180; }

// Between cubics alone.
std::vector<SmoothJoint> cubic_joints(const Sketch& sketch, double within_deg) {
  std::vector<SmoothJoint> joints = find_smooth_joints(sketch, radians(within_deg));
  joints.erase(std::remove_if(joints.begin(), joints.end(),
                              [](const SmoothJoint& j) {
                                return j.before.is_node || j.after.is_node;
                              }),
               joints.end());
  return joints;
}

// Follows curves from stroke to stroke.
struct Walker {
  const Sketch& sketch;
  std::vector<const SmoothJoint*> joint;  // by node; null where curves end
  std::vector<bool> done;

  // Out of a stroke's end (or begin) as far as it is smooth; the strokes met, and whether they run
  // against the walk. Returns the last node.
  int follow(int stroke, bool out_of_begin, std::vector<int>* strokes, std::vector<bool>* against) {
    int node = out_of_begin ? sketch.strokes[stroke].begin : sketch.strokes[stroke].end;
    while (node >= 0 && joint[node]) {
      const SmoothJoint& j = *joint[node];
      const TangentEnd& next = j.before.stroke == stroke ? j.after : j.before;
      if (done[next.stroke]) break;  // closed
      done[next.stroke] = true;
      strokes->push_back(next.stroke);
      against->push_back(next.at_end);
      stroke = next.stroke;
      node = next.at_end ? sketch.strokes[stroke].begin : sketch.strokes[stroke].end;
    }
    return node;
  }
};

}  // namespace

void smooth_joints(Sketch* sketch, double within_deg) {
  for (const SmoothJoint& joint : cubic_joints(*sketch, within_deg)) {
    if (joint.angle < radians(kSmoothDeg / 2)) continue;
    auto a = sketch->handles.col(joint.before.column), b = sketch->handles.col(joint.after.column);
    const Vector3d node = sketch->nodes.col(joint.node), u = a - node, v = b - node;
    // Moving a leg of length l by an angle moves its handle by l times the angle.
    const Vector3d along = (u.norm() * u - v.norm() * v).normalized();
    a = node + u.norm() * along;
    b = node - v.norm() * along;
  }
}

std::vector<CurveChain> curve_chains(const Sketch& sketch, const std::vector<bool>& alone) {
  const std::vector<SmoothJoint> joints = cubic_joints(sketch, kSmoothDeg);
  Walker walker{sketch, std::vector<const SmoothJoint*>(sketch.nodes.cols()),
                std::vector<bool>(sketch.size())};
  for (const SmoothJoint& j : joints)
    if (alone.empty() || !(alone[j.before.stroke] || alone[j.after.stroke]))
      walker.joint[j.node] = &j;
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
  double total = 0, opacity = 0, squares = 0, bias = 0;
  for (int s : chain.strokes) {
    const Evidence& e = sketch.evidence[s];
    const double length = stroke_length(sketch, s);
    total += length;
    opacity += length * e.opacity;
    squares += length * e.rms_px * e.rms_px;
    bias += length * e.bias_px;
    out.support_views = std::min(out.support_views, e.support_views);
    out.sigma = std::max(out.sigma, e.sigma);
    out.views.insert(out.views.end(), e.views.begin(), e.views.end());
    if (std::isnan(e.confidence) || e.confidence < out.confidence) out.confidence = e.confidence;
  }
  std::sort(out.views.begin(), out.views.end());
  out.views.erase(std::unique(out.views.begin(), out.views.end()), out.views.end());
  if (!out.views.empty()) out.support_views = int(out.views.size());
  out.covariance.clear(), out.determined = 0;
  if (total > 0) {
    out.opacity = opacity / total;
    out.rms_px = std::sqrt(squares / total);
    out.bias_px = bias / total;
  }
  return out;
}

}  // namespace sketchsplat
