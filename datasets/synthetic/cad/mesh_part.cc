// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/mesh_part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "datasets/synthetic/cad/mesh_runs.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kSliver = 1e-6;    // a triangle this flat has no normal of its own [extents]
constexpr double kCurve = 1e-4;     // of vertices from the curve they stand for [extents]
constexpr double kSlackDeg = 0.01;  // angles of meshes in single precision
constexpr double kSpacing = 0.005;  // of the truth's points [extents]
constexpr double kSheetDeg = 180;   // "angle" of a border

using VertexPair = std::pair<int, int>;  // smaller first

double angle_deg(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

struct Groups {
  std::vector<int> parent;
  explicit Groups(size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  int of(int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void unite(int a, int b) {
    a = of(a), b = of(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

struct Feature {
  double dihedral_deg = kSheetDeg;
  Vector3d outward = Vector3d::Zero();
};

class Solid {
 public:
  Solid(const TriangleMesh& mesh, const UnitFrame& frame) : triangles_(mesh.triangles) {
    for (const Vector3d& p : mesh.points) points_.push_back(frame * p);
    for (int t = 0; t < int(triangles_.size()); ++t)
      for (int k = 0; k < 3; ++k) sides_[edge(t, k)].push_back(t);
    turn_alike();
    compute_normals();
  }

  bool flat() const {
    return std::all_of(normals_.begin(), normals_.end(), [](const auto& n) { return n.isZero(); });
  }
  const std::vector<Vector3d>& points() const { return points_; }

  std::map<VertexPair, Feature> features(double crease_deg) const {
    std::map<VertexPair, Feature> out;
    for (const auto& [e, around] : sides_) {
      Feature feature;
      if (around.size() == 2) {
        const Vector3d &a = normals_[around[0]], &b = normals_[around[1]];
        feature.dihedral_deg = angle_deg(a, b);
        if (feature.dihedral_deg <= crease_deg + kSlackDeg) continue;
        // The free space lies along the sum of the normals, whether the edge is convex or not.
        if ((a + b).norm() > 1e-3) feature.outward = (a + b).normalized();
      }
      out[e] = feature;
    }
    return out;
  }

  SurfaceMesh surface(const std::map<VertexPair, Feature>& features) const {
    Groups corners(3 * triangles_.size()), faces(triangles_.size());
    for (const auto& [e, around] : sides_) {
      if (features.count(e)) continue;
      faces.unite(around[0], around[1]);
      for (int v : {e.first, e.second}) corners.unite(corner(around[0], v), corner(around[1], v));
    }
    std::vector<Vector3d> sum(3 * triangles_.size(), Vector3d::Zero());
    for (int c = 0; c < int(sum.size()); ++c) sum[corners.of(c)] += weighted_normal(c);
    SurfaceMesh out;
    std::vector<int> column(sum.size(), -1);
    for (int t = 0; t < int(triangles_.size()); ++t) {
      out.face.push_back(faces.of(t));
      out.corners.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const int c = corners.of(3 * t + k);
        if (column[c] < 0) {
          column[c] = int(out.points.size());
          out.points.push_back(points_[triangles_[t][k]].cast<float>());
          const Vector3d n = sum[c].norm() > 1e-9 ? sum[c].normalized() : normals_[t];
          out.normals.push_back(n.cast<float>());
        }
        out.corners.back()[k] = unsigned(column[c]);
      }
    }
    return out;
  }

 private:
  VertexPair edge(int t, int k) const {
    return std::minmax({triangles_[t][k], triangles_[t][(k + 1) % 3]});
  }
  int corner(int t, int vertex) const {
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] == vertex) return 3 * t + k;
    return 3 * t;
  }
  bool runs(int t, int from, int to) const {
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] == from && triangles_[t][(k + 1) % 3] == to) return true;
    return false;
  }

  // Neighbours run along their common edge in opposite directions, as far as the mesh allows.
  void turn_alike() {
    std::vector<char> seen(triangles_.size());
    for (int seed = 0; seed < int(triangles_.size()); ++seed) {
      if (seen[seed]) continue;
      std::vector<int> todo = {seed};
      seen[seed] = 1;
      while (!todo.empty()) {
        const int t = todo.back();
        todo.pop_back();
        for (int k = 0; k < 3; ++k) {
          const auto& around = sides_[edge(t, k)];
          if (around.size() != 2) continue;
          const int other = around[0] == t ? around[1] : around[0];
          if (seen[other]) continue;
          seen[other] = 1;
          if (runs(other, triangles_[t][k], triangles_[t][(k + 1) % 3]))
            std::swap(triangles_[other][1], triangles_[other][2]);
          todo.push_back(other);
        }
      }
    }
  }

  // Slivers belong to what lies beyond their longest edge.
  void compute_normals() {
    normals_.assign(triangles_.size(), Vector3d::Zero());
    std::vector<int> slivers;
    for (int t = 0; t < int(triangles_.size()); ++t) {
      const Vector3d &a = points_[triangles_[t][0]], &b = points_[triangles_[t][1]],
                     &c = points_[triangles_[t][2]];
      const Vector3d n = (b - a).cross(c - a);
      const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
      if (n.norm() > kSliver * longest)
        normals_[t] = n.normalized();
      else
        slivers.push_back(t);
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (int t : slivers) {
        if (!normals_[t].isZero()) continue;
        const auto& around = sides_[longest_edge(t)];
        if (around.size() != 2) continue;
        normals_[t] = normals_[around[0] == t ? around[1] : around[0]];
        changed |= !normals_[t].isZero();
      }
    }
  }
  VertexPair longest_edge(int t) const {
    VertexPair best;
    double most = -1;
    for (int k = 0; k < 3; ++k) {
      const VertexPair e = edge(t, k);
      const double length = (points_[e.first] - points_[e.second]).norm();
      if (length > most) most = length, best = e;
    }
    return best;
  }

  // By the angle at the corner: how a face is cut into triangles must not matter.
  Vector3d weighted_normal(int corner) const {
    const auto& t = triangles_[corner / 3];
    const int k = corner % 3;
    const Vector3d& p = points_[t[k]];
    return normals_[corner / 3] *
           angle_deg(points_[t[(k + 1) % 3]] - p, points_[t[(k + 2) % 3]] - p);
  }

  std::vector<Vector3d> points_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Vector3d> normals_;  // one per triangle
  std::map<VertexPair, std::vector<int>> sides_;
};

// Vertices along feature edges, in order; first = last if it closes.
struct Run {
  std::vector<int> vertices;
  bool loop = false;  // closed, and no vertex of it is an end
};

std::vector<Run> chain(const std::map<VertexPair, Feature>& features,
                       const std::vector<Vector3d>& points, double corner_deg) {
  std::map<int, std::vector<int>> neighbours;
  for (const auto& feature : features) {
    neighbours[feature.first.first].push_back(feature.first.second);
    neighbours[feature.first.second].push_back(feature.first.first);
  }
  const auto is_end = [&](int v) {
    const auto& n = neighbours[v];
    return n.size() != 2 ||
           angle_deg(points[v] - points[n[0]], points[n[1]] - points[v]) > corner_deg + kSlackDeg;
  };
  std::map<VertexPair, bool> used;
  std::vector<Run> runs;
  const auto follow = [&](int from, int to) {
    Run run;
    run.vertices = {from};
    while (!used[std::minmax(from, to)]) {
      used[std::minmax(from, to)] = true;
      run.vertices.push_back(to);
      if (is_end(to)) break;
      const auto& n = neighbours[to];
      const int next = n[0] == from ? n[1] : n[0];
      from = to, to = next;
    }
    if (run.vertices.size() > 1) runs.push_back(run);
  };
  for (const auto& [v, around] : neighbours)
    if (is_end(v))
      for (int next : around) follow(v, next);
  const size_t open = runs.size();
  for (const auto& [v, around] : neighbours) follow(v, around[0]);
  for (size_t i = open; i < runs.size(); ++i) runs[i].loop = true;
  return runs;
}

class Drawer {
 public:
  Drawer(const std::map<VertexPair, Feature>& features, const std::vector<Vector3d>& points)
      : features_(features), points_(points), node_(points.size(), -1) {}

  void add(Run run) {
    if (run.loop) begin_with_longest_edge(&run.vertices);
    for (const MeshCurve& piece : cut_run(columns(run.vertices), kCurve)) {
      const int begin = is_closed(piece.kind) ? -1 : node(run.vertices[piece.first]);
      const int end = is_closed(piece.kind) ? -1 : node(run.vertices[piece.last]);
      truth_.sketch.add_stroke(piece.kind, begin, end, piece.handles);
      truth_.curve_of_stroke.push_back(int(truth_.curves.size()));
      truth_.curves.push_back(curve(run.vertices, piece));
    }
  }
  Truth take() { return std::move(truth_); }

 private:
  // A long edge is a line of its own: no piece reaches across the place where the cutting begins.
  void begin_with_longest_edge(std::vector<int>* loop) const {
    const int n = int(loop->size()) - 1;
    const Matrix3Xd p = columns(*loop);
    int start = 0;
    (p.rightCols(n) - p.leftCols(n)).colwise().norm().maxCoeff(&start);
    loop->pop_back();
    std::rotate(loop->begin(), loop->begin() + start, loop->end());
    loop->push_back(loop->front());
  }
  Matrix3Xd columns(const std::vector<int>& vertices) const {
    Matrix3Xd out(3, vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) out.col(i) = points_[vertices[i]];
    return out;
  }
  int node(int vertex) {
    if (node_[vertex] < 0) node_[vertex] = truth_.sketch.add_node(points_[vertex]);
    return node_[vertex];
  }

  TruthCurve curve(const std::vector<int>& vertices, const MeshCurve& piece) const {
    static const std::map<StrokeKind, const char*> kTypes = {
        {StrokeKind::kLine, "Line"},           {StrokeKind::kArc, "Circle"},
        {StrokeKind::kCircle, "Circle"},       {StrokeKind::kEllipse, "Ellipse"},
        {StrokeKind::kEllipticArc, "Ellipse"}, {StrokeKind::kBezier, "BSpline"}};
    TruthCurve out;
    out.type = kTypes.at(piece.kind);
    out.closed = vertices[piece.first] == vertices[piece.last];
    std::vector<Vector3d> points, outward;
    double sum = 0, length = 0;
    for (int i = piece.first; i < piece.last; ++i) {
      const Feature& feature = features_.at(std::minmax(vertices[i], vertices[i + 1]));
      const Vector3d &a = points_[vertices[i]], &b = points_[vertices[i + 1]];
      const int steps = std::max(1, int(std::ceil((b - a).norm() / kSpacing)));
      for (int k = i == piece.first ? 0 : 1; k <= steps; ++k) {
        points.push_back(a + (b - a) * (double(k) / steps));
        outward.push_back(feature.outward);
      }
      sum += feature.dihedral_deg * (b - a).norm();
      length += (b - a).norm();
    }
    out.dihedral_deg = sum / length;
    out.points = Eigen::Map<const Matrix3Xd>(points[0].data(), 3, points.size());
    out.outward = Eigen::Map<const Matrix3Xd>(outward[0].data(), 3, outward.size());
    return out;
  }

  const std::map<VertexPair, Feature>& features_;
  const std::vector<Vector3d>& points_;
  std::vector<int> node_;
  Truth truth_;
};

}  // namespace

MeshPart make_mesh_part(const TriangleMesh& mesh, double crease_deg, const std::string& name) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.points) box.extend(p);
  if (mesh.triangles.empty() || !(box.sizes().maxCoeff() > 0))
    throw InputError(name, "a mesh with faces", "none");
  const UnitFrame frame{box.center(), 1 / box.sizes().maxCoeff(), box.sizes()};
  const Solid solid(mesh, frame);
  if (solid.flat()) throw InputError(name, "faces with an area", "none");
  const std::map<VertexPair, Feature> features = solid.features(crease_deg);
  Drawer drawer(features, solid.points());
  // Facets of a coarse cylinder turn its rims too: what is smooth across is smooth along.
  for (const Run& run : chain(features, solid.points(), std::clamp(crease_deg, 30.0, 60.0)))
    drawer.add(run);
  return {solid.surface(features), drawer.take(), frame};
}

}  // namespace sketchsplat
