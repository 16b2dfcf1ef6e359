// SPDX-License-Identifier: MIT
#include "pipelines/candidates/levels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipelines/candidates/generators.h"
#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr double kSameDeg = 1.5;  // directions that are one
constexpr int kFewestAcross = 2;  // strokes or corners of a direction
constexpr int kMostDirections = 12;
constexpr int kMostLevels = 8;     // of a direction, that strokes are copied to
constexpr double kMostFacets = 6;  // points along a stroke by which it is known to lie in a level

struct Direction {
  Vector3d sum;
  int count;
};

void count_direction(const Vector3d& n, std::vector<Direction>* all) {
  const double same = std::cos(kSameDeg * M_PI / 180);
  for (Direction& d : *all) {
    const double c = n.dot(d.sum.normalized());
    if (std::abs(c) < same) continue;
    d.sum += c < 0 ? Vector3d(-n) : n;
    ++d.count;
    return;
  }
  all->push_back({n, 1});
}

std::vector<Direction> directions(const Sketch& s) {
  std::vector<Direction> all;
  for (int i = 0; i < s.size(); ++i) {
    const Vector3d n = plane_normal(s.strokes[i].kind, control_points(s, i));
    if (n.norm() > 0) count_direction(n, &all);
  }
  std::vector<std::vector<Vector3d>> ways(s.nodes.cols());  // of the lines at every node
  for (const Stroke& stroke : s.strokes) {
    if (stroke.kind != StrokeKind::kLine) continue;
    const Vector3d way = (s.nodes.col(stroke.end) - s.nodes.col(stroke.begin)).normalized();
    ways[stroke.begin].push_back(way);
    ways[stroke.end].push_back(way);
  }
  for (const std::vector<Vector3d>& at : ways)
    for (size_t i = 0; i < at.size(); ++i)
      for (size_t k = i + 1; k < at.size(); ++k) {
        const Vector3d n = at[i].cross(at[k]);
        if (n.norm() > kCornerSine) count_direction(n.normalized(), &all);
      }
  std::stable_sort(all.begin(), all.end(),
                   [](const Direction& a, const Direction& b) { return a.count > b.count; });
  return all;
}

// Does a curve lie in a plane across the direction, and how high?
bool lies_level(StrokeKind kind, const ControlPoints& controls, const Vector3d& normal,
                double tolerance, double* height) {
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < kMostFacets; ++k) {
    Vector3d p, d;
    evaluate_curve<double>(kind, controls.p.data(), k / (kMostFacets - 1), &p, &d);
    low = std::min(low, p.dot(normal)), high = std::max(high, p.dot(normal));
  }
  *height = 0.5 * (low + high);
  return high - low <= 2 * tolerance;
}

Levels levels_across(const Sketch& s, const Vector3d& normal, double tolerance) {
  std::vector<std::pair<double, int>> level;
  for (int i = 0; i < s.size(); ++i) {
    double height;
    if (lies_level(s.strokes[i].kind, control_points(s, i), normal, tolerance, &height))
      level.push_back({height, i});
  }
  std::sort(level.begin(), level.end());
  Levels out{normal, {}, {}};
  for (size_t begin = 0, end; begin < level.size(); begin = end) {
    double sum = 0, weight = 0;
    for (end = begin; end < level.size() &&
                      (end == begin || level[end].first - level[end - 1].first <= 2 * tolerance);
         ++end) {
      // Small rims are known some tenths of a pixel worse than large ones.
      const double length = stroke_length(s, level[end].second);
      sum += length * level[end].first;
      weight += length;
    }
    out.height.push_back(weight > 0 ? sum / weight : level[begin].first);
    out.strokes.emplace_back();
    for (size_t k = begin; k < end; ++k) out.strokes.back().push_back(level[k].second);
  }
  return out;
}

}  // namespace

std::vector<Levels> find_levels(const Sketch& sketch, double tolerance) {
  std::vector<Levels> out;
  for (const Direction& d : directions(sketch)) {
    if (d.count < kFewestAcross || int(out.size()) == kMostDirections) break;
    out.push_back(levels_across(sketch, d.sum.normalized(), tolerance));
  }
  return out;
}

std::vector<char> main_levels(const Levels& l) {
  std::vector<int> order(l.height.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return l.strokes[a].size() > l.strokes[b].size(); });
  std::vector<char> out(order.size(), 0);
  for (size_t k = 0; k < order.size() && k < kMostLevels; ++k) out[order[k]] = 1;
  return out;
}

void settle(const std::vector<Levels>& levels, double tolerance, Candidate* candidate) {
  for (const Levels& l : levels) {
    double height, nearest = tolerance;
    if (!lies_level(candidate->kind, candidate->curve, l.normal, tolerance, &height)) continue;
    for (const double h : l.height)
      if (std::abs(h - height) < std::abs(nearest)) nearest = h - height;
    if (std::abs(nearest) < tolerance) *candidate = moved(*candidate, nearest * l.normal);
  }
}

std::vector<Candidate> level_copies(const Sketch& sketch, const std::vector<Levels>& levels) {
  std::vector<Candidate> out;
  for (const Levels& l : levels) {
    const std::vector<char> main = main_levels(l);
    for (size_t from = 0; from < l.height.size(); ++from)
      for (const int stroke : l.strokes[from])
        for (size_t to = 0; to < l.height.size(); ++to)
          if (to != from && main[to])
            out.push_back(
                moved(candidate_of(sketch, stroke), (l.height[to] - l.height[from]) * l.normal));
  }
  return out;
}

std::vector<Candidate> mirror_copies(const Sketch& sketch, const std::vector<Levels>& levels) {
  std::vector<Candidate> out;
  for (const Levels& l : levels) {
    if (l.height.size() < 2) continue;
    const double middle = 0.5 * (l.height.front() + l.height.back());
    const Eigen::Affine3d by = mirror(l.normal, middle);
    for (int i = 0; i < sketch.size(); ++i) out.push_back(moved(candidate_of(sketch, i), by));
  }
  return out;
}

}  // namespace sketchsplat
