// SPDX-License-Identifier: MIT
#include "pipelines/survey/likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/types/median.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {
namespace {

constexpr int kEvery = 3;   // samples: the hull is coarse
constexpr int kRates = 10;  // shares of the views that see an edge, over which is integrated
constexpr double kMedian = 1.4826;  // median of absolute values of a standard deviation, inverse
constexpr int kManyViews = 8;       // see most strokes that are edges

// Edgels on strokes that many views see.
struct SureEdgels {
  std::vector<float> log_width, distance_px;
};

SureEdgels sure_edgels(const EdgeWorld& world, const Observation& every) {
  SureEdgels out;
  for (size_t s = 0; s + 1 < every.layout.first.size(); ++s) {
    const int first = every.layout.first[s], end = every.layout.first[s + 1];
    const int begin = every.matches.first[first], stop = every.matches.first[end];
    if (stop - begin < kManyViews * (end - first)) continue;
    for (int m = begin; m < stop; ++m) {
      const SampleMatch& match = every.matches.matches[m];
      const Edgel& e = world.maps[match.view].edgels[match.edgel];
      out.log_width.push_back(std::log(std::max(1e-3f, e.width)));
      out.distance_px.push_back(std::abs(match.distance_px));
    }
  }
  return out;
}

}  // namespace

double scatter_px(const EdgeWorld& world, const Observation& every) {
  SureEdgels edgels = sure_edgels(world, every);
  return edgels.distance_px.empty() ? 0 : kMedian * quantile(edgels.distance_px, 0.5);
}

StrokeJudge::StrokeJudge(const EdgeWorld& world, const Observation& every, double reach_px,
                         double sigma_px, const EvidenceModel& model)
    : world_(world), every_(every), model_(model) {
  sigma_ = std::max(model.least_sigma_px, sigma_px);
  SureEdgels edgels = sure_edgels(world, every);
  std::vector<float>& widths = edgels.log_width;
  if (!widths.empty()) {
    // What the cameras err counts, too: edgels of a view scatter about a line beside the stroke.
    sigma_ = std::max<double>(sigma_, kMedian * quantile(edgels.distance_px, 0.5));
    // Sharp edges are the narrow ones: their spread is that below the median.
    log_width_ = quantile(widths, 0.5);
    width_sigma_ = std::max(model.least_width_sigma, log_width_ - quantile(widths, 0.16));
  }
  peak_ = 2 * reach_px / (sigma_ * std::sqrt(2 * M_PI));
  const int strokes = int(every.layout.first.size()) - 1, views = int(world.views.size());
  in_view_.assign(strokes, std::vector<InView>(views));
  parallel_for(strokes, 1, [&](int s) {
    const int first = every.layout.first[s], n = every.layout.first[s + 1] - first;
    for (int v = 0; v < views; ++v) {
      const View& view = world.views[v];
      const Eigen::Vector3d camera = view.center_in_world();
      InView& in = in_view_[s][v];
      int asked = 0, sure = 0;
      for (int k = 0; k < n; ++k) {
        double depth;
        const Eigen::Vector3d x = every.samples.position.col(first + k);
        const Eigen::Vector2d p = view.project(x, &depth);
        if (!(depth > 0) || !view.camera.contains(p)) continue;
        in.inside += 1.0 / n;
        if (k % kEvery != std::min(n - 1, kEvery / 2)) continue;
        ++asked, sure += world.hull.surely_visible(x, camera);
      }
      in.sure = asked > 0 ? double(sure) / asked : 0;
    }
  });
}

double StrokeJudge::sharpness(float width_px) const {
  if (!(width_sigma_ > 0)) return 1;
  constexpr double kWidest = 1.5;  // of the logarithm: blur of four times and more
  const double r = std::max(0.0, std::log(std::max(1e-3f, width_px)) - log_width_) / width_sigma_;
  const double sharp = std::exp(-0.5 * r * r) / (width_sigma_ * std::sqrt(2 * M_PI));
  const double any = 1 / kWidest;
  return ((1 - model_.accident) * sharp + model_.accident * any) /
         ((1 - model_.blurred) * sharp + model_.blurred * any);
}

double StrokeJudge::nats(int stroke, const EdgelFlags* others) const {
  const int first = every_.layout.first[stroke], end = every_.layout.first[stroke + 1];
  const int views = int(world_.views.size());
  std::vector<double> found(views);  // sum of the ratios of places with an edgel
  std::vector<int> edgels(views);
  for (int i = first; i < end; ++i)
    for (int m = every_.matches.first[i]; m < every_.matches.first[i + 1]; ++m) {
      const SampleMatch& match = every_.matches.matches[m];
      const double r = match.distance_px / sigma_;
      const bool theirs = others && (*others)[match.view][match.edgel];
      const double near = model_.accident + (1 - model_.accident) * peak_ * std::exp(-0.5 * r * r);
      found[match.view] +=
          theirs ? 1 : near * sharpness(world_.maps[match.view].edgels[match.edgel].width);
      ++edgels[match.view];
    }
  const bool blind = world_.hull.empty();
  double sum = 0;
  // Without a hull nobody knows how many views something hides it from: all shares are as likely.
  std::array<double, kRates> blind_sum = {};
  for (int v = 0; v < views; ++v) {
    const InView& in = in_view_[stroke][v];
    if (!(in.inside > 0)) continue;
    const double places = std::max(in.inside * (end - first), double(edgels[v]));
    const double ratio = (found[v] + (places - edgels[v]) * model_.miss) / places;
    const double rate = in.sure * model_.sure_rate + (1 - in.sure) * model_.unsure_rate;
    sum += in.inside * std::log(1 - rate + rate * ratio);
    for (int k = 0; k < kRates; ++k) {
      const double share = (k + 0.5) / kRates;
      blind_sum[k] += in.inside * std::log(1 - share + share * ratio);
    }
  }
  if (!blind) return sum;
  const double most = *std::max_element(blind_sum.begin(), blind_sum.end());
  double mean = 0;
  for (const double s : blind_sum) mean += std::exp(s - most) / kRates;
  return most + std::log(mean);
}

}  // namespace sketchsplat
