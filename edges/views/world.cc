// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "datasets/types/dense.h"
#include "datasets/types/median.h"
#include "datasets/types/parallel.h"
#include "edges/views/lift.h"

namespace sketchsplat {
namespace {

constexpr int kGrid = 48;
constexpr int kHullCells = 128;
constexpr double kBeyondField = 1.5;  // what a view sees at the object; details make up a whole

// Half of what a view sees, at distance 1.
double half_field(const View& v) {
  const Camera& c = v.camera;
  double half = 0.5 * std::max(c.width / c.fx, c.height / c.fy);
  if (v.lens.is_identity()) return half;
  for (int k = 0; k < 9; ++k) {  // corners, and where sides may bulge
    Eigen::Vector2d ideal;
    if (v.ideal_pixel({(c.width - 1) * (k % 3) / 2.0, (c.height - 1) * (k / 3) / 2.0}, &ideal))
      half = std::max(half, c.ray(ideal).head<2>().cwiseAbs().maxCoeff());
  }
  return half;
}

struct PixelBox {
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
};

PixelBox box_of(const EdgelMap& map) {
  PixelBox b;
  for (const Edgel& e : map.edgels) {
    b.x0 = std::min(b.x0, double(e.x)), b.x1 = std::max(b.x1, double(e.x));
    b.y0 = std::min(b.y0, double(e.y)), b.y1 = std::max(b.y1, double(e.y));
  }
  return b;
}

// Voxels of a cube that at most `most` of the views put outside their boxes of edgels.
Eigen::AlignedBox3d carve(const std::vector<View>& views, const std::vector<PixelBox>& boxes,
                          const Eigen::AlignedBox3d& cube, double margin_px, double most) {
  Eigen::AlignedBox3d out;
  const Eigen::Vector3d cell = cube.sizes() / kGrid;
  int voters = 0;
  for (const PixelBox& b : boxes) voters += b.x0 <= b.x1;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j)
      for (int k = 0; k < kGrid; ++k) {
        const Eigen::Vector3d p =
            cube.min() + cell.cwiseProduct(Eigen::Vector3d(i + .5, j + .5, k + .5));
        if (out.contains(p - cell) && out.contains(p + cell)) continue;  // it would add nothing
        int misses = 0;
        for (size_t v = 0; v < views.size() && misses <= most * voters; ++v) {
          const PixelBox& b = boxes[v];
          if (b.x0 > b.x1) continue;
          double z;
          const Eigen::Vector2d q = views[v].project(p, &z);
          const double m =
              margin_px + 0.9 * cell.maxCoeff() * views[v].camera.fx / std::max(z, 1e-12);
          misses += z <= 0 || q.x() < b.x0 - m || q.x() > b.x1 + m || q.y() < b.y0 - m ||
                    q.y() > b.y1 + m;
        }
        if (misses <= most * voters) {
          out.extend(Eigen::Vector3d(p - cell));
          out.extend(Eigen::Vector3d(p + cell));
        }
      }
  return out;
}

}  // namespace

Eigen::Matrix3Xf plane_normals(const View& view, const EdgelMap& map) {
  const Eigen::Matrix3d world_from_cam = view.cam_from_world.rotation.transpose();
  Eigen::Matrix3Xf normals(3, map.edgels.size());
  for (size_t k = 0; k < map.edgels.size(); ++k) {
    const Edgel& e = map.edgels[k];
    const Eigen::Vector3d along(-e.ny / view.camera.fx, e.nx / view.camera.fy, 0);
    normals.col(k) =
        (world_from_cam * view.camera.ray({e.x, e.y}).cross(along)).normalized().cast<float>();
  }
  return normals;
}

Eigen::Vector3d meeting_point(const std::vector<View>& views) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity() * 1e-9;
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const View& v : views) {
    const Eigen::Vector3d axis = v.cam_from_world.rotation.row(2);
    const Eigen::Matrix3d M = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    A += M;
    b += M * v.center_in_world();
  }
  return solve_symmetric(A, b);
}

bool EdgeWorld::has_masks() const {
  return std::any_of(maps.begin(), maps.end(), [](const EdgelMap& m) { return !m.mask.empty(); });
}

VisualHull hull_of(const EdgeWorld& world) { return VisualHull(world, kHullCells); }

EdgeWorld make_edge_world(std::vector<View> views, std::vector<EdgelMap> maps) {
  EdgeWorld world;
  world.views = std::move(views);
  world.maps = std::move(maps);
  parallel_for(int(world.maps.size()), 1, [&](int v) {
    if (world.maps[v].nearest.empty()) build_lookup(&world.maps[v]);
  });
  std::vector<PixelBox> boxes;
  for (const EdgelMap& m : world.maps) boxes.push_back(box_of(m));
  const Eigen::Vector3d middle = meeting_point(world.views);
  double reach = 0;
  for (const View& v : world.views) {
    const double z = (v.cam_from_world * middle).z();
    if (z > 0) reach = std::max(reach, z * half_field(v));
  }
  // Masks hold the object as a whole but where other things stand before it; without, views may be
  // details of it.
  const bool masked = world.has_masks();
  const double most = masked ? 0.1 : 0.75;
  if (!masked) reach *= kBeyondField;
  Eigen::AlignedBox3d cube(middle - Eigen::Vector3d::Constant(reach),
                           middle + Eigen::Vector3d::Constant(reach));
  for (int pass = 0; pass < 2 && reach > 0; ++pass)
    cube = carve(world.views, boxes, cube, 2.0, most);
  if (reach > 0) world.bounds = cube;
  std::vector<double> footprint;
  for (size_t i = 0; i < world.views.size(); ++i) {
    const View& v = world.views[i];
    const double z = (v.cam_from_world * world.bounds.center()).z();
    if (z > 0 && !world.bounds.isEmpty()) footprint.push_back(z / v.camera.fx);
    world.plane_normal.push_back(plane_normals(v, world.maps[i]));
  }
  world.footprint = median(std::move(footprint));
  world.hull = hull_of(world);
  return world;
}

}  // namespace sketchsplat
