// SPDX-License-Identifier: MIT
#include "datasets/synthetic/scene/photo_world.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "datasets/synthetic/render/noise.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

// Faces of `more` count on from those of `mesh`.
void append(const SurfaceMesh& more, int first_face, SurfaceMesh* mesh) {
  const unsigned first = unsigned(mesh->points.size());
  mesh->points.insert(mesh->points.end(), more.points.begin(), more.points.end());
  mesh->normals.insert(mesh->normals.end(), more.normals.begin(), more.normals.end());
  for (const auto& c : more.corners)
    mesh->corners.push_back({first + c[0], first + c[1], first + c[2]});
  for (const int face : more.face) mesh->face.push_back(first_face + face);
}

// A little barrel, as of the wide end of a zoom.
Lens drawn_lens(double strength, std::uint64_t seed) {
  if (strength == 0) return {};
  const auto vary = [&](int use) { return 2 * uniform(hash(seed, 0, use, 90)) - 1; };
  Lens::Terms terms;
  terms.k1 = strength * -0.11 * (1 + 0.25 * vary(0));
  terms.k2 = strength * 0.03 * (1 + 0.25 * vary(1));
  terms.p1 = strength * 7e-4 * vary(2);
  terms.p2 = strength * 7e-4 * vary(3);
  return {LensModel::kOpencv, terms};
}

// Cameras see something in every pixel.
void check_corners(const View& view) {
  const double w = view.camera.width - 1, h = view.camera.height - 1;
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(w, 0),
                                        Eigen::Vector2d(0, h), Eigen::Vector2d(w, h)}) {
    Eigen::Vector2d ideal;
    if (!view.ideal_pixel(corner, &ideal))
      throw InputError("distortion", "a lens that draws the corners of the picture",
                       "too much for this focal length");
  }
}

double height_above_table(const PhotoWorld& world, const Vector3d& point) {
  return (point - world.room.unit_from_room.translation()).dot(world.room.up());
}

}  // namespace

PhotoWorld make_photo_world(const SynthesizeOptions& options, const SurfaceMesh& part) {
  const double size = options.photo.tag_size > 0 ? options.photo.tag_size / options.extent : 0.25;
  PhotoRoom room = make_room(options.photo, part.points, options.rig.distance, size, options.seed);
  SurfaceMesh all = part;
  const int part_faces =
      1 + (part.face.empty() ? -1 : *std::max_element(part.face.begin(), part.face.end()));
  append(room.mesh, part_faces, &all);
  return {std::move(room), part_faces, Tracer(all)};
}

void make_photo_views(const SynthesizeOptions& options, const PhotoWorld& world,
                      std::vector<View>* views) {
  const Eigen::Matrix3d room_from_unit = world.room.unit_from_room.linear().transpose();
  const Lens lens = drawn_lens(options.photo.distortion, options.seed);
  const auto off = [&](int use) {
    return 0.006 * options.rig.resolution * (2 * uniform(hash(options.seed, 0, use, 91)) - 1);
  };
  const int digits = std::max(3, int(std::to_string(views->size() - 1).size()));
  for (size_t k = 0; k < views->size(); ++k) {
    View& view = (*views)[k];
    char name[32];
    std::snprintf(name, sizeof name, "%0*d.jpg", digits, int(k));
    view.name = name;
    view.cam_from_world.rotation *= room_from_unit;
    view.lens = lens;
    view.camera.cx += off(0);
    view.camera.cy += off(1);
    const double height = height_above_table(world, view.center_in_world());
    if (height < 0.1) throw InputError("rig", "cameras above the table", view.name + " below it");
  }
  check_corners(views->at(0));
}

void lift_off_table(const PhotoWorld& world, double reach, TruthCurve* curve) {
  const Vector3d up = world.room.up();
  for (int i = 0; i < curve->points.cols(); ++i) {
    if (height_above_table(world, curve->points.col(i)) > reach) continue;
    const Vector3d out = curve->outward.col(i);
    curve->outward.col(i) = (out - out.dot(up) * up + up).normalized();
  }
}

}  // namespace sketchsplat
