// SPDX-License-Identifier: MIT
#include "sketches/solve/relations.h"

#include <ceres/dynamic_autodiff_cost_function.h>

#include <Eigen/Geometry>
#include <memory>

#include "sketches/curve/curve.h"
#include "sketches/curve/tangent_joint.h"
#include "sketches/solve/relation_cost.h"

namespace sketchsplat {
namespace {

template <typename T>
using Block = Eigen::Map<const Vec3<T>>;

// The circle through the control points of an arc or a circle; ellipses have no radius.
template <typename T>
void conic_of(StrokeKind kind, T const* const* p, Vec3<T>* centre, Vec3<T>* normal, T* radius) {
  if (kind == StrokeKind::kArc) {
    const ArcFrame<T> f = arc_frame<T>(Block<T>(p[0]), Block<T>(p[1]), Block<T>(p[2]));
    *centre = f.middle + f.up * (f.sagitta - f.radius);
    *normal = f.up.cross(f.along);
    *radius = f.radius;
    return;
  }
  *centre = Block<T>(p[0]);
  const Vec3<T> u = Block<T>(p[1]);
  if (kind == StrokeKind::kCircle) {
    *radius = u.norm();
    *normal = u / *radius;
    return;
  }
  const Vec3<T> v = Block<T>(p[2]);
  *normal = u.cross(v).normalized();
  *radius = T(0);
}

template <typename T>
Vec3<T> direction_of(StrokeKind kind, T const* const* p) {
  if (kind == StrokeKind::kLine)
    return (Vec3<T>(Block<T>(p[1])) - Vec3<T>(Block<T>(p[0]))).normalized();
  Vec3<T> centre, normal;
  T radius;
  conic_of<T>(kind, p, &centre, &normal, &radius);
  return normal;
}

// The blocks are those of the stroke or the point, then those of the shared quantities.
struct RelationResidual {
  Relation relation;
  StrokeKind kind = StrokeKind::kLine;
  int own = 0;                        // blocks of the stroke or the point
  bool at_end = false, arcs = false;  // tangent: of the first arc; is the other one an arc, too?
  Eigen::Vector3d origin;
  double factor = 1;  // on the residuals

  template <typename T>
  bool operator()(T const* const* p, T* r) const {
    const T scale(relation.scale * factor);
    if (relation.kind == RelationKind::kTangent) return tangent<T>(p, scale, r);
    const Vec3<T> first = Block<T>(p[own]);
    switch (relation.kind) {
      case RelationKind::kParallel: {
        const Vec3<T> miss = direction_of<T>(kind, p) * T(relation.sign) - first.normalized();
        Eigen::Map<Eigen::Matrix<T, 2, 1>> out(r);
        out = relation.across.cast<T>() * miss * scale;
        return true;
      }
      case RelationKind::kPerpendicular:
        r[0] = scale * first.normalized().dot(Vec3<T>(Block<T>(p[own + 1])).normalized());
        return true;
      case RelationKind::kCoplanar: {
        const Vec3<T> from = Vec3<T>(Block<T>(p[0])) - origin.cast<T>();
        r[0] = scale * (first.normalized().dot(from) - p[own + 1][0]);
        return true;
      }
      case RelationKind::kCoaxial: {
        Vec3<T> centre, normal;
        T radius;
        conic_of<T>(kind, p, &centre, &normal, &radius);
        const Vec3<T> along = first.normalized();
        Vec3<T> miss = centre - Vec3<T>(Block<T>(p[own + 1]));
        miss -= along * along.dot(miss);
        Eigen::Map<Eigen::Matrix<T, 2, 1>> out(r);
        out = relation.across.cast<T>() * miss * scale;
        return true;
      }
      case RelationKind::kEqualRadius: {
        Vec3<T> centre, normal;
        T radius;
        conic_of<T>(kind, p, &centre, &normal, &radius);
        r[0] = scale * (radius - p[own][0]);
        return true;
      }
      case RelationKind::kSymmetric: {
        const Vec3<T> a = Block<T>(p[0]), b = Block<T>(p[1]), n = first.normalized();
        Eigen::Map<Vec3<T>> out(r);
        out.template head<2>() = relation.across.cast<T>() * (b - a - n * n.dot(b - a)) * scale;
        const Vec3<T> middle = (a + b) * T(0.5) - origin.cast<T>();
        r[2] = scale * (n.dot(middle) - p[own + 1][0]);
        return true;
      }
      case RelationKind::kTangent:
        break;
    }
    return false;
  }

  // The unit tangents of both strokes, away from their node, add up to nothing.
  template <typename T>
  bool tangent(T const* const* p, const T& scale, T* r) const {
    const Block<T> node(p[at_end ? 2 : 0]), far(p[at_end ? 0 : 2]), other(p[arcs ? 4 : 3]);
    const Vec3<T> u = arc_tangent<T>(node, Block<T>(p[1]), far);
    const Vec3<T> v = arcs ? arc_tangent<T>(node, Block<T>(p[3]), other) : Vec3<T>(other - node);
    Eigen::Map<Eigen::Matrix<T, 2, 1>> out(r);
    out = relation.across.cast<T>() * (u.normalized() + v.normalized()) * scale;
    return true;
  }
};

int num_residuals(RelationKind kind) {
  switch (kind) {
    case RelationKind::kSymmetric:
      return 3;
    case RelationKind::kParallel:
    case RelationKind::kCoaxial:
    case RelationKind::kTangent:
      return 2;
    default:
      return 1;
  }
}

using Cost = ceres::DynamicAutoDiffCostFunction<RelationResidual, 12>;

Cost* make_cost(const Sketch& sketch, const Relations& relations, const Relation& relation,
                double factor) {
  auto* residual = new RelationResidual;
  residual->relation = relation;
  residual->origin = relations.origin;
  residual->factor = factor;
  if (relation.stroke >= 0) {
    const Stroke& stroke = sketch.strokes[relation.stroke];
    residual->kind = stroke.kind;
    residual->own = num_handles(stroke.kind) + (is_closed(stroke.kind) ? 0 : 2);
    residual->at_end = stroke.end == relation.point;
    residual->arcs =
        relation.partner >= 0 && sketch.strokes[relation.partner].kind == StrokeKind::kArc;
  } else {
    residual->own = (relation.point >= 0) + (relation.twin >= 0);
  }
  auto* cost = new Cost(residual);
  for (size_t i = 0; i < relation_blocks(sketch, relations, relation).size(); ++i)
    cost->AddParameterBlock(3);
  cost->SetNumResiduals(num_residuals(relation.kind));
  return cost;
}

}  // namespace

const char* relation_name(RelationKind kind) {
  constexpr const char* kNames[] = {"parallel",     "perpendicular", "coplanar", "coaxial",
                                    "equal_radius", "symmetric",     "tangent"};
  return kNames[int(kind)];
}

std::vector<int> relation_blocks(const Sketch& sketch, const Relations& relations,
                                 const Relation& relation) {
  const int nodes = int(sketch.nodes.cols()), shared = nodes + int(sketch.handles.cols());
  std::vector<int> blocks;
  if (relation.stroke >= 0) {
    const Stroke& s = sketch.strokes[relation.stroke];
    if (!is_closed(s.kind)) blocks.push_back(s.begin);
    for (int h = 0; h < num_handles(s.kind); ++h) blocks.push_back(nodes + s.handle + h);
    if (!is_closed(s.kind)) blocks.push_back(s.end);
  } else if (relation.point >= 0) {
    blocks.push_back(relation.point);
    if (relation.twin >= 0) blocks.push_back(relation.twin);
  }
  if (relation.partner >= 0) {
    const Stroke& s = sketch.strokes[relation.partner];
    if (s.kind == StrokeKind::kArc) blocks.push_back(nodes + s.handle);
    blocks.push_back(other_end(s, relation.point));
  }
  if (relation.shared < 0) return blocks;
  const int direction = relations.shared[relation.shared].direction;
  if (direction >= 0) blocks.push_back(shared + direction);
  blocks.push_back(shared + relation.shared);
  if (relation.other >= 0) blocks.push_back(shared + relation.other);
  return blocks;
}

RelationRows linearize(const Sketch& sketch, const Relations& relations, const Relation& relation) {
  RelationRows rows;
  rows.blocks = relation_blocks(sketch, relations, relation);
  const int nodes = int(sketch.nodes.cols()), shared = nodes + int(sketch.handles.cols());
  const int n = num_residuals(relation.kind), count = int(rows.blocks.size());
  std::vector<const double*> parameters;
  for (int b : rows.blocks)
    parameters.push_back(b < nodes    ? sketch.nodes.col(b).data()
                         : b < shared ? sketch.handles.col(b - nodes).data()
                                      : relations.shared[b - shared].value.data());
  using Row = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  std::vector<Row> pieces(count, Row(n, 3));
  std::vector<double*> jacobians;
  for (Row& piece : pieces) jacobians.push_back(piece.data());
  rows.residual.resize(n);
  const std::unique_ptr<Cost> cost(make_cost(sketch, relations, relation, 1));
  cost->Evaluate(parameters.data(), rows.residual.data(), jacobians.data());
  rows.jacobian.resize(n, 3 * count);
  for (int i = 0; i < count; ++i) rows.jacobian.middleCols(3 * i, 3) = pieces[i];
  return rows;
}

ceres::CostFunction* make_relation_cost(const Sketch& sketch, const Relations& relations,
                                        const Relation& relation) {
  return make_cost(sketch, relations, relation, 1 / relation.sigma);
}

std::vector<Relation> tangent_relations(const Sketch& sketch, double angle) {
  std::vector<Relation> out;
  for (const TangentJoint& joint : find_tangent_joints(sketch, angle)) {
    const Eigen::Vector3d along = tangent_out(sketch, joint.arc, joint.node);
    const Eigen::Vector3d normal = stroke_direction(sketch, joint.arc);
    Relation r;
    r.kind = RelationKind::kTangent;
    r.stroke = joint.arc;
    r.partner = joint.other;
    r.point = joint.node;
    r.across << normal.cross(along).transpose(), normal.transpose();
    out.push_back(r);
  }
  return out;
}

Eigen::Vector3d stroke_direction(const Sketch& sketch, int stroke) {
  const StrokeKind kind = sketch.strokes[stroke].kind;
  if (kind == StrokeKind::kBezier) return Eigen::Vector3d::Zero();
  const ControlPoints c = control_points(sketch, stroke);
  const double* p[4] = {c.p[0].data(), c.p[1].data(), c.p[2].data(), c.p[3].data()};
  const Eigen::Vector3d d = direction_of<double>(kind, p);
  return d.allFinite() && d.norm() > 0.5 ? d : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace sketchsplat
