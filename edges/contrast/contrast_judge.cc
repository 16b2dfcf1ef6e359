// SPDX-License-Identifier: MIT
#include "edges/contrast/contrast_judge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "sketches/curve/curve.h"

namespace sketchsplat {
namespace {

constexpr int kScales = 5;       // 1, 2, 4, 8, 16
constexpr int kRates = 10;       // shares of the views that show an edge, over which is integrated
constexpr double kAsidePx = 5;   // [px] of copies in space
constexpr double kSmallPx = 30;  // [px] across a closed curve that copies cross

std::vector<int> pieces_of(int points, double piece_px) {
  const int pieces = std::max(1, int(std::lround(points / piece_px)));
  std::vector<int> first;
  for (int p = 0; p <= pieces; ++p) first.push_back(int(int64_t(points) * p / pieces));
  return first;
}

// A closed curve less than so far across.
bool is_small(const CurvePoints& curve, double most) {
  const Eigen::Matrix3Xd& p = curve.position;
  return closes(curve) && (p.col(0) - p.col(p.cols() / 2)).norm() < most;
}

// Sums of a likelihood ratio over views: those that must show the edge, and others.
class Pool {
 public:
  explicit Pool(const ContrastOptions& options) : options_(options) {}

  void add(double ratio, bool sure) {
    if (sure) {
      sum_ += std::log(1 - options_.sure_rate + options_.sure_rate * ratio);
      return;
    }
    for (int k = 0; k < kRates; ++k) {
      const double rate = (k + 0.5) / kRates;
      by_rate_[k] += std::log(1 - rate + rate * ratio);
    }
  }
  double nats() const {
    const double most = *std::max_element(by_rate_.begin(), by_rate_.end());
    double mean = 0;
    for (const double s : by_rate_) mean += std::exp(s - most) / kRates;
    return sum_ + most + std::log(mean);
  }

 private:
  const ContrastOptions& options_;
  double sum_ = 0;
  std::array<double, kRates> by_rate_ = {};
};

}  // namespace

double contrast_ratio(double z, double freedom) {
  const auto density = [&](double t) {
    return std::pow(1 + t * t / freedom, -0.5 * (freedom + 1));
  };
  double edge = 0;
  for (int k = 0; k < kScales; ++k) edge += std::ldexp(density(std::ldexp(z, -k)), -k) / kScales;
  return std::log(edge / density(z));
}

ContrastJudge::ContrastJudge(const EdgeWorld& world, const CurvePoints& strokes,
                             const std::vector<std::vector<char>>& explained,
                             const ContrastOptions& options)
    : world_(world), options_(options), known_(known_edges(world, strokes, explained)) {}

ContrastEvidence ContrastJudge::judge(const CurvePoints& curve, int every,
                                      const std::vector<Window>& windows) const {
  return judge_without(nullptr, curve, every, windows);
}

ContrastEvidence ContrastJudge::judge_without(const CurvePoints* other, const CurvePoints& curve,
                                              int every, const std::vector<Window>& windows) const {
  const std::vector<int> first = pieces_of(int(curve.position.cols()), options_.piece_px);
  const int pieces = int(first.size()) - 1;
  ContrastEvidence out;
  out.piece_nats.assign(pieces, 0);
  // What lies along a candidate by accident lies along all of its pieces.
  const auto doubted = [&](double log_ratio) {
    return 1 / (options_.accident + (1 - options_.accident) * std::exp(-log_ratio));
  };
  for (int v = 0; v < int(world_.views.size()); ++v) {
    const Eigen::Vector3d camera = world_.views[v].center_in_world();
    const auto middle_of = [&](int p) -> Eigen::Vector3d {
      return curve.position.col((first[p] + first[p + 1]) / 2);
    };
    std::vector<char> shut(pieces, 0);
    if (!windows.empty())
      for (int p = 0; p < pieces; ++p) shut[p] = !any_lets_through(windows, middle_of(p), camera);
    const bool any_shut = std::count(shut.begin(), shut.end(), 1) > 0;
    if (any_shut && std::count(shut.begin(), shut.end(), 1) == pieces) continue;
    const std::vector<ContrastReading> readings =
        read_contrasts(world_, v, curve, first, known_, every, other);
    double sum = 0;
    int tell = 0, sure = 0;
    std::vector<double> each(pieces);
    for (int p = 0; p < pieces; ++p) {
      if (!readings[p].tells || shut[p]) continue;
      const bool seen = world_.hull.surely_visible(middle_of(p), camera);
      const double ratio = std::exp(contrast_ratio(readings[p].z, readings[p].freedom));
      const double shown = std::log(1 - options_.piece_rate + options_.piece_rate * ratio);
      sum += shown, each[p] = std::log(doubted(shown));
      ++tell, sure += seen;
    }
    if (tell == 0) continue;
    const ContrastReading& all = readings[pieces];
    if (all.tells && pieces > 1 && !any_shut)
      sum = std::log(0.5 * std::exp(sum) + 0.5 * std::exp(contrast_ratio(all.z, all.freedom)));
    out.says.push_back({v, doubted(sum), 2 * sure > tell});
    if (!(sum > 0)) continue;
    ++out.views;
    for (int p = 0; p < pieces; ++p) out.piece_nats[p] += each[p];
  }
  Pool whole(options_);
  for (const ViewSays& s : out.says) whole.add(s.ratio, s.sure);
  out.nats = whole.nats();
  return out;
}

double ContrastJudge::nats_through(const ContrastEvidence& evidence, const Window& window,
                                   const Eigen::Vector3d& point) const {
  Pool pool(options_);
  for (const ViewSays& s : evidence.says)
    if (window.lets_through(point, world_.views[s.view].center_in_world()))
      pool.add(s.ratio, s.sure);
  return pool.nats();
}

void ContrastJudge::take(const CurvePoints& curve) {
  const std::vector<int> first = pieces_of(int(curve.position.cols()), options_.piece_px);
  for (int v = 0; v < int(world_.views.size()); ++v) {
    double sum = 0;
    for (const ContrastReading& r : read_contrasts(world_, v, curve, first, known_, 1))
      sum += r.tells ? contrast_ratio(r.z, r.freedom) : 0;
    if (sum > 0) add_known(world_, v, curve, &known_);
  }
}

double ContrastJudge::beside(const CurvePoints& curve, const std::vector<Window>& windows) const {
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  for (int i = 0; i < curve.tangent.cols(); ++i) {
    const Eigen::Vector3d t = curve.tangent.col(i);
    along += along.dot(t) < 0 ? Eigen::Vector3d(-t) : t;
  }
  Eigen::Vector3d x, y;
  frame_of<double>(along.norm() > 0 ? along.normalized() : Eigen::Vector3d::UnitZ(), &x, &y);
  const CurvePoints* other = is_small(curve, kSmallPx * world_.footprint) ? &curve : nullptr;
  double most = -INFINITY;
  for (const Eigen::Vector3d& way : {x, y, Eigen::Vector3d(-x), Eigen::Vector3d(-y)}) {
    CurvePoints copy = curve;
    copy.position.colwise() += kAsidePx * world_.footprint * way;
    most = std::max(most, judge_without(other, copy, 1, windows).nats);
  }
  return most;
}

}  // namespace sketchsplat
