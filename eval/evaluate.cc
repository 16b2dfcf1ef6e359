// SPDX-License-Identifier: MIT
#include "eval/evaluate.h"

#include "datasets/errors.h"

namespace sketchsplat {
namespace {

constexpr double kStep = 0.005;        // of the published samplers
constexpr double kFineStep = 0.001;    // of the prediction
constexpr double kTruthStep = 0.0005;  // of the truth, where its own units do not count

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
};

Prediction normalized(Prediction prediction, const Normalization& to_unit) {
  for (auto& line : prediction.lines) to_unit.apply(&line);
  for (auto& curve : prediction.curves) to_unit.apply(&curve);
  for (auto& stroke : prediction.strokes) to_unit.apply(&stroke);
  to_unit.apply(&prediction.points);
  return prediction;
}

std::vector<TrueEdge> true_edges(const GroundTruth& truth, const Normalization& to_unit) {
  std::vector<TrueEdge> edges;
  for (const auto& curve : truth.curves) {
    if (!curve.sharp || curve.polyline.cols() == 0) continue;
    edges.push_back({curve.type, curve.polyline});
    to_unit.apply(&edges.back().polyline);
  }
  return edges;
}

// Strokes of the prediction; each primitive by itself where nothing else is known.
std::vector<Eigen::Matrix3Xd> strokes_of(const Prediction& prediction) {
  if (!prediction.strokes.empty() || prediction.points_only) return prediction.strokes;
  std::vector<Eigen::Matrix3Xd> strokes;
  Prediction one;
  for (const auto& line : prediction.lines) {
    one.lines = {line};
    strokes.push_back(sample_arc_length(one, kStep));
  }
  one.lines.clear();
  for (const auto& curve : prediction.curves) {
    one.curves = {curve};
    strokes.push_back(sample_arc_length(one, kStep));
  }
  return strokes;
}

Score published_score(const Prediction& prediction, const Eigen::Matrix3Xd& truth,
                      Protocol protocol) {
  Eigen::Matrix3Xd samples =
      prediction.points_only ? prediction.points : sample_published(prediction, kStep);
  if (protocol == Protocol::kEmap) samples = voxel_average(samples, 256, -1, 1);
  if (protocol == Protocol::kCurveGaussian) samples = voxel_average(samples, 256, 0, 1);
  return score(as_float(samples), as_float(truth), {0.020, 0.010, 0.005, 0.002, 0.001});
}

Score fine_score(const Prediction& prediction, const Eigen::Matrix3Xd& truth) {
  const auto samples = [&](double step) {
    return prediction.points_only ? prediction.points : sample_arc_length(prediction, step);
  };
  Score fine = score(samples(kFineStep), truth, {0.005, 0.002, 0.001});
  const Score coarse = score(samples(kStep), truth, {});
  fine.accuracy = coarse.accuracy;
  fine.completeness = coarse.completeness;
  return fine;
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
  const Prediction unit = normalized(prediction, to_unit);
  const std::vector<TrueEdge> edges = true_edges(truth, to_unit);
  std::vector<Eigen::Matrix3Xd> parts;
  for (const TrueEdge& edge : edges) parts.push_back(densify(edge.polyline, kTruthStep));
  Eigen::Matrix3Xd samples = truth.samples, dense = concatenate(parts);
  to_unit.apply(&samples);
  if (samples.cols() == 0) samples = dense;
  if (dense.cols() == 0) dense = samples;
  if (samples.cols() == 0) throw InputError(truth.path, "edges", "none");

  Evaluation result;
  result.protocol = options.protocol;
  result.prediction_path = prediction.path;
  result.truth_path = truth.path;
  result.lines = int(prediction.lines.size());
  result.curves = int(prediction.curves.size());
  result.published = published_score(unit, samples, options.protocol);
  result.fine = fine_score(unit, dense);
  const std::vector<Eigen::Matrix3Xd> strokes = strokes_of(unit);
  result.has_curves = !edges.empty();
  result.has_strokes = !strokes.empty() || unit.points.cols() == 0;
  result.structure = match_strokes(strokes, merge_smooth(edges));
  return result;
}

}  // namespace sketchsplat
