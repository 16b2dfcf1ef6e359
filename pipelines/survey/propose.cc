// SPDX-License-Identifier: MIT
#include "pipelines/survey/propose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// Guesses, deliberately low: that one face, or several, ask for the edge.
constexpr double kOneFace = 0.2, kMoreFaces = 0.3;

// An edge that is implied: from a node to a node, or to a place where there is none.
struct Implied {
  int from, to;  // `to` is -1 - index of a corner that nobody sees
  int faces = 0;
};

class Proposer {
 public:
  Proposer(const Sketch& sketch, const EdgeWorld& world, const ProposeOptions& options)
      : s_(sketch),
        world_(world),
        options_(options),
        lines_(sketch.nodes.cols()),
        degree_(node_degrees(sketch)) {
    for (const Stroke& stroke : s_.strokes) {
      if (stroke.kind != StrokeKind::kLine) continue;
      lines_[stroke.begin].push_back(stroke.end);
      lines_[stroke.end].push_back(stroke.begin);
    }
  }

  Sketch run() {
    find_sides();
    find_corners();
    return drawn();
  }

 private:
  Vector3d at(int node) const { return s_.nodes.col(node); }
  Vector3d place(int node) const { return node >= 0 ? at(node) : corners_[-1 - node]; }
  bool is_open_corner(int node) const {
    return degree_[node] == 2 && lines_[node].size() == 2 && is_corner(node);
  }
  // Two lines that go straight on are no corner.
  bool is_corner(int node) const {
    const Vector3d u = (at(lines_[node][0]) - at(node)).normalized();
    const Vector3d v = (at(lines_[node][1]) - at(node)).normalized();
    return u.cross(v).norm() > 0.2;
  }
  bool near(const Vector3d& p, const Vector3d& q, double length) const {
    return (p - q).norm() < options_.tolerance * length;
  }
  bool are_joined(int a, int b) const {
    return std::count(lines_[a].begin(), lines_[a].end(), b) > 0;
  }
  bool is_hidden(const Vector3d& a, const Vector3d& b) const;
  void imply(int from, int to);
  void find_sides();
  void find_corners();
  Sketch drawn() const;

  const Sketch& s_;
  const EdgeWorld& world_;
  const ProposeOptions& options_;
  std::vector<std::vector<int>> lines_;  // other ends of the lines of a node
  std::vector<int> degree_;
  std::vector<Vector3d> corners_;
  std::vector<Implied> implied_;
};

// The ends, where other edges are seen, do not count.
bool Proposer::is_hidden(const Vector3d& a, const Vector3d& b) const {
  constexpr int kPlaces = 9;
  for (int k = 1; k <= kPlaces; ++k) {
    const Vector3d p = a + (b - a) * k / (kPlaces + 1.0);
    for (const View& v : world_.views)
      if (world_.hull.surely_visible(p, v.center_in_world())) return false;
  }
  return true;
}

void Proposer::imply(int from, int to) {
  for (Implied& e : implied_)
    if ((e.from == from && e.to == to) || (e.from == to && e.to == from)) {
      ++e.faces;
      return;
    }
  implied_.push_back({from, to, 1});
}

// a - b - c - d, of which a - d is missing.
void Proposer::find_sides() {
  for (int a = 0; a < s_.nodes.cols(); ++a) {
    if (!is_open_corner(a)) continue;
    for (int b : lines_[a])
      for (int c : lines_[b])
        for (int d : lines_[c]) {
          if (c == a || d == b || d <= a || !is_open_corner(d) || are_joined(a, d)) continue;
          const double length = (at(b) - at(c)).norm();
          if (near(at(a) - at(b), at(d) - at(c), length)) imply(a, d);
        }
  }
}

// Open corners a and c beside b want a corner at a + c - b; it must be wanted from two sides.
void Proposer::find_corners() {
  struct Wish {
    Vector3d place;
    int a, c;
    double size;
  };
  std::vector<Wish> wishes;
  for (int b = 0; b < s_.nodes.cols(); ++b)
    for (int a : lines_[b])
      for (int c : lines_[b]) {
        if (a >= c || !is_open_corner(a) || !is_open_corner(c)) continue;
        const double size = std::min((at(a) - at(b)).norm(), (at(c) - at(b)).norm());
        if ((at(a) - at(b)).cross(at(c) - at(b)).norm() > 0.2 * size * size)
          wishes.push_back({at(a) + at(c) - at(b), a, c, size});
      }
  std::vector<bool> used(wishes.size());
  for (size_t i = 0; i < wishes.size(); ++i) {
    if (used[i]) continue;
    std::vector<size_t> same = {i};
    for (size_t k = i + 1; k < wishes.size(); ++k)
      if (!used[k] && near(wishes[i].place, wishes[k].place, wishes[i].size)) same.push_back(k);
    if (same.size() < 2) continue;
    Vector3d mean = Vector3d::Zero();
    for (size_t k : same) used[k] = true, mean += wishes[k].place / double(same.size());
    // A node that is there already is reached by a side, not by a corner.
    bool taken = false;
    for (int n = 0; n < s_.nodes.cols(); ++n) taken |= near(at(n), mean, wishes[i].size);
    if (taken) continue;
    corners_.push_back(mean);
    for (size_t k : same)
      for (int end : {wishes[k].a, wishes[k].c}) imply(end, -int(corners_.size()));
  }
}

Sketch Proposer::drawn() const {
  Sketch out;
  std::vector<int> node(s_.nodes.cols(), -1), corner(corners_.size(), -1);
  const auto node_of = [&](int n) {
    int& index = n >= 0 ? node[n] : corner[-1 - n];
    if (index < 0) index = out.add_node(place(n));
    return index;
  };
  for (const Implied& e : implied_) {
    if (!is_hidden(place(e.from), place(e.to))) continue;
    Evidence evidence;
    evidence.opacity = 0;
    evidence.confidence = e.faces > 1 ? kMoreFaces : kOneFace;
    const int begin = node_of(e.from), end = node_of(e.to);
    out.add_stroke(StrokeKind::kLine, begin, end, {}, evidence);
  }
  return out;
}

}  // namespace

Sketch propose_edges(const Sketch& sketch, const EdgeWorld& world, const ProposeOptions& options) {
  if (world.hull.empty()) return {};
  return Proposer(sketch, world, options).run();
}

}  // namespace sketchsplat
