// SPDX-License-Identifier: MIT
// Adam: Kingma, D., Ba, J.: Adam: a method for stochastic optimization, ICLR 2015.
#include "pipelines/adjust/optimize.h"

#include <algorithm>
#include <cmath>

#include "datasets/types/parallel.h"
#include "raster/splats/render.h"

namespace sketchsplat {
namespace {

// Where the loss of a long edge is least: its splats overlap, and what they let through falls
// faster aside than their depth does. In widths of the edge maps, and optical.
constexpr double kStepPx = 0.15;  // length of the first steps; falls to a tenth in a round
constexpr double kWidth = 0.78, kDepth = 0.95;

// Everything that descends, as one vector: nodes, handles, then per stroke the logarithm of the
// splats' width and of their optical depth.
Eigen::VectorXd to_vector(const Eigen::Matrix3Xd& nodes, const Eigen::Matrix3Xd& handles,
                          const Eigen::VectorXd& log_width, const Eigen::VectorXd& log_depth) {
  Eigen::VectorXd x(nodes.size() + handles.size() + log_width.size() + log_depth.size());
  x << Eigen::Map<const Eigen::VectorXd>(nodes.data(), nodes.size()),
      Eigen::Map<const Eigen::VectorXd>(handles.data(), handles.size()), log_width, log_depth;
  return x;
}

void from_vector(const Eigen::VectorXd& x, Drawing* d) {
  const Eigen::Index nodes = d->sketch.nodes.size(), handles = d->sketch.handles.size();
  const Eigen::Index strokes = d->width.size();
  Eigen::Map<Eigen::VectorXd>(d->sketch.nodes.data(), nodes) = x.head(nodes);
  Eigen::Map<Eigen::VectorXd>(d->sketch.handles.data(), handles) = x.segment(nodes, handles);
  d->width = x.segment(nodes + handles, strokes).array().exp();
  d->depth = x.tail(strokes).array().exp();
}

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

}  // namespace

Splats draw_splats(const Drawing& drawing, const SampleLayout& layout) {
  const Samples samples = evaluate_samples(drawing.sketch, layout);
  Splats s = Splats::zero(layout.size());
  s.mean = samples.position;
  s.tangent = samples.tangent;
  for (int i = 0; i < layout.size(); ++i) {
    s.along[i] = 0.7 * layout.length[i];
    s.across[i] = drawing.width[layout.stroke[i]];
    s.opacity[i] = drawing.depth[layout.stroke[i]];
  }
  return s;
}

double edge_loss(const Drawing& drawing, const SampleLayout& layout,
                 const Eigen::MatrixXf& visibility, const std::vector<View>& views,
                 const std::vector<EdgeTarget>& targets, DrawingGradient* gradient) {
  SplatGradient by_splat;
  const double loss = render_loss_views(draw_splats(drawing, layout), visibility, views, targets,
                                        RasterOptions(), gradient ? &by_splat : nullptr)
                          .sum();
  if (!gradient) return loss;
  gradient->sketch =
      evaluate_samples_backward(drawing.sketch, layout, {by_splat.mean, by_splat.tangent});
  gradient->log_width = gradient->log_depth = Eigen::VectorXd::Zero(drawing.sketch.size());
  for (int i = 0; i < layout.size(); ++i) {
    const int s = layout.stroke[i];
    gradient->log_width[s] += by_splat.across[i] * drawing.width[s];
    gradient->log_depth[s] += by_splat.opacity[i] * drawing.depth[s];
  }
  return loss;
}

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
  parallel_for(int(targets.size()), 1, [&](int v) {
    targets[v] = make_edge_target(draw_edge_map(world.maps[v], options.sigma_px));
  });
  return targets;
}

OptimizeResult optimize(const Sketch& sketch, const EdgeWorld& world,
                        const std::vector<EdgeTarget>& targets, const OptimizeOptions& options) {
  OptimizeResult result;
  result.sketch = sketch;
  if (options.steps <= 0 || sketch.size() == 0) return result;
  const int views = int(world.views.size());
  MatchOptions match;
  match.quadratics = false;
  const Observation o = observe(sketch, world, match, options.spacing_px);
  result.splats = o.layout.size();
  const Eigen::MatrixXf visibility =
      options.visibility ? sample_visibility(o, views, options.gap) : Eigen::MatrixXf();
  const int strokes = sketch.size();
  Drawing drawing{sketch,
                  Eigen::VectorXd::Constant(strokes, kWidth * options.sigma_px * world.footprint),
                  Eigen::VectorXd::Constant(strokes, kDepth)};
  Eigen::VectorXd x = to_vector(sketch.nodes, sketch.handles, drawing.width.array().log(),
                                drawing.depth.array().log());
  Eigen::VectorXd rate = Eigen::VectorXd::Constant(x.size(), kStepPx * world.footprint);
  rate.tail(2 * strokes).setConstant(0.05);
  Adam adam;
  for (int step = 0; step < options.steps && !options.deadline.passed(); ++step) {
    DrawingGradient g;
    const double loss = edge_loss(drawing, o.layout, visibility, world.views, targets, &g);
    if (step == 0) result.initial_loss = loss;
    const double fade = std::pow(0.1, double(step) / options.steps);
    adam.descend(to_vector(g.sketch.nodes, g.sketch.handles, g.log_width, g.log_depth), rate * fade,
                 &x);
    from_vector(x, &drawing);
  }
  result.final_loss = edge_loss(drawing, o.layout, visibility, world.views, targets, nullptr);
  result.sketch = drawing.sketch;
  for (int s = 0; s < strokes; ++s)
    result.sketch.evidence[s].opacity = 1 - std::exp(-drawing.depth[s] * 1.75);
  return result;
}

}  // namespace sketchsplat
