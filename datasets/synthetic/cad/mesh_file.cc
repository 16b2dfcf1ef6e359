// SPDX-License-Identifier: MIT
#include "datasets/synthetic/cad/mesh_file.h"

#include <Eigen/Geometry>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMerge = 1e-6;  // of the extent: single precision, a few digits lost

struct PolygonTraits : public OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using PolygonMesh = OpenMesh::PolyMesh_ArrayKernelT<PolygonTraits>;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Newell's plane of a polygon that need be neither flat nor convex; its corners in that plane,
// counter-clockwise.
std::vector<Vector2d> flattened(const std::vector<Vector3d>& corners) {
  Vector3d normal = Vector3d::Zero();
  for (size_t i = 0; i < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  const Vector3d n = normal.isZero(0) ? Vector3d(Vector3d::UnitZ()) : normal.normalized();
  const Vector3d x = n.unitOrthogonal(), y = n.cross(x);
  std::vector<Vector2d> flat;
  for (const Vector3d& c : corners)
    flat.emplace_back((c - corners[0]).dot(x), (c - corners[0]).dot(y));
  return flat;
}

bool is_ear(const std::vector<Vector2d>& p, const std::vector<int>& left, int k) {
  const int n = int(left.size());
  const Vector2d &a = p[left[(k + n - 1) % n]], &b = p[left[k]], &c = p[left[(k + 1) % n]];
  if (!(cross(b - a, c - b) > 0)) return false;
  for (int i : left) {
    const Vector2d& q = p[i];
    if (q == a || q == b || q == c) continue;  // the bridges of a hole visit points twice
    if (cross(b - a, q - a) >= 0 && cross(c - b, q - b) >= 0 && cross(a - c, q - c) >= 0)
      return false;
  }
  return true;
}

// Ear clipping; where no ear is left (a polygon that crosses itself) the next corner goes.
void add_triangles(const std::vector<int>& polygon, const std::vector<Vector3d>& points,
                   std::vector<std::array<int, 3>>* triangles) {
  std::vector<Vector3d> corners;
  for (int i : polygon) corners.push_back(points[i]);
  const std::vector<Vector2d> flat = flattened(corners);
  std::vector<int> left(polygon.size());
  for (size_t i = 0; i < left.size(); ++i) left[i] = int(i);
  while (left.size() >= 3) {
    const int n = int(left.size());
    int ear = 0;
    while (n > 3 && ear < n && !is_ear(flat, left, ear)) ++ear;
    ear %= n;
    triangles->push_back(
        {polygon[left[(ear + n - 1) % n]], polygon[left[ear]], polygon[left[(ear + 1) % n]]});
    left.erase(left.begin() + ear);
  }
}

// For every point the first one that lies at the same place.
std::vector<int> first_alike(const std::vector<Vector3d>& points, double distance) {
  using Cell = std::array<long long, 3>;
  std::map<Cell, std::vector<int>> grid;
  std::vector<int> first(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector3d scaled = (points[i] - points[0]) / distance;
    const Cell cell = {std::llround(scaled.x()), std::llround(scaled.y()),
                       std::llround(scaled.z())};
    int found = -1;
    for (int k = 0; k < 27 && found < 0; ++k) {
      const auto near =
          grid.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (near == grid.end()) continue;
      for (int j : near->second)
        if (found < 0 && (points[j] - points[i]).norm() <= distance) found = j;
    }
    first[i] = found < 0 ? int(i) : found;
    if (found < 0) grid[cell].push_back(int(i));
  }
  return first;
}

TriangleMesh merged(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.points) box.extend(p);
  const double extent = box.sizes().maxCoeff();
  if (!(extent > 0)) return {};
  const std::vector<int> first = first_alike(mesh.points, kMerge * extent);
  TriangleMesh out;
  std::vector<int> column(mesh.points.size(), -1);
  for (const auto& t : mesh.triangles) {
    std::array<int, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = first[t[k]];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (int& corner : corners) {
      if (column[corner] < 0) {
        column[corner] = int(out.points.size());
        out.points.push_back(mesh.points[corner]);
      }
      corner = column[corner];
    }
    out.triangles.push_back(corners);
  }
  return out;
}

PolygonMesh read_polygons(const std::string& path) {
  // The readers report to the terminal; ours is the caller's.
  omlog().disable();
  omerr().disable();
  omout().disable();
  PolygonMesh mesh;
  OpenMesh::IO::Options options;
  bool read = false;
  try {
    read = OpenMesh::IO::read_mesh(mesh, path, options);
  } catch (const std::exception&) {  // absurd numbers of elements
  }
  if (!read) throw InputError(path, "a mesh (OBJ, STL, PLY, OFF)", "a file that cannot be read");
  return mesh;
}

}  // namespace

bool is_mesh_file(const std::string& path) {
  std::string ending = path.substr(std::min(path.size(), path.rfind('.')));
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".obj" || ending == ".stl" || ending == ".ply" || ending == ".off";
}

TriangleMesh read_mesh(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || !std::ifstream(path))
    throw InputError(path, "a mesh (OBJ, STL, PLY, OFF)", "no readable file");
  if (std::filesystem::file_size(path, error) == 0)
    throw InputError(path, "a mesh (OBJ, STL, PLY, OFF)", "an empty file");
  const PolygonMesh mesh = read_polygons(path);
  TriangleMesh out;
  for (const auto& vertex : mesh.vertices()) {
    const OpenMesh::Vec3d& p = mesh.point(vertex);
    out.points.emplace_back(p[0], p[1], p[2]);
    if (!out.points.back().allFinite())
      throw InputError(path, "finite coordinates", "one that is not");
  }
  for (const auto& face : mesh.faces()) {
    std::vector<int> polygon;
    for (auto v = mesh.cfv_iter(face); v.is_valid(); ++v) polygon.push_back(v->idx());
    add_triangles(polygon, out.points, &out.triangles);
  }
  out = merged(out);
  if (out.triangles.empty()) throw InputError(path, "a mesh with faces", "none");
  return out;
}

}  // namespace sketchsplat
