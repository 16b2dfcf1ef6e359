// SPDX-License-Identifier: MIT
#include "sketches/solve/family.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "datasets/types/dense.h"
#include "sketches/curve/curve.h"
#include "sketches/solve/similarity.h"

namespace sketchsplat {
namespace {

constexpr double kNovelty = 0.05;    // [extents] by which the sibling of one part differs from it
constexpr double kSame = 0.002;      // [extents] coordinates nearer in every sibling are one
constexpr double kFarthest = 0.2;    // [extents] from where the neighbours' moves put a stroke
constexpr double kNeighbours = 0.2;  // [extents] how far moves of strokes tell of others'
constexpr int kMatchings = 6;

// What strokes are told apart by: three points of open ones, centre and two more of closed ones.
using Places = Eigen::Matrix3d;

// In the unit and at the place of a box.
struct Frame {
  Eigen::Vector3d centre;
  Eigen::Vector3d size;
  double extent;
};

Eigen::Matrix3d points_of_stroke(const Sketch& sketch, int stroke) {
  Eigen::Matrix3d out;
  if (!is_closed(sketch.strokes[stroke].kind)) {
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d x, unused;
      evaluate_stroke(sketch, stroke, 0.5 * k, &x, &unused);
      out.col(k) = x;
    }
    return out;
  }
  // Centre, and the extent of the curve along the axes of the frame: no sign, no phase.
  const Eigen::Matrix3Xd ring = sample_stroke(sketch, stroke, stroke_length(sketch, stroke) / 64);
  const Eigen::Vector3d low = ring.rowwise().minCoeff(), high = ring.rowwise().maxCoeff();
  out.col(1) = 0.5 * (low + high);
  out.col(0) = low, out.col(2) = high;
  return out;
}

std::vector<Places> all_places(const Sketch& sketch) {
  std::vector<Places> out;
  for (int s = 0; s < sketch.size(); ++s) out.push_back(points_of_stroke(sketch, s));
  return out;
}

Frame frame_around(const std::vector<Places>& places) {
  Eigen::AlignedBox3d box;
  for (const Places& p : places)
    for (int k = 0; k < 3; ++k) box.extend(Eigen::Vector3d(p.col(k)));
  const double extent = std::max(1e-12, box.sizes().maxCoeff());
  return {box.center(), box.sizes().cwiseMax(1e-3 * extent), extent};
}

double gap(const Places& a, const Places& b) { return std::sqrt((a - b).squaredNorm() / 3); }

Places reversed(const Places& p) {
  Places out = p;
  out.col(0) = p.col(2), out.col(2) = p.col(0);
  return out;
}

// Pairs, nearest first, each stroke once.
std::vector<StrokeMatch> pair_up(const Sketch& a, const std::vector<Places>& predicted,
                                 const Sketch& b, const std::vector<Places>& there, double most) {
  std::vector<std::tuple<double, int, int, bool>> pairs;
  for (int i = 0; i < a.size(); ++i)
    for (int j = 0; j < b.size(); ++j) {
      const StrokeKind kind = a.strokes[i].kind;
      if (kind != b.strokes[j].kind) continue;
      const double along = gap(predicted[i], there[j]);
      const double back = is_closed(kind) ? along : gap(predicted[i], reversed(there[j]));
      const double d = std::min(along, back);
      if (d < most) pairs.emplace_back(d, i, j, back < along);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<StrokeMatch> out(a.size());
  std::vector<bool> taken(b.size());
  for (const auto& [d, i, j, back] : pairs)
    if (out[i].other < 0 && !taken[j]) out[i] = {j, back}, taken[j] = true;
  return out;
}

// Where the moves of the neighbours that have partners put every stroke.
std::vector<Places> predict(const std::vector<Places>& from, const std::vector<Places>& there,
                            const std::vector<StrokeMatch>& matches, double reach) {
  std::vector<Places> out = from;
  for (size_t i = 0; i < from.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weight = 1e-9;
      for (size_t j = 0; j < from.size(); ++j) {
        if (matches[j].other < 0 || i == j) continue;
        const Places& target = there[matches[j].other];
        const Places partner = matches[j].reversed ? reversed(target) : target;
        for (int m = 0; m < 3; ++m) {
          const double d = (from[j].col(m) - from[i].col(k)).norm() / reach;
          const double w = std::exp(-0.5 * d * d);
          sum += w * (partner.col(m) - from[j].col(m));
          weight += w;
        }
      }
      out[i].col(k) += sum / weight;
    }
  return out;
}

}  // namespace

std::vector<StrokeMatch> match_siblings(const Sketch& sketch, const Sketch& other) {
  const std::vector<Places> from = all_places(sketch), there = all_places(other);
  if (from.empty() || there.empty()) return std::vector<StrokeMatch>(from.size());
  const Frame a = frame_around(from), b = frame_around(there);
  std::vector<Places> predicted = from;
  for (Places& p : predicted)
    for (int k = 0; k < 3; ++k)
      p.col(k) = b.centre + (p.col(k) - a.centre).cwiseProduct(b.size.cwiseQuotient(a.size));
  std::vector<StrokeMatch> matches;
  const std::vector<Places> boxed = predicted;
  for (int k = 0; k < kMatchings; ++k) {
    matches = pair_up(sketch, predicted, other, there, kFarthest * b.extent);
    predicted = predict(boxed, there, matches, kNeighbours * b.extent);
  }
  return matches;
}

namespace {

// Control points of a stroke as those of its partner: same direction, same signs and phase.
ControlPoints as_partner(StrokeKind kind, const ControlPoints& ours, ControlPoints theirs,
                         bool reversed) {
  if (kind == StrokeKind::kCircle) {
    if (ours.p[1].dot(theirs.p[1]) < 0) theirs.p[1] = -theirs.p[1];
  } else if (kind == StrokeKind::kEllipse) {
    // centre + cos u + sin v from another point on, perhaps the other way round.
    double best = -1;
    ControlPoints out = theirs;
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d u = theirs.p[1], v = sign * theirs.p[2];
      const double a =
          std::atan2(ours.p[1].dot(v) - ours.p[2].dot(u), ours.p[1].dot(u) + ours.p[2].dot(v));
      const Eigen::Vector3d nu = std::cos(a) * u + std::sin(a) * v;
      const Eigen::Vector3d nv = std::cos(a) * v - std::sin(a) * u;
      const double fit = ours.p[1].dot(nu) + ours.p[2].dot(nv);
      if (fit > best) best = fit, out.p[1] = nu, out.p[2] = nv;
    }
    theirs = out;
  } else if (reversed) {
    std::swap(theirs.p[0], theirs.p[theirs.count - 1]);
    if (kind == StrokeKind::kBezier) std::swap(theirs.p[1], theirs.p[2]);
  }
  return theirs;
}

// A sibling's control points in the order of the graph's; NaN where it has none.
struct Columns {
  Eigen::Matrix3Xd nodes, handles;
};

Columns columns_of(const Sketch& graph, const Sketch& sibling,
                   const std::vector<StrokeMatch>& matches) {
  Columns out{Eigen::Matrix3Xd::Zero(3, graph.nodes.cols()),
              Eigen::Matrix3Xd::Constant(3, graph.handles.cols(), NAN)};
  std::vector<int> count(graph.nodes.cols());
  for (int s = 0; s < graph.size(); ++s) {
    if (matches[s].other < 0) continue;
    const Stroke& stroke = graph.strokes[s];
    const ControlPoints c =
        as_partner(stroke.kind, control_points(graph, s), control_points(sibling, matches[s].other),
                   matches[s].reversed);
    const bool closed = is_closed(stroke.kind);
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      out.handles.col(stroke.handle + h) = c.p[h + !closed];
    if (closed) continue;
    out.nodes.col(stroke.begin) += c.p[0], ++count[stroke.begin];
    out.nodes.col(stroke.end) += c.p[c.count - 1], ++count[stroke.end];
  }
  for (int n = 0; n < graph.nodes.cols(); ++n) out.nodes.col(n) /= double(count[n]);  // 0 / 0: NaN
  return out;
}

// Handles of closed strokes are vectors, but for the first.
std::vector<bool> are_vectors(const Sketch& graph) {
  std::vector<bool> out(graph.handles.cols());
  for (const Stroke& s : graph.strokes)
    for (int h = 1; is_closed(s.kind) && h < num_handles(s.kind); ++h) out[s.handle + h] = true;
  return out;
}

// Scale and shift of a sibling onto the graph: least squares over the nodes and centres both have.
void put_onto(const Sketch& graph, const std::vector<bool>& vectors, Columns* columns) {
  std::vector<Eigen::Vector3d> from, to;
  for (int n = 0; n < graph.nodes.cols(); ++n)
    if (columns->nodes.col(n).allFinite())
      from.push_back(columns->nodes.col(n)), to.push_back(graph.nodes.col(n));
  for (int h = 0; h < graph.handles.cols(); ++h)
    if (!vectors[h] && columns->handles.col(h).allFinite())
      from.push_back(columns->handles.col(h)), to.push_back(graph.handles.col(h));
  if (from.empty()) return;
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  for (size_t k = 0; k < from.size(); ++k) a += from[k] / from.size(), b += to[k] / from.size();
  double up = 0, down = 0;
  for (size_t k = 0; k < from.size(); ++k) {
    up += (from[k] - a).dot(to[k] - b);
    down += (from[k] - a).squaredNorm();
  }
  const double scale = up > 0 && down > 0 ? up / down : 1;
  columns->nodes = (scale * (columns->nodes.colwise() - a)).colwise() + b;
  for (int h = 0; h < graph.handles.cols(); ++h) {
    const Eigen::Vector3d x = columns->handles.col(h);
    columns->handles.col(h) = vectors[h] ? scale * x : Eigen::Vector3d(scale * (x - a) + b);
  }
}

// What a sibling has not moves as what lies around it does.
void fill(const Sketch& graph, const std::vector<bool>& vectors, double reach, Columns* columns) {
  std::vector<Eigen::Vector3d> at, move;
  const auto note = [&](const auto& ours, const auto& theirs) {
    if (theirs.allFinite()) at.push_back(ours), move.push_back(theirs - ours);
  };
  for (int n = 0; n < graph.nodes.cols(); ++n)
    note(Eigen::Vector3d(graph.nodes.col(n)), Eigen::Vector3d(columns->nodes.col(n)));
  for (int h = 0; h < graph.handles.cols(); ++h)
    if (!vectors[h])
      note(Eigen::Vector3d(graph.handles.col(h)), Eigen::Vector3d(columns->handles.col(h)));
  const auto moved_by_others = [&](const Eigen::Vector3d& x) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 1e-9;
    for (size_t k = 0; k < at.size(); ++k) {
      const double w = std::exp(-0.5 * (at[k] - x).squaredNorm() / (reach * reach));
      sum += w * move[k], weight += w;
    }
    return Eigen::Vector3d(x + sum / weight);
  };
  for (int n = 0; n < graph.nodes.cols(); ++n)
    if (!columns->nodes.col(n).allFinite())
      columns->nodes.col(n) = moved_by_others(graph.nodes.col(n));
  for (int h = 0; h < graph.handles.cols(); ++h)
    if (!columns->handles.col(h).allFinite())
      columns->handles.col(h) = vectors[h] ? Eigen::Vector3d(graph.handles.col(h))
                                           : moved_by_others(graph.handles.col(h));
}

double matched_length(const Sketch& graph, const std::vector<StrokeMatch>& matches) {
  double sum = 0;
  for (int s = 0; s < graph.size(); ++s)
    if (matches[s].other >= 0) sum += stroke_length(graph, s);
  return sum;
}

// Vectors of closed strokes point to where their largest coordinate is positive, which changes no
// curve: two circles about one axis have one radius then, and not two of opposite sign.
void turn_vectors(const std::vector<bool>& vectors, Sketch* graph) {
  for (int h = 0; h < graph->handles.cols(); ++h) {
    Eigen::Index largest;
    if (!vectors[h] || !(graph->handles.col(h).cwiseAbs().maxCoeff(&largest) > 0)) continue;
    if (graph->handles(largest, h) < 0) graph->handles.col(h) *= -1;
  }
}

// The sibling whose strokes the others have most of; its matches with all.
int most_typical(const std::vector<Sketch>& siblings,
                 std::vector<std::vector<StrokeMatch>>* matches) {
  int best = -1;
  double most = -1;
  for (size_t k = 0; k < siblings.size(); ++k) {
    std::vector<std::vector<StrokeMatch>> with;
    double sum = 0;
    for (const Sketch& other : siblings) {
      with.push_back(match_siblings(siblings[k], other));
      sum += matched_length(siblings[k], with.back()) / largest_extent(siblings[k]);
    }
    if (sum > most) most = sum, best = int(k), *matches = with;
  }
  return best;
}

// Coordinates that are the same in all siblings get one number: clusters by single linkage.
class Ties {
 public:
  Ties(int size, double reach) : parent_(size), reach_(reach) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  // `rows`: coordinates that may be one; `values`: of each in every sibling.
  void tie(const std::vector<int>& rows, const Eigen::MatrixXd& values) {
    for (size_t i = 0; i < rows.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if ((values.row(rows[i]) - values.row(rows[j])).cwiseAbs().maxCoeff() < reach_)
          parent_[root(rows[i])] = root(rows[j]);
  }
  std::vector<int> numbered(int* count) {
    std::vector<int> number(parent_.size(), -1), out(parent_.size());
    *count = 0;
    for (size_t i = 0; i < parent_.size(); ++i) {
      int& n = number[root(int(i))];
      if (n < 0) n = (*count)++;
      out[i] = n;
    }
    return out;
  }

 private:
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<int> parent_;
  double reach_;
};

std::vector<int> tie_coordinates(const Sketch& graph, const std::vector<bool>& vectors,
                                 const Eigen::MatrixXd& values, double extent, int* count) {
  const int nodes = int(graph.nodes.cols()), points = nodes + int(graph.handles.cols());
  Ties ties(3 * points, kSame * extent);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<int> places, directions;
    for (int p = 0; p < points; ++p)
      (p >= nodes && vectors[p - nodes] ? directions : places).push_back(3 * p + axis);
    ties.tie(places, values);
    ties.tie(directions, values);
  }
  return ties.numbered(count);
}

void measure_spread(double extent, Family* family) {
  const int n = family->siblings;
  family->mean = family->numbers.rowwise().mean();
  const Eigen::MatrixXd off = family->numbers.colwise() - family->mean;
  const Eigen::MatrixXd sample = off * off.transpose() / std::max(1, n - 1);
  const double shrink = 2.0 / (n + 1), novelty = kNovelty * extent / n;
  family->covariance = (1 + 1.0 / n) * (1 - shrink) * sample;
  family->covariance.diagonal() += (1 + 1.0 / n) * shrink * sample.diagonal();
  family->covariance.diagonal().array() += novelty * novelty;
  family->modes = eigenvalues_symmetric(sample)
                      .reverse()
                      .head(std::min<Eigen::Index>(n - 1, sample.rows()))
                      .cwiseMax(0)
                      .cwiseSqrt();
}

}  // namespace

Sketch Family::with(const Eigen::VectorXd& values) const {
  Sketch out = graph;
  for (int k = 0; k < int(nodes.size()); ++k) out.nodes(k % 3, k / 3) = values[nodes[k]];
  for (int k = 0; k < int(handles.size()); ++k) out.handles(k % 3, k / 3) = values[handles[k]];
  return out;
}

double Family::log_odds(int stroke) const {
  return std::log((had_by[stroke] + 1.0) / (siblings - had_by[stroke] + 1.0));
}

Family learn_family(const std::vector<Sketch>& siblings) {
  Family family;
  family.siblings = int(siblings.size());
  std::vector<std::vector<StrokeMatch>> matches;
  family.graph = siblings[most_typical(siblings, &matches)];
  for (Evidence& e : family.graph.evidence) e = {};
  const Sketch& graph = family.graph;
  const double extent = largest_extent(graph);
  const std::vector<bool> vectors = are_vectors(graph);
  turn_vectors(vectors, &family.graph);
  const int nodes = int(graph.nodes.cols()), points = nodes + int(graph.handles.cols());
  Eigen::MatrixXd values(3 * points, family.siblings);
  family.had_by.assign(graph.size(), 0);
  for (int k = 0; k < family.siblings; ++k) {
    Columns c = columns_of(graph, siblings[k], matches[k]);
    put_onto(graph, vectors, &c);
    fill(graph, vectors, kNeighbours * extent, &c);
    values.col(k) << c.nodes.reshaped(), c.handles.reshaped();
    for (int s = 0; s < graph.size(); ++s) family.had_by[s] += matches[k][s].other >= 0;
  }
  int count = 0;
  const std::vector<int> number = tie_coordinates(graph, vectors, values, extent, &count);
  family.nodes.assign(number.begin(), number.begin() + 3 * nodes);
  family.handles.assign(number.begin() + 3 * nodes, number.end());
  family.numbers = Eigen::MatrixXd::Zero(count, family.siblings);
  Eigen::VectorXd tied = Eigen::VectorXd::Zero(count);
  for (int r = 0; r < 3 * points; ++r) {
    family.numbers.row(number[r]) += values.row(r);
    tied[number[r]] += 1;
  }
  for (int g = 0; g < count; ++g) family.numbers.row(g) /= tied[g];
  measure_spread(extent, &family);
  return family;
}

}  // namespace sketchsplat
