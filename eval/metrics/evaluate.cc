// SPDX-License-Identifier: MIT
#include "eval/metrics/evaluate.h"

#include <algorithm>

#include "datasets/truth/published_samples.h"
#include "datasets/types/errors.h"
#include "eval/metrics/nearest.h"
#include "eval/metrics/parameters.h"

namespace sketchsplat {
namespace {

constexpr double kStep = 0.005;        // of the published samplers
constexpr double kFineStep = 0.001;    // of the prediction
constexpr double kTruthStep = 0.0005;  // of the truth, where its own units do not count
constexpr double kNear = 0.005;        // where a curve counts as explained
constexpr int kSeenBy = 2;             // views: what only one sees has no depth
constexpr size_t kWorst = 5;

// Moves coordinates into the cube [0, 1]^3 that the published numbers are about.
struct Normalization {
  double scale = 1;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  bool identity = true;

  explicit Normalization(const GroundTruth& truth) {
    identity = truth.extent == 1;
    scale = 1 / truth.extent;
    center = truth.center;
  }
  template <typename Points>
  void apply(Points* points) const {
    if (identity) return;
    for (Eigen::Index i = 0; i < points->cols(); ++i) {
      points->col(i) = (points->col(i) - center) * scale + Eigen::Vector3d::Constant(0.5);
    }
  }
  void undo(Eigen::Matrix3Xd* points) const {
    if (identity) return;
    for (Eigen::Index i = 0; i < points->cols(); ++i) {
      points->col(i) = (points->col(i) - Eigen::Vector3d::Constant(0.5)) / scale + center;
    }
  }
};

Prediction normalized(Prediction prediction, const Normalization& to_unit) {
  for (auto& line : prediction.lines) to_unit.apply(&line);
  for (auto& curve : prediction.curves) to_unit.apply(&curve);
  for (auto& stroke : prediction.strokes) to_unit.apply(&stroke);
  to_unit.apply(&prediction.points);
  return prediction;
}

// Samples are taken every 0.0005 and 0.001 objects.
void check_sampled_length(double length, const std::string& path) {
  constexpr double kMost = 1e4;  // objects; drawings of the largest have some hundred
  if (!(length <= kMost))
    throw InputError(path, "edges of at most 10000 times the size of the true object in all",
                     std::to_string(length) + " times");
}

double bound_of_length(const Prediction& prediction) {
  double length = 0;
  for (const auto& line : prediction.lines) length += polyline_length(line);
  for (const auto& curve : prediction.curves) length += polyline_length(curve);
  return length;
}

std::vector<TrueEdge> true_edges(const GroundTruth& truth, const Normalization& to_unit) {
  std::vector<TrueEdge> edges;
  for (const auto& curve : truth.curves) {
    if (!curve.sharp || curve.polyline.cols() == 0) continue;
    edges.push_back({curve.type, curve.polyline, std::to_string(&curve - truth.curves.data())});
    to_unit.apply(&edges.back().polyline);
    for (int views : curve.visible_views) edges.back().visible.push_back(views >= kSeenBy);
  }
  return edges;
}

// The truth as points, and whether each of them can be seen.
struct TruthSamples {
  Eigen::Matrix3Xd points;
  std::vector<bool> visible;  // empty if nobody knows
};

TruthSamples dense_truth(const std::vector<TrueEdge>& edges) {
  TruthSamples out;
  std::vector<Eigen::Matrix3Xd> parts;
  std::vector<int> nearest;
  const bool known = !edges.empty() && std::none_of(edges.begin(), edges.end(), [](const auto& e) {
    return e.visible.empty();
  });
  for (const TrueEdge& edge : edges) {
    parts.push_back(densify(edge.polyline, kTruthStep, &nearest));
    if (!known) continue;
    for (int i : nearest) out.visible.push_back(edge.visible[size_t(i)]);
  }
  out.points = concatenate(parts);
  return out;
}

// Where nothing else is known, each primitive is a stroke.
void add_strokes(Prediction* prediction) {
  if (!prediction->strokes.empty() || prediction->points_only) return;
  const auto add = [&](const Prediction& one, size_t i, const char* kind) {
    prediction->strokes.push_back(sample_arc_length(one, kFineStep));
    prediction->facts.push_back(
        {std::string(kind) + " " + std::to_string(i), kind, degrees_of_freedom(kind)});
  };
  Prediction line, curve;
  for (size_t i = 0; i < prediction->lines.size(); ++i) {
    line.lines = {prediction->lines[i]};
    add(line, i, "line");
  }
  for (size_t i = 0; i < prediction->curves.size(); ++i) {
    curve.curves = {prediction->curves[i]};
    add(curve, i, "bezier");
  }
}

Score published_score(const Prediction& prediction, const TruthSamples& truth, Protocol protocol) {
  Eigen::Matrix3Xd samples =
      prediction.points_only ? prediction.points : sample_published(prediction, kStep);
  if (protocol == Protocol::kEmap) samples = voxel_average(samples, 256, -1, 1);
  if (protocol == Protocol::kCurveGaussian) samples = voxel_average(samples, 256, 0, 1);
  return score(as_float(samples), as_float(truth.points), {0.020, 0.010, 0.005, 0.002, 0.001},
               truth.visible);
}

Eigen::Matrix3Xd arc_length_samples(const Prediction& prediction, double step) {
  return prediction.points_only ? prediction.points : sample_arc_length(prediction, step);
}

Score fine_score(const Prediction& prediction, const TruthSamples& truth) {
  Score fine = score(arc_length_samples(prediction, kFineStep), truth.points, {0.005, 0.002, 0.001},
                     truth.visible);
  const Score coarse =
      score(arc_length_samples(prediction, kStep), truth.points, {}, truth.visible);
  fine.accuracy = coarse.accuracy;
  fine.completeness = coarse.completeness;
  fine.completeness_visible = coarse.completeness_visible;
  return fine;
}

// Fills share and worst distance of a curve; false if nothing is wrong with it.
bool has_errors(const Eigen::Matrix3Xd& samples, const NearestPoints& other_side,
                CurveScore* curve) {
  if (samples.cols() == 0) return false;
  const Eigen::VectorXd distances = other_side.distances(samples);
  curve->share = 100.0 * double((distances.array() < kNear).count()) / double(distances.size());
  curve->worst = distances.maxCoeff();
  return curve->share < 100;
}

std::vector<CurveScore> worst_of(std::vector<CurveScore> curves, const Normalization& to_unit) {
  std::stable_sort(curves.begin(), curves.end(), [](const CurveScore& a, const CurveScore& b) {
    return a.share != b.share ? a.share < b.share : a.length > b.length;
  });
  if (curves.size() > kWorst) curves.resize(kWorst);
  for (CurveScore& curve : curves) to_unit.undo(&curve.polyline);
  return curves;
}

std::vector<CurveScore> worst_edges(const std::vector<TrueEdge>& edges,
                                    const NearestPoints& prediction, const Normalization& to_unit) {
  std::vector<CurveScore> worst;
  for (const TrueEdge& edge : edges) {
    CurveScore curve;
    if (!has_errors(densify(edge.polyline, kTruthStep), prediction, &curve)) continue;
    curve.name = edge.name;
    curve.type = edge.type;
    curve.length = polyline_length(edge.polyline);
    curve.polyline = edge.polyline;
    worst.push_back(std::move(curve));
  }
  return worst_of(std::move(worst), to_unit);
}

// All strokes; those that are not perfect go into `worst`, too.
std::vector<CurveScore> score_strokes(const Prediction& prediction, const NearestPoints& truth,
                                      std::vector<CurveScore>* worst) {
  std::vector<CurveScore> all;
  const bool known = prediction.facts.size() == prediction.strokes.size();
  for (size_t i = 0; i < prediction.strokes.size(); ++i) {
    CurveScore curve;
    const bool wrong = has_errors(prediction.strokes[i], truth, &curve);
    curve.name = known ? prediction.facts[i].name : std::to_string(i);
    curve.type = known ? prediction.facts[i].kind : "";
    curve.length = polyline_length(prediction.strokes[i]);
    all.push_back(curve);
    if (!wrong) continue;
    curve.polyline = prediction.strokes[i];
    worst->push_back(std::move(curve));
  }
  return all;
}

}  // namespace

const char* protocol_name(Protocol protocol) {
  return protocol == Protocol::kEmap            ? "emap"
         : protocol == Protocol::kCurveGaussian ? "curvegaussian"
                                                : "sketchsplat";
}

bool parse_protocol(const std::string& name, Protocol* protocol) {
  for (Protocol p : {Protocol::kSketchSplat, Protocol::kEmap, Protocol::kCurveGaussian}) {
    if (name != protocol_name(p)) continue;
    *protocol = p;
    return true;
  }
  return false;
}

Evaluation evaluate(const Prediction& prediction, const GroundTruth& truth,
                    const EvaluateOptions& options) {
  const Normalization to_unit(truth);
  Prediction unit = normalized(prediction, to_unit);
  const std::vector<TrueEdge> edges = true_edges(truth, to_unit);
  check_sampled_length(bound_of_length(unit), prediction.path);
  double true_length = 0;
  for (const TrueEdge& edge : edges) true_length += polyline_length(edge.polyline);
  check_sampled_length(true_length, truth.path);
  add_strokes(&unit);
  TruthSamples dense = dense_truth(edges), samples;
  samples.points = truth.samples;
  to_unit.apply(&samples.points);
  if (samples.points.cols() == 0) samples = dense;
  if (dense.points.cols() == 0) dense = samples;
  if (samples.points.cols() == 0) throw InputError(truth.path, "edges", "none");

  Evaluation result;
  result.protocol = options.protocol;
  result.prediction_path = prediction.path;
  result.truth_path = truth.path;
  result.lines = int(prediction.lines.size());
  result.curves = int(prediction.curves.size());
  result.published = published_score(unit, samples, options.protocol);
  result.fine = fine_score(unit, dense);
  result.has_curves = !edges.empty();
  result.has_strokes = !unit.strokes.empty() || unit.points.cols() == 0;
  result.has_visibility = !dense.visible.empty();
  const std::vector<TrueEdge> merged = merge_smooth(edges);
  result.structure = compare_structure(unit.strokes, unit.facts, merged);
  result.worst_edges =
      worst_edges(merged, NearestPoints(arc_length_samples(unit, kFineStep)), to_unit);
  std::vector<CurveScore> wrong;
  result.strokes = score_strokes(unit, NearestPoints(dense.points), &wrong);
  result.worst_strokes = worst_of(std::move(wrong), to_unit);
  return result;
}

}  // namespace sketchsplat
