// SPDX-License-Identifier: MIT
// Adam: Kingma, D., Ba, J.: Adam: a method for stochastic optimization, ICLR 2015.
#include "pipelines/optimize.h"

#include <algorithm>
#include <cmath>

#include "raster/render.h"

namespace sketchsplat {
namespace {

// Everything that descends, as one vector: nodes, handles, then per stroke the logarithm of the
// splats' width and of their optical depth.
struct Parameters {
  Eigen::VectorXd x;
  int nodes, handles, strokes;

  Parameters(const Sketch& s, double width, double depth)
      : nodes(int(s.nodes.size())), handles(int(s.handles.size())), strokes(s.size()) {
    x.resize(nodes + handles + 2 * strokes);
    x.head(nodes) = Eigen::Map<const Eigen::VectorXd>(s.nodes.data(), nodes);
    x.segment(nodes, handles) = Eigen::Map<const Eigen::VectorXd>(s.handles.data(), handles);
    x.segment(nodes + handles, strokes).setConstant(std::log(width));
    x.tail(strokes).setConstant(std::log(depth));
  }
  void write(Sketch* s) const {
    Eigen::Map<Eigen::VectorXd>(s->nodes.data(), nodes) = x.head(nodes);
    Eigen::Map<Eigen::VectorXd>(s->handles.data(), handles) = x.segment(nodes, handles);
  }
  double width(int stroke) const { return std::exp(x[nodes + handles + stroke]); }
  double depth(int stroke) const { return std::exp(x[nodes + handles + strokes + stroke]); }
};

struct Adam {
  Eigen::VectorXd first, second;
  int step = 0;

  // Moves x by at most about rate[i] against gradient g.
  void descend(const Eigen::VectorXd& g, const Eigen::VectorXd& rate, Eigen::VectorXd* x) {
    if (step == 0) first = second = Eigen::VectorXd::Zero(g.size());
    ++step;
    first = 0.8 * first + 0.2 * g;
    second = 0.95 * second + 0.05 * g.cwiseAbs2();
    const double c1 = 1 - std::pow(0.8, step), c2 = 1 - std::pow(0.95, step);
    for (int i = 0; i < g.size(); ++i)
      if (second[i] > 0) (*x)[i] -= rate[i] * (first[i] / c1) / std::sqrt(second[i] / c2);
  }
};

// A Gaussian per sample: as long as its piece of the stroke, so that their sum is an even ridge.
Splats dress(const SampleLayout& layout, const Samples& samples, const Parameters& p) {
  Splats s = Splats::zero(layout.size());
  s.mean = samples.position;
  s.tangent = samples.tangent;
  for (int i = 0; i < layout.size(); ++i) {
    s.along[i] = 0.7 * layout.length[i];
    s.across[i] = p.width(layout.stroke[i]);
    s.opacity[i] = p.depth(layout.stroke[i]);
  }
  return s;
}

}  // namespace

Eigen::MatrixXf sample_visibility(const Observation& o, int num_views, int gap) {
  Eigen::MatrixXf seen = Eigen::MatrixXf::Zero(o.layout.size(), num_views);
  for (const SampleMatch& m : o.matches.matches) seen(m.sample, m.view) = 1.f;
  Eigen::MatrixXf out = seen;
  for (int v = 0; v < num_views; ++v)
    for (size_t s = 0; s + 1 < o.layout.first.size(); ++s) {
      int last = -1;
      for (int i = o.layout.first[s]; i < o.layout.first[s + 1]; ++i) {
        if (seen(i, v) == 0) continue;
        if (last >= 0 && i - last <= gap + 1)
          for (int k = last + 1; k < i; ++k) out(k, v) = 1.f;
        last = i;
      }
    }
  return out;
}

std::vector<EdgeTarget> make_targets(const EdgeWorld& world, const OptimizeOptions& options) {
  if (options.steps <= 0) return {};
  std::vector<EdgeTarget> targets(world.views.size());
  LossOptions loss;
  loss.kind = LossKind::kSquared;
#pragma omp parallel for schedule(dynamic, 1)
  for (int v = 0; v < int(targets.size()); ++v)
    targets[v] = make_edge_target(draw_edge_map(world.maps[v], options.sigma_px), loss);
  return targets;
}

OptimizeResult optimize(const Sketch& sketch, const EdgeWorld& world,
                        const std::vector<EdgeTarget>& targets, const OptimizeOptions& options) {
  OptimizeResult result;
  result.sketch = sketch;
  if (options.steps <= 0 || sketch.size() == 0) return result;
  const int views = int(world.views.size());
  MatchOptions match;
  const Observation o = observe(sketch, world, match, options.spacing_px, 1);
  result.splats = o.layout.size();
  const Eigen::MatrixXf visibility =
      options.visibility ? sample_visibility(o, views, options.gap) : Eigen::MatrixXf();
  Parameters p(sketch, options.sigma_px * world.footprint, 1.0);
  Eigen::VectorXd rate(p.x.size());
  rate.head(p.nodes + p.handles).setConstant(options.step_px * world.footprint);
  rate.tail(2 * p.strokes).setConstant(0.05);
  Adam adam;
  const RasterOptions raster;
  for (int step = 0; step < options.steps; ++step) {
    p.write(&result.sketch);
    const Samples samples = evaluate_samples(result.sketch, o.layout);
    SplatGradient by_splat;
    const double loss = render_loss_views(dress(o.layout, samples, p), visibility, world.views,
                                          targets, raster, &by_splat)
                            .sum();
    if (step == 0) result.initial_loss = loss;
    result.final_loss = loss;
    const SketchGradient by_sketch =
        evaluate_samples_backward(result.sketch, o.layout, {by_splat.mean, by_splat.tangent});
    Eigen::VectorXd g = Eigen::VectorXd::Zero(p.x.size());
    g.head(p.nodes) = Eigen::Map<const Eigen::VectorXd>(by_sketch.nodes.data(), p.nodes);
    g.segment(p.nodes, p.handles) =
        Eigen::Map<const Eigen::VectorXd>(by_sketch.handles.data(), p.handles);
    for (int i = 0; i < o.layout.size(); ++i) {
      const int s = o.layout.stroke[i];
      g[p.nodes + p.handles + s] += by_splat.across[i] * p.width(s);
      g[p.nodes + p.handles + p.strokes + s] += by_splat.opacity[i] * p.depth(s);
    }
    const double fade = std::pow(0.1, double(step) / options.steps);
    adam.descend(g, rate * fade, &p.x);
  }
  p.write(&result.sketch);
  for (int s = 0; s < sketch.size(); ++s)
    result.sketch.evidence[s].opacity = 1 - std::exp(-p.depth(s) * 1.75);
  return result;
}

}  // namespace sketchsplat
