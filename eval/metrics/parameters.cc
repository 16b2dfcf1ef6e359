// SPDX-License-Identifier: MIT
#include "eval/metrics/parameters.h"

#include "eval/metrics/junctions.h"
#include "eval/metrics/metrics.h"
#include "sketches/fit/fit.h"

namespace sketchsplat {
namespace {

constexpr double kCubicTolerance = 1e-3;
constexpr int kFitPoints = 60;

bool ends_meet(const Eigen::Matrix3Xd& p) {
  return p.cols() > 2 && (p.col(0) - p.rightCols<1>()).norm() < kMeeting;
}

// Cubics that follow a polyline, by halving. `depth` is a stop for what no cubic follows.
int cubics_along(const Eigen::Matrix3Xd& polyline, int depth) {
  const double length = polyline_length(polyline);
  if (!(length > kCubicTolerance) || depth == 0) return 1;
  const Eigen::Matrix3Xd points = resample(polyline, length / kFitPoints);
  const Eigen::Index n = points.cols(), half = n / 2;
  // A cubic from a point to itself is a poor start for the fit.
  if (!ends_meet(points)) {
    const Eigen::Vector3d begin = points.col(0), end = points.col(n - 1);
    const BezierFit fit = fit_bezier(points, begin, end);
    if (fit.success && fit.max_distance < kCubicTolerance) return 1;
  }
  return cubics_along(points.leftCols(half + 1), depth - 1) +
         cubics_along(points.rightCols(n - half), depth - 1);
}

// Ends of open curves that meet an end which was counted before.
int shared_ends(const std::vector<Eigen::Matrix3Xd>& curves, const std::vector<bool>& has_ends) {
  std::vector<Eigen::Matrix3Xd> open;
  for (size_t i = 0; i < curves.size(); ++i) {
    if (has_ends[i] && curves[i].cols() > 0) open.push_back(curves[i]);
  }
  return 2 * int(open.size()) - int(meeting_points(open).size());
}

}  // namespace

std::string kind_of_edge(const TrueEdge& edge) {
  if (edge.type == "line") return "line";
  const bool closed = ends_meet(edge.polyline);
  if (edge.type == "circle" || edge.type == "arc") return closed ? "circle" : "arc";
  if (edge.type == "ellipse") return closed ? "ellipse" : "elliptic_arc";
  return "bezier";
}

int degrees_of_freedom(const std::string& kind) {
  if (kind == "line" || kind == "circle") return 6;
  if (kind == "arc" || kind == "ellipse") return 8;
  if (kind == "elliptic_arc") return 10;
  return kind == "bezier" ? 12 : 0;
}

double count_parameters(const std::vector<Eigen::Matrix3Xd>& strokes,
                        const std::vector<StrokeFacts>& facts) {
  double count = 0;
  std::vector<bool> has_ends;
  for (const StrokeFacts& fact : facts) {
    count += fact.parameters;
    has_ends.push_back(fact.kind != "circle" && fact.kind != "ellipse");
  }
  return count - 3 * shared_ends(strokes, has_ends);
}

double count_true_parameters(const std::vector<TrueEdge>& edges) {
  double count = 0;
  std::vector<bool> has_ends;
  std::vector<Eigen::Matrix3Xd> curves;
  for (const TrueEdge& edge : edges) {
    const std::string kind = kind_of_edge(edge);
    const int pieces = kind == "bezier" ? cubics_along(edge.polyline, 6) : 1;
    count += degrees_of_freedom(kind) * pieces - 3 * (pieces - 1);
    has_ends.push_back(kind != "circle" && kind != "ellipse");
    curves.push_back(edge.polyline);
  }
  return count - 3 * shared_ends(curves, has_ends);
}

}  // namespace sketchsplat
