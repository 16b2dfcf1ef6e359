// SPDX-License-Identifier: MIT
#include "pipelines/kinds.h"

#include <utility>
#include <vector>

#include "pipelines/observe.h"
#include "sketches/curve.h"
#include "sketches/fit.h"

namespace sketchsplat {
namespace {

void add_line(const Eigen::Matrix3Xd& points, Sketch* out) {
  const LineFit fit = fit_line(points);
  if (!fit.success) return;
  Eigen::Vector3d begin = fit.begin, end = fit.end;
  if ((end - begin).dot(points.rightCols<1>() - points.leftCols<1>()) < 0) std::swap(begin, end);
  const int b = out->add_node(begin), e = out->add_node(end);
  out->add_stroke(StrokeKind::kLine, b, e, {});
}

void add_arc(const Eigen::Matrix3Xd& points, Sketch* out) {
  const ArcFit fit = fit_arc(points);
  if (!fit.success) return;
  const int b = out->add_node(fit.begin), e = out->add_node(fit.end);
  out->add_stroke(StrokeKind::kArc, b, e, {fit.apex});
}

// How much of the edgels a stroke explains: the sum of their weights.
std::vector<double> explained(const Sketch& sketch, const EdgeWorld& world) {
  MatchOptions match;
  match.reach_px = 1.0;
  match.exclusive = false;
  const Observation o = observe(sketch, world, match, 2.0, 1);
  std::vector<double> sum(sketch.size());
  for (const SampleMatch& m : o.matches.matches) sum[o.layout.stroke[m.sample]] += m.weight;
  return sum;
}

}  // namespace

Sketch choose_kinds(const Sketch& sketch, const EdgeWorld& world,
                    const PolishOptions& polish_options, const KindOptions& options) {
  Sketch simpler;
  std::vector<std::vector<int>> candidates(sketch.size());  // simplest first
  for (int s = 0; s < sketch.size(); ++s) {
    const StrokeKind kind = sketch.strokes[s].kind;
    if (kind == StrokeKind::kLine || is_closed(kind)) continue;
    const Eigen::Matrix3Xd points = sample_stroke(sketch, s, 2 * world.footprint);
    if (points.cols() < 3) continue;
    const int before = simpler.size();
    add_line(points, &simpler);
    if (kind != StrokeKind::kArc) add_arc(points, &simpler);
    for (int c = before; c < simpler.size(); ++c) candidates[s].push_back(c);
  }
  if (simpler.size() == 0) return sketch;
  PolishOptions alone = polish_options;
  alone.exclusive = false;
  simpler = polish(simpler, world, alone);
  const std::vector<double> now = explained(sketch, world), then = explained(simpler, world);
  Sketch out;
  for (int s = 0; s < sketch.size(); ++s) {
    const Sketch* from = &sketch;
    int index = s;
    for (int c : candidates[s])
      if (then[c] >= options.keep * now[s]) {
        from = &simpler, index = c;
        break;
      }
    const Stroke& stroke = from->strokes[index];
    std::vector<Eigen::Vector3d> handles;
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      handles.push_back(from->handles.col(stroke.handle + h));
    int begin = -1, end = -1;
    if (!is_closed(stroke.kind)) {
      begin = out.add_node(from->nodes.col(stroke.begin));
      end = out.add_node(from->nodes.col(stroke.end));
    }
    out.add_stroke(stroke.kind, begin, end, handles, sketch.evidence[s]);
  }
  return out;
}

}  // namespace sketchsplat
