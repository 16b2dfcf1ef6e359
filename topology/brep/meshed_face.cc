// SPDX-License-Identifier: MIT
#include "topology/brep/meshed_face.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

#include "topology/brep/geometry.h"

namespace sketchsplat::brep {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double area_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a).norm() / 2;
}

// Weights of the corners at the point of a segment that is nearest to p.
double along(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0;
}

// Weights of the corners at the point of a triangle that is nearest to p.
Vector3d nearest_weights(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                         const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const double n2 = normal.squaredNorm();
  if (n2 > 0) {
    const double v = (p - a).cross(c - a).dot(normal) / n2;
    const double w = (b - a).cross(p - a).dot(normal) / n2;
    if (v >= 0 && w >= 0 && v + w <= 1) return {1 - v - w, v, w};
  }
  const double ab = along(p, a, b), bc = along(p, b, c), ca = along(p, c, a);
  const std::array<Vector3d, 3> weights = {Vector3d(1 - ab, ab, 0), Vector3d(0, 1 - bc, bc),
                                           Vector3d(ca, 0, 1 - ca)};
  return *std::min_element(weights.begin(), weights.end(),
                           [&](const Vector3d& x, const Vector3d& y) {
                             const auto off = [&](const Vector3d& k) {
                               return (k[0] * a + k[1] * b + k[2] * c - p).squaredNorm();
                             };
                             return off(x) < off(y);
                           });
}

}  // namespace

MeshedFace::MeshedFace(const TopoDS_Face& face, double deflection)
    : kind_(BRepAdaptor_Surface(face, /*Restriction=*/false).GetType()),
      deflection_(deflection),
      surface_(new ShapeAnalysis_Surface(BRep_Tool::Surface(face))) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
  if (mesh.IsNull() || !mesh->HasUVNodes()) return;
  for (int i = 1; i <= mesh->NbNodes(); ++i) {
    points_.push_back(to_eigen(mesh->Node(i).Transformed(location.Transformation())));
    uv_.emplace_back(mesh->UVNode(i).X(), mesh->UVNode(i).Y());
    box_.extend(points_.back());
  }
  for (int t = 1; t <= mesh->NbTriangles(); ++t) {
    int a, b, c;
    mesh->Triangle(t).Get(a, b, c);
    triangles_.push_back({a - 1, b - 1, c - 1});
    area_ += area_of(points_[a - 1], points_[b - 1], points_[c - 1]);
  }
  make_chunks();
}

// Triangles that are near one another, in boxes: halved along their longest side until few are
// left.
void MeshedFace::make_chunks() {
  constexpr int kPerChunk = 12;
  std::vector<std::pair<int, int>> open = {{0, int(triangles_.size())}};
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    Chunk chunk{{}, begin, end};
    for (int t = begin; t < end; ++t)
      for (const int k : triangles_[size_t(t)]) chunk.box.extend(points_[size_t(k)]);
    if (end - begin <= kPerChunk) {
      if (end > begin) chunks_.push_back(chunk);
      continue;
    }
    int axis;
    chunk.box.sizes().maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle,
                     triangles_.begin() + end, [&](const auto& x, const auto& y) {
                       return points_[size_t(x[0])][axis] < points_[size_t(y[0])][axis];
                     });
    open.push_back({begin, middle});
    open.push_back({middle, end});
  }
}

std::vector<Vector3d> MeshedFace::places(double spacing, int least) const {
  const double step = std::min(spacing * spacing, area_ / least);
  // Along the triangles as if their areas were laid on a line, and scattered inside of each.
  constexpr double kA = 0.7548776662466927, kB = 0.5698402909980532;  // of the plastic number
  std::vector<Vector3d> out;
  double passed = 0;
  for (const auto& [a, b, c] : triangles_) {
    passed += area_of(points_[a], points_[b], points_[c]);
    while (passed > (double(out.size()) + 0.5) * step) {
      double v = std::fmod(0.5 + kA * double(out.size()), 1.0),
             w = std::fmod(0.5 + kB * double(out.size()), 1.0);
      if (v + w > 1) v = 1 - v, w = 1 - w;
      const Vector2d uv = (1 - v - w) * uv_[a] + v * uv_[b] + w * uv_[c];
      out.push_back(to_eigen(surface_->Value(uv.x(), uv.y())));
    }
  }
  return out;
}

double MeshedFace::surface_distance(const Vector3d& p, const Vector3d& foot,
                                    const Vector2d& uv) const {
  const gp_Pnt2d better =
      surface_->NextValueOfUV(gp_Pnt2d(uv.x(), uv.y()), to_point(p), 1e-3 * deflection_);
  const Vector3d q = to_eigen(surface_->Value(better));
  // Else the foot on the unbounded surface lies outside of the face, and its border is nearest.
  if ((q - foot).norm() <= 2 * deflection_) return (q - p).norm();
  return (to_eigen(surface_->Value(uv.x(), uv.y())) - p).norm();
}

double MeshedFace::distance(const Vector3d& p, double bound) const {
  double least = bound + 2 * deflection_;
  Vector3d foot = Vector3d::Zero();
  Vector2d uv = Vector2d::Zero();
  bool any = false;
  for (const Chunk& chunk : chunks_) {
    if (chunk.box.exteriorDistance(p) >= least) continue;
    for (int t = chunk.begin; t < chunk.end; ++t) {
      const auto& [a, b, c] = triangles_[t];
      const Vector3d k = nearest_weights(p, points_[a], points_[b], points_[c]);
      const Vector3d q = k[0] * points_[a] + k[1] * points_[b] + k[2] * points_[c];
      if (!((q - p).norm() < least)) continue;
      least = (q - p).norm(), foot = q, any = true;
      uv = k[0] * uv_[a] + k[1] * uv_[b] + k[2] * uv_[c];
    }
  }
  return any ? surface_distance(p, foot, uv) : least;
}

void mesh(const TopoDS_Shape& shape, double deflection) {
  constexpr double kAngle = 0.25;  // rad
  BRepTools::Clean(shape);
  BRepMesh_IncrementalMesh(shape, deflection, /*isRelative=*/false, kAngle,
                           /*isInParallel=*/false);
}

std::vector<MeshedFace> mesh_faces(const TopoDS_Shape& shape, double deflection) {
  mesh(shape, deflection);
  std::vector<MeshedFace> out;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    out.emplace_back(TopoDS::Face(it.Current()), deflection);
  return out;
}

}  // namespace sketchsplat::brep
