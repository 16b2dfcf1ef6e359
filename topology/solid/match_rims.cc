// SPDX-License-Identifier: MIT
#include "topology/solid/match_rims.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "datasets/types/dense.h"
#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kPlaces = 24;  // of a stroke

bool is_free(StrokeKind kind) {
  return kind == StrokeKind::kEllipse || kind == StrokeKind::kEllipticArc ||
         kind == StrokeKind::kBezier;
}

// Free strokes end to end, in a plane.
struct Chain {
  Loop strokes;
  std::vector<int> nodes;   // one more than strokes; none if it is an ellipse
  std::vector<int> beyond;  // strokes that go on smoothly from its ends
  Matrix3Xd places;
  Vector3d centre, normal;
};

class Matcher {
 public:
  Matcher(const Sketch& sketch, double tolerance)
      : sketch_(sketch), tolerance_(tolerance), ends_(sketch.nodes.cols()) {
    for (int s = 0; s < sketch.size(); ++s)
      if (!is_closed(sketch.strokes[s].kind))
        for (const int node : {sketch.strokes[s].begin, sketch.strokes[s].end})
          ends_[node].push_back(s);
    find_chains();
  }

  MatchedRims match() {
    std::vector<bool> done(chains_.size()), keep(sketch_.size(), true);
    std::vector<std::pair<int, int>> pairs;
    for (size_t i = 0; i < chains_.size(); ++i)
      for (size_t k = 0; k < chains_.size() && !done[i]; ++k) {
        if (i == k || done[k] || !lies_over(chains_[i], chains_[k])) continue;
        done[i] = done[k] = true;
        pairs.emplace_back(i, k);
        for (const LoopStroke& s : chains_[k].strokes) keep[s.stroke] = false;
      }
    out_.sketch = sketch_;
    out_.now.resize(sketch_.size());
    for (int s = 0; s < sketch_.size(); ++s) out_.now[s] = {s};
    for (const auto& [from, to] : pairs) copy(chains_[from], chains_[to]);
    keep.resize(out_.sketch.size(), true);
    drop(keep);
    return std::move(out_);
  }

 private:
  // The free stroke that goes on where this one ends, if nothing else does.
  int next(int stroke, int node) const {
    if (ends_[node].size() != 2) return -1;
    const int other = ends_[node][0] == stroke ? ends_[node][1] : ends_[node][0];
    return other != stroke && is_free(sketch_.strokes[other].kind) ? other : -1;
  }

  void find_chains() {
    std::vector<bool> done(sketch_.size());
    for (int s = 0; s < sketch_.size(); ++s) {
      if (done[s] || !is_free(sketch_.strokes[s].kind)) continue;
      Chain chain;
      if (is_closed(sketch_.strokes[s].kind)) {
        chain.strokes = {{s, true}};
        done[s] = true;
      } else {
        follow(s, &done, &chain);
        add_beyond(chain.strokes.front().stroke, chain.nodes.front(), &chain);
        add_beyond(chain.strokes.back().stroke, chain.nodes.back(), &chain);
      }
      if (measure(&chain)) chains_.push_back(std::move(chain));
    }
  }

  // Back to where the chain begins, and from there along it.
  void follow(int start, std::vector<bool>* done, Chain* chain) const {
    int stroke = start, node = sketch_.strokes[start].begin;
    for (int back = next(stroke, node); back >= 0 && back != start; back = next(stroke, node)) {
      node = other_end(sketch_.strokes[back], node);
      stroke = back;
    }
    chain->nodes = {node};
    while (stroke >= 0 && !(*done)[stroke]) {
      (*done)[stroke] = true;
      chain->strokes.push_back({stroke, sketch_.strokes[stroke].begin == node});
      node = other_end(sketch_.strokes[stroke], node);
      chain->nodes.push_back(node);
      stroke = next(stroke, node);
    }
  }
  void add_beyond(int own, int node, Chain* chain) const {
    const Vector3d out = tangent_out(sketch_, own, node);
    for (const int s : ends_[node])
      if (s != own && out.dot(tangent_out(sketch_, s, node)) < -kSmooth) chain->beyond.push_back(s);
  }

  bool measure(Chain* chain) const {
    chain->places.resize(3, chain->strokes.size() * kPlaces);
    Vector3d p, d;
    int column = 0;
    for (const LoopStroke& s : chain->strokes)
      for (int i = 0; i < kPlaces; ++i) {
        const double t = i / (kPlaces - 1.0);
        evaluate_stroke(sketch_, s.stroke, s.forward ? t : 1 - t, &p, &d);
        chain->places.col(column++) = p;
      }
    chain->centre = chain->places.rowwise().mean();
    const Matrix3Xd off = chain->places.colwise() - chain->centre;
    const auto spread = eigen_symmetric(off * off.transpose());
    chain->normal = spread.vectors.col(0);
    // A line has no plane, and what is in none is no outline.
    return spread.values[1] > off.cols() * tolerance_ * tolerance_ &&
           (chain->normal.transpose() * off).cwiseAbs().maxCoeff() <= tolerance_;
  }

  Vector3d rise(const Chain& a, const Chain& b) const {
    return a.normal * a.normal.dot(b.centre - a.centre);
  }

  // Are they the same but for a move along the normal, the one's ends near the other's?
  bool lies_over(const Chain& a, const Chain& b) const {
    const Vector3d up = rise(a, b);
    if (std::abs(a.normal.dot(b.normal)) < 0.999 || up.norm() <= 4 * tolerance_) return false;
    if (a.nodes.empty() != b.nodes.empty() || b.strokes.size() < a.strokes.size()) return false;
    const auto near = [&](const Chain& on, const Vector3d& p) {
      for (const int end : on.nodes)
        if ((end == on.nodes.front() || end == on.nodes.back()) &&
            (sketch_.nodes.col(end) - p).norm() <= kEnds * tolerance_)
          return true;
      return is_beyond(on, p) ||
             std::any_of(on.strokes.begin(), on.strokes.end(),
                         [&](const LoopStroke& s) { return touches(s.stroke, p); });
    };
    for (int i = 0; i < b.places.cols(); ++i)
      if (!near(a, b.places.col(i) - up)) return false;
    for (int i = 0; i < a.places.cols(); ++i)
      if (!near(b, a.places.col(i) + up)) return false;
    return a.nodes.empty() || ends_meet(a, b) || ends_meet(a, turned(b));
  }
  bool touches(int stroke, const Vector3d& p) const {
    return distance_to_stroke(sketch_, stroke, p).distance <= kSlack * tolerance_;
  }
  // How far a smooth outline goes as this curve, nobody sees.
  bool is_beyond(const Chain& chain, const Vector3d& p) const {
    return std::any_of(chain.beyond.begin(), chain.beyond.end(),
                       [&](int s) { return touches(s, p); });
  }
  bool ends_meet(const Chain& a, const Chain& b) const {
    const Vector3d up = rise(a, b);
    const double least = (a.places.leftCols(1) - a.places.rightCols(1)).norm() / 2;
    const auto meet = [&](int p, int q) {
      const Vector3d over = sketch_.nodes.col(p) + up, under = sketch_.nodes.col(q) - up;
      const double off = (over - sketch_.nodes.col(q)).norm();
      return off <= kEnds * tolerance_ ||
             (off < least && (is_beyond(b, over) || is_beyond(a, under)));
    };
    return meet(a.nodes.front(), b.nodes.front()) && meet(a.nodes.back(), b.nodes.back());
  }
  static Chain turned(Chain chain) {
    std::reverse(chain.strokes.begin(), chain.strokes.end());
    std::reverse(chain.nodes.begin(), chain.nodes.end());
    return chain;
  }

  // Puts copies of one chain in the place of another one.
  void copy(const Chain& a, const Chain& from) {
    const Chain b = a.nodes.empty() || ends_meet(a, from) ? from : turned(from);
    const Vector3d up = rise(a, b);
    Sketch& sketch = out_.sketch;
    std::vector<int> nodes;
    for (size_t i = 0; i < a.nodes.size(); ++i) {
      const Vector3d p = sketch.nodes.col(a.nodes[i]) + up;
      const bool inner = i > 0 && i + 1 < a.nodes.size();
      nodes.push_back(inner ? -1 : (i == 0 ? b.nodes.front() : b.nodes.back()));
      if (i + 1 == a.nodes.size() && a.nodes.back() == a.nodes.front()) nodes.back() = nodes[0];
      if (inner) nodes.back() = sketch.add_node(p);
      sketch.nodes.col(nodes.back()) = p;
      if (i == 0 || nodes.back() != nodes.front()) add_ruling(a, i, nodes.back());
    }
    std::vector<int> copies;
    for (size_t i = 0; i < a.strokes.size(); ++i) {
      const int s = a.strokes[i].stroke;
      const StrokeKind kind = sketch.strokes[s].kind;
      std::vector<Vector3d> handles;
      for (int k = 0; k < num_handles(kind); ++k) {
        const bool moves = !(is_closed(kind) && k > 0);  // axes do not
        handles.push_back(sketch.handles.col(sketch.strokes[s].handle + k) + moves * up);
      }
      int ends[2] = {-1, -1};
      if (!is_closed(kind)) ends[0] = nodes[i], ends[1] = nodes[i + 1];
      if (!a.strokes[i].forward) std::swap(ends[0], ends[1]);
      copies.push_back(
          sketch.add_stroke(kind, ends[0], ends[1], handles, sketch.evidence[b.strokes[0].stroke]));
      add_extrusion(s, a.normal);
    }
    for (const LoopStroke& s : b.strokes) out_.now[s.stroke] = copies;
  }

  // Smooth where the outline runs on without a corner.
  void add_ruling(const Chain& a, size_t i, int other) {
    const int node = a.nodes[i];
    for (const int s : ends_[node])
      if (other_end(sketch_.strokes[s], node) == other) return;
    const int own = a.strokes[i == 0 ? 0 : i - 1].stroke;
    const Vector3d out = tangent_out(sketch_, own, node);
    const bool smooth = std::any_of(ends_[node].begin(), ends_[node].end(), [&](int s) {
      return s != own && out.dot(tangent_out(sketch_, s, node)) < -kSmooth;
    });
    out_.rulings.push_back({StrokeKind::kLine, node, other, {}, smooth});
  }

  void add_extrusion(int stroke, const Vector3d& axis) {
    Surface s;
    s.kind = SurfaceKind::kExtrusion;
    s.axis = axis;
    s.profile_kind = sketch_.strokes[stroke].kind;
    const ControlPoints c = control_points(sketch_, stroke);
    s.profile.assign(c.p.begin(), c.p.begin() + c.count);
    out_.surfaces.push_back({s, {}});
  }

  // Strokes that are not kept, and nodes that nobody uses then.
  void drop(const std::vector<bool>& keep) {
    std::vector<int> stroke(keep.size(), -1), node(out_.sketch.nodes.cols(), -1);
    int strokes = 0, nodes = 0;
    for (size_t s = 0; s < keep.size(); ++s) {
      if (!keep[s]) continue;
      stroke[s] = strokes++;
      for (const int n : {out_.sketch.strokes[s].begin, out_.sketch.strokes[s].end})
        if (n >= 0 && node[n] < 0) node[n] = nodes++;  // in the order of keep_strokes
    }
    out_.sketch = keep_strokes(out_.sketch, keep);
    for (std::vector<int>& now : out_.now)
      for (int& s : now) s = stroke[s];
    for (ImpliedStroke& r : out_.rulings) r.begin = node[r.begin], r.end = node[r.end];
  }

  static constexpr double kSlack = 1.5;    // tolerances: both rims were measured
  static constexpr double kEnds = 3;       // tolerances of ends
  static constexpr double kSmooth = 0.97;  // cosine of an angle between tangents

  const Sketch& sketch_;
  double tolerance_;
  std::vector<std::vector<int>> ends_;  // of strokes, per node
  std::vector<Chain> chains_;
  MatchedRims out_;
};

}  // namespace

MatchedRims match_rims(const Sketch& sketch, double tolerance) {
  return Matcher(sketch, tolerance).match();
}

}  // namespace sketchsplat
