// SPDX-License-Identifier: MIT
#include "sketches/solve/refine_sketch.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/types/dense.h"
#include "sketches/curve/curve.h"
#include "sketches/graph/smooth_joint.h"
#include "sketches/solve/relation_cost.h"

namespace sketchsplat {
namespace {

// |root (x(t) - target)|^2 for one sample of a curve.
struct SampleResidual {
  StrokeKind kind;
  double t;
  Eigen::Matrix3d root;
  Eigen::Vector3d target;

  template <typename T>
  bool apply(const T* const* p, int count, T* residual) const {
    Vec3<T> control[4], position, derivative;
    for (int i = 0; i < count; ++i) control[i] = Eigen::Map<const Vec3<T>>(p[i]);
    evaluate_curve<T>(kind, control, t, &position, &derivative);
    Eigen::Map<Vec3<T>> r(residual);
    r = root.cast<T>() * (position - target.cast<T>());
    return true;
  }
  template <typename T>
  bool operator()(const T* a, const T* b, T* r) const {
    const T* p[] = {a, b};
    return apply(p, 2, r);
  }
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* r) const {
    const T* p[] = {a, b, c};
    return apply(p, 3, r);
  }
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, const T* d, T* r) const {
    const T* p[] = {a, b, c, d};
    return apply(p, 4, r);
  }
};

// Sine between the tangents of a smooth joint.
struct SmoothResidual {
  double root_weight;
  template <typename T>
  bool operator()(const T* a, const T* node, const T* b, T* r) const {
    using Map = Eigen::Map<const Vec3<T>>;
    const Vec3<T> u = Map(a) - Map(node), v = Map(b) - Map(node);
    Eigen::Map<Vec3<T>> out(r);
    out = u.cross(v) * (T(root_weight) / sqrt(u.squaredNorm() * v.squaredNorm() + T(1e-300)));
    return true;
  }
};

struct Hold {
  double weight;
  Eigen::Vector3d place;
  template <typename T>
  bool operator()(const T* p, T* r) const {
    for (int k = 0; k < 3; ++k) r[k] = weight * (p[k] - place[k]);
    return true;
  }
};

ceres::CostFunction* make_cost(int count, SampleResidual* residual) {
  if (count == 2) return new ceres::AutoDiffCostFunction<SampleResidual, 3, 3, 3>(residual);
  if (count == 3) return new ceres::AutoDiffCostFunction<SampleResidual, 3, 3, 3, 3>(residual);
  return new ceres::AutoDiffCostFunction<SampleResidual, 3, 3, 3, 3, 3>(residual);
}

// information = root^T root; target = the sample's place of least cost.
void factor(const Eigen::Matrix3d& information, const Eigen::Vector3d& slope,
            const Eigen::Vector3d& position, SampleResidual* out) {
  const auto es = eigen_symmetric(information);
  const Eigen::Vector3d values = es.values.cwiseMax(0);
  out->root = values.cwiseSqrt().asDiagonal() * es.vectors.transpose();
  Eigen::Vector3d move = es.vectors.transpose() * slope;
  for (int k = 0; k < 3; ++k) move[k] = values[k] > 1e-6 * values[2] ? -move[k] / values[k] : 0;
  out->target = position + es.vectors * move;
}

double cost_of(const Sketch& sketch, const SampleLayout& layout, const Samples& before,
               const SampleQuadratics& q) {
  const Samples now = evaluate_samples(sketch, layout);
  double sum = 0;
  for (int i = 0; i < layout.size(); ++i) {
    const Eigen::Vector3d d = now.position.col(i) - before.position.col(i);
    sum += d.dot(q.information[i] * d) + 2 * d.dot(q.slope.col(i));
  }
  return sum;
}

void add_smooth_joints(const RefineSketchOptions& options, Sketch* s, ceres::Problem* problem) {
  const auto data = [&](const TangentEnd& e) {
    return (e.is_node ? s->nodes : s->handles).col(e.column).data();
  };
  for (const SmoothJoint& joint : find_smooth_joints(*s, options.smooth_angle)) {
    double* const blocks[] = {data(joint.before), s->nodes.col(joint.node).data(),
                              data(joint.after)};
    // Not where no edgel says anything.
    if (!problem->HasParameterBlock(blocks[0]) || !problem->HasParameterBlock(blocks[2])) continue;
    problem->AddResidualBlock(new ceres::AutoDiffCostFunction<SmoothResidual, 3, 3, 3, 3>(
                                  new SmoothResidual{std::sqrt(options.smooth_weight)}),
                              nullptr, blocks[0], blocks[1], blocks[2]);
  }
}

std::vector<double*> blocks_of(const Relation& relation, Relations* relations, Sketch* s) {
  const int nodes = int(s->nodes.cols()), shared = nodes + int(s->handles.cols());
  std::vector<double*> blocks;
  for (const int b : relation_blocks(*s, *relations, relation))
    blocks.push_back(b < nodes    ? s->nodes.col(b).data()
                     : b < shared ? s->handles.col(b - nodes).data()
                                  : relations->shared[b - shared].value.data());
  return blocks;
}

constexpr double kMostHeldTurn = 0.8;  // [rad] of a joint that is to become tangent

void add_tangent_joints(const RefineSketchOptions& options, Sketch* s, ceres::Problem* problem) {
  const double root_weight = std::sqrt(options.smooth_weight);
  Relations none;
  for (Relation& joint : tangent_relations(*s, kMostHeldTurn)) {
    if (!options.tangent[joint.point]) continue;
    const std::vector<double*> blocks = blocks_of(joint, &none, s);
    // Not where no edgel says anything.
    if (!std::all_of(blocks.begin(), blocks.end(),
                     [&](double* b) { return problem->HasParameterBlock(b); }))
      continue;
    joint.scale = root_weight;
    problem->AddResidualBlock(make_relation_cost(*s, none, joint), nullptr, blocks);
  }
}

// Their directions stay unit vectors; a point on an axis stays where it is along it.
void add_relations(Relations* relations, double hold, Sketch* s, ceres::Problem* problem) {
  for (const Relation& relation : relations->list) {
    const std::vector<double*> blocks = blocks_of(relation, relations, s);
    problem->AddResidualBlock(make_relation_cost(*s, *relations, relation), nullptr, blocks);
  }
  for (SharedQuantity& q : relations->shared) {
    double* block = q.value.data();
    if (!problem->HasParameterBlock(block)) continue;
    if (q.kind == SharedKind::kDirection)
      problem->SetManifold(block, new ceres::SphereManifold<3>);
    else
      problem->AddResidualBlock(
          new ceres::AutoDiffCostFunction<Hold, 3, 3>(new Hold{0.1 * hold, q.value}), nullptr,
          block);
  }
}

}  // namespace

RefineSketchResult refine_sketch(const Sketch& sketch, const SampleLayout& layout,
                                 const SampleQuadratics& quadratics,
                                 const RefineSketchOptions& options, Relations* relations) {
  RefineSketchResult result;
  result.sketch = sketch;
  Sketch& s = result.sketch;
  const Samples before = evaluate_samples(sketch, layout);
  ceres::Problem problem;
  double trace = 0;
  std::vector<double*> blocks;
  for (int i = 0; i < layout.size(); ++i) {
    const double strength = quadratics.information[i].trace();
    if (!(strength > 0) || !quadratics.slope.col(i).allFinite()) continue;
    trace += strength;
    const Stroke& stroke = s.strokes[layout.stroke[i]];
    auto* residual = new SampleResidual;
    residual->kind = stroke.kind;
    residual->t = layout.t[i];
    factor(quadratics.information[i], quadratics.slope.col(i), before.position.col(i), residual);
    blocks.clear();
    if (!is_closed(stroke.kind)) blocks.push_back(s.nodes.col(stroke.begin).data());
    for (int h = 0; h < num_handles(stroke.kind); ++h)
      blocks.push_back(s.handles.col(stroke.handle + h).data());
    if (!is_closed(stroke.kind)) blocks.push_back(s.nodes.col(stroke.end).data());
    if (blocks.size() == 2 && blocks[0] == blocks[1]) {
      delete residual;
      continue;
    }
    if (!is_closed(stroke.kind) && stroke.begin == stroke.end) {
      delete residual;  // a loop through one node: the solver wants distinct blocks; it stays
      continue;
    }
    problem.AddResidualBlock(make_cost(int(blocks.size()), residual), nullptr, blocks);
  }
  if (problem.NumResidualBlocks() == 0) return result;
  const double hold = std::sqrt(options.stiffness * trace / problem.NumResidualBlocks());
  if (options.smooth_angle > 0) add_smooth_joints(options, &s, &problem);
  if (!options.tangent.empty()) add_tangent_joints(options, &s, &problem);
  // By index: the solver itself lists blocks by address, which is another every time.
  for (Eigen::Matrix3Xd* points : {&s.nodes, &s.handles})
    for (int i = 0; i < points->cols(); ++i) {
      double* block = points->col(i).data();
      if (problem.HasParameterBlock(block))
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<Hold, 3, 3>(new Hold{hold, points->col(i)}), nullptr,
            block);
    }
  if (relations) add_relations(relations, hold, &s, &problem);
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.max_iterations;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  result.final_cost = cost_of(s, layout, before, quadratics);
  if (!s.nodes.allFinite() || !s.handles.allFinite()) result.sketch = sketch, result.final_cost = 0;
  return result;
}

}  // namespace sketchsplat
