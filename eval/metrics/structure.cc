// SPDX-License-Identifier: MIT
#include "eval/metrics/structure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "eval/metrics/duplicates.h"
#include "eval/metrics/junctions.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/nearest.h"
#include "eval/metrics/parameters.h"

namespace sketchsplat {
namespace {

constexpr double kNear = 5e-3;     // a sample that lies on a curve
constexpr double kShare = 0.85;    // of the samples, both ways
constexpr double kSpacing = 1e-3;  // of an edge's samples
constexpr double kSeen = 0.5;      // of an edge's length, for it to count as visible

// Does any other edge end at this point? Then it is a true vertex, and two edges end there.
bool is_vertex(const std::vector<TrueEdge>& edges, size_t i, size_t j, const Eigen::Vector3d& p) {
  for (size_t k = 0; k < edges.size(); ++k) {
    if (k == i || k == j) continue;
    const Eigen::Matrix3Xd& other = edges[k].polyline;
    if ((other.col(0) - p).norm() < kMeeting || (other.rightCols<1>() - p).norm() < kMeeting) {
      return true;
    }
  }
  return false;
}

std::vector<bool> joined_flags(std::vector<bool> a, std::vector<bool> b, bool turn_a, bool turn_b) {
  if (a.empty() || b.empty()) return {};
  if (turn_a) std::reverse(a.begin(), a.end());
  if (turn_b) std::reverse(b.begin(), b.end());
  a.insert(a.end(), b.begin() + 1, b.end());
  return a;
}

// Distance of a point from the circle through the ends and the middle of an arc, whose ends are
// apart; from their line if there is no such circle.
double distance_to_circle(const Eigen::Matrix3Xd& arc, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = arc.col(0), u = arc.col(arc.cols() / 2) - a, v = arc.rightCols<1>() - a,
                        n = u.cross(v);
  if (n.norm() < 1e-9 * u.norm() * v.norm()) return (p - a).cross(v.normalized()).norm();
  const Eigen::Vector3d centre =
      a + (u.squaredNorm() * v - v.squaredNorm() * u).cross(n) / (2 * n.squaredNorm());
  const Eigen::Vector3d from = p - centre;
  const double height = from.dot(n.normalized());
  return std::hypot((from - height * n.normalized()).norm() - (a - centre).norm(), height);
}

// Are two arcs pieces of one circle? Small ones say little of the other's circle.
bool one_circle(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  const bool a_longer = polyline_length(a) > polyline_length(b);
  const Eigen::Matrix3Xd &longer = a_longer ? a : b, &shorter = a_longer ? b : a;
  if ((longer.col(0) - longer.rightCols<1>()).norm() < kMeeting) return false;
  for (int i = 0; i < shorter.cols(); ++i)
    if (distance_to_circle(longer, shorter.col(i)) > kMeeting) return false;
  return true;
}

// Joins edge j to edge i if they continue each other one way or another.
bool join(std::vector<TrueEdge>* edges, size_t i, size_t j) {
  TrueEdge& first = (*edges)[i];
  const TrueEdge& second = (*edges)[j];
  if (first.type != second.type) return false;
  if (first.polyline.cols() < 2 || second.polyline.cols() < 2) return false;
  const bool arcs = first.type == "circle" || first.type == "arc";
  if (arcs && !one_circle(first.polyline, second.polyline)) return false;
  const double limit = std::cos((first.type == "line" ? 4 : 12) * M_PI / 180);
  const auto end_of = [](const Eigen::Matrix3Xd& p, bool last) -> Eigen::Vector3d {
    return p.col(last ? p.cols() - 1 : 0);
  };
  for (int turn = 0; turn < 4; ++turn) {
    const bool turn_a = turn & 2, turn_b = turn & 1;
    if ((end_of(first.polyline, !turn_a) - end_of(second.polyline, turn_b)).norm() > kMeeting) {
      continue;
    }
    Eigen::Matrix3Xd a = first.polyline, b = second.polyline;
    if (turn_a) a = first.polyline.rowwise().reverse();
    if (turn_b) b = second.polyline.rowwise().reverse();
    const Eigen::Vector3d u = a.rightCols<1>() - a.col(a.cols() - 2), v = b.col(1) - b.col(0);
    if (!(u.dot(v) / (u.norm() * v.norm() + 1e-12) > limit)) continue;
    if (is_vertex(*edges, i, j, b.col(0))) continue;
    Eigen::Matrix3Xd joined(3, a.cols() + b.cols() - 1);
    joined << a, b.rightCols(b.cols() - 1);
    first.polyline = joined;
    first.visible = joined_flags(first.visible, second.visible, turn_a, turn_b);
    if (!second.name.empty()) first.name += "+" + second.name;
    edges->erase(edges->begin() + long(j));
    return true;
  }
  return false;
}

double share_near(const NearestPoints& points, const Eigen::Matrix3Xd& samples) {
  return double((points.distances(samples).array() < kNear).count()) / double(samples.cols());
}

bool boxes_apart(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return ((a.rowwise().minCoeff() - b.rowwise().maxCoeff()).array() > kNear).any() ||
         ((b.rowwise().minCoeff() - a.rowwise().maxCoeff()).array() > kNear).any();
}

bool is_visible(const TrueEdge& edge) {
  if (edge.visible.empty()) return false;
  std::vector<int> nearest;
  densify(edge.polyline, kSpacing, &nearest);
  const auto seen = [&](int i) { return edge.visible[size_t(i)]; };
  return double(std::count_if(nearest.begin(), nearest.end(), seen)) >=
         kSeen * double(nearest.size());
}

void count_visible(const std::vector<TrueEdge>& edges, const std::vector<bool>& found,
                   Structure* result) {
  for (size_t j = 0; j < edges.size(); ++j) {
    if (!is_visible(edges[j])) continue;
    ++result->visible_edges;
    if (found[j]) ++result->visible_matched;
  }
  if (result->visible_edges == 0) return;
  result->recall_visible = 100.0 * result->visible_matched / result->visible_edges;
  const double sum = result->precision + result->recall_visible;
  result->f_visible = sum > 0 ? 2 * result->precision * result->recall_visible / sum : 0;
}

}  // namespace

std::vector<TrueEdge> merge_smooth(std::vector<TrueEdge> edges) {
  for (size_t i = 0; i < edges.size(); ++i) {
    for (size_t j = i + 1; j < edges.size();) {
      j = join(&edges, i, j) ? i + 1 : j + 1;
    }
  }
  return edges;
}

Structure match_strokes(const std::vector<Eigen::Matrix3Xd>& strokes,
                        const std::vector<TrueEdge>& edges) {
  Structure result;
  result.strokes = int(strokes.size());
  result.edges = int(edges.size());
  std::vector<Eigen::Matrix3Xd> dense;
  std::vector<NearestPoints> near_stroke, near_edge;
  for (const auto& stroke : strokes) near_stroke.emplace_back(stroke);
  for (const auto& edge : edges) {
    dense.push_back(densify(edge.polyline, kSpacing));
    near_edge.emplace_back(dense.back());
  }
  std::vector<std::tuple<double, int, int>> pairs;
  for (int i = 0; i < result.strokes; ++i) {
    for (int j = 0; j < result.edges; ++j) {
      if (strokes[i].cols() == 0 || boxes_apart(strokes[i], dense[j])) continue;
      const double of_stroke = share_near(near_edge[j], strokes[i]);
      if (of_stroke < kShare) continue;
      const double of_edge = share_near(near_stroke[i], dense[j]);
      if (of_edge >= kShare) pairs.emplace_back(of_stroke + of_edge, i, j);
    }
  }
  std::sort(pairs.rbegin(), pairs.rend());
  std::vector<bool> stroke_used(strokes.size()), edge_used(edges.size());
  for (const auto& [quality, i, j] : pairs) {
    if (stroke_used[i] || edge_used[j]) continue;
    stroke_used[i] = edge_used[j] = true;
    result.pairs.emplace_back(i, j);
  }
  result.matched = int(result.pairs.size());
  const int both = result.strokes + result.edges;
  result.f = both > 0 ? 100.0 * 2 * result.matched / both : 0;
  result.precision = result.strokes > 0 ? 100.0 * result.matched / result.strokes : 0;
  result.recall = result.edges > 0 ? 100.0 * result.matched / result.edges : 0;
  result.strokes_per_edge = result.edges > 0 ? double(result.strokes) / result.edges : 0;
  count_visible(edges, edge_used, &result);
  return result;
}

Structure compare_structure(const std::vector<Eigen::Matrix3Xd>& strokes,
                            const std::vector<StrokeFacts>& facts,
                            const std::vector<TrueEdge>& edges) {
  Structure result = match_strokes(strokes, edges);
  const bool known = facts.size() == strokes.size() && !strokes.empty();
  std::vector<TrueEdge> curves;
  for (size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i].cols() > 0) curves.push_back({known ? facts[i].kind : "", strokes[i]});
    result.length += polyline_length(strokes[i]);
  }
  for (const TrueEdge& edge : edges) result.true_length += polyline_length(edge.polyline);
  result.length_error = result.true_length > 0 ? 100 * (result.length / result.true_length - 1) : 0;
  result.junctions = match_junctions(merge_smooth(std::move(curves)), edges);
  result.duplicated = duplicated_share(strokes);
  result.true_parameters = count_true_parameters(edges);
  if (!known) return result;
  result.parameters = count_parameters(strokes, facts);
  if (result.true_parameters > 0) {
    result.parameters_per_true = result.parameters / result.true_parameters;
  }
  for (const auto& [i, j] : result.pairs) {
    result.right_type += facts[size_t(i)].kind == kind_of_edge(edges[size_t(j)]);
  }
  if (result.matched > 0) result.right_type_share = 100.0 * result.right_type / result.matched;
  return result;
}

}  // namespace sketchsplat
