// SPDX-License-Identifier: MIT
#include "topology/brep/compare.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <gp_Trsf.hxx>
#include <limits>
#include <type_traits>
#include <vector>

#include "datasets/step/guarded.h"
#include "datasets/step/read_step_shape.h"
#include "datasets/types/errors.h"
#include "topology/brep/check.h"
#include "topology/brep/meshed_face.h"
#include "topology/brep/overlap.h"

namespace sketchsplat {
namespace {

using brep::MeshedFace;
using Eigen::Vector3d;

constexpr double kDeflection = 1e-4;  // of the longest side
constexpr double kNear = 5e-3;        // of the longest side
constexpr double kShare = 0.9;        // of a face's area
constexpr double kSpacing = 0.02;     // of places, of the longest side
constexpr size_t kMostPoints = 1000;  // of the mesh of a face that are places, too
constexpr int kLeastPlaces = 32;      // of a face
constexpr double kPlausible = 5e-3;   // between the IoU of a boolean operation and that of lines
constexpr unsigned kSeconds = 600;    // of CPU
constexpr double kHuge = std::numeric_limits<double>::max();

// All solids of a file.
TopoDS_Shape read_solids(const std::string& path) {
  const TopoDS_Shape all = read_step_shape(path);
  std::vector<TopoDS_Shape> solids;
  for (TopExp_Explorer it(all, TopAbs_SOLID); it.More(); it.Next()) solids.push_back(it.Current());
  if (solids.empty()) throw InputError(path, "a solid", "none");
  if (solids.size() == 1) return solids[0];
  TopoDS_Compound compound;
  const BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& solid : solids) builder.Add(compound, solid);
  return compound;
}

bool is_valid(const TopoDS_Shape& shape) {
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next())
    if (!BRep_Tool::IsClosed(it.Current())) return false;
  return brep::fault_of(shape).empty();
}

double longest_side(const TopoDS_Shape& shape, const std::string& path) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, /*useTriangulation=*/false, /*useShapeTolerance=*/false);
  if (box.IsVoid() || box.IsOpen()) throw InputError(path, "a solid with an end", "none");
  const gp_XYZ size = box.CornerMax().XYZ() - box.CornerMin().XYZ();
  return std::max({size.X(), size.Y(), size.Z()});
}

// OpenCASCADE's tolerances are absolute, meant for parts of some hundred units.
TopoDS_Shape scaled(const TopoDS_Shape& shape, double factor) {
  gp_Trsf scale;
  scale.SetScaleFactor(factor);
  return BRepBuilderAPI_Transform(shape, scale, /*theCopyGeom=*/true).Shape();
}

double distance(const Vector3d& p, const std::vector<MeshedFace>& faces,
                const GeomAbs_SurfaceType* kind, double bound) {
  double least = bound;
  for (const MeshedFace& face : faces)
    if ((!kind || face.kind() == *kind) && face.box().exteriorDistance(p) < least)
      least = std::min(least, face.distance(p, least));
  return least;
}

bool is_right(const MeshedFace& face, const std::vector<MeshedFace>& others, double side) {
  const GeomAbs_SurfaceType kind = face.kind();
  const std::vector<Vector3d> places = face.places(kSpacing * side, kLeastPlaces);
  const auto near = std::count_if(places.begin(), places.end(), [&](const Vector3d& p) {
    return distance(p, others, &kind, 2 * kNear * side) <= kNear * side;
  });
  return !places.empty() && double(near) >= kShare * double(places.size());
}

double share_right(const std::vector<MeshedFace>& faces, const std::vector<MeshedFace>& others,
                   double side) {
  if (faces.empty()) return 0;
  return double(std::count_if(faces.begin(), faces.end(),
                              [&](const auto& face) { return is_right(face, others, side); })) /
         double(faces.size());
}

// Over places inside of the faces and on their borders, where the largest are.
double largest_distance(const std::vector<MeshedFace>& faces, const std::vector<MeshedFace>& others,
                        double side) {
  double most = 0;
  for (const MeshedFace& face : faces) {
    std::vector<Vector3d> places = face.places(kSpacing * side, kLeastPlaces);
    const std::vector<Vector3d>& points = face.points();  // those of the border first
    const size_t step = 1 + points.size() / kMostPoints;
    for (size_t i = 0; i < points.size(); i += step) places.push_back(points[i]);
    for (const Vector3d& p : places) most = std::max(most, distance(p, others, nullptr, kHuge));
  }
  return most;
}

void compare_volumes(const TopoDS_Shape& solid, const TopoDS_Shape& truth,
                     const std::vector<MeshedFace>& faces,
                     const std::vector<MeshedFace>& true_faces, SolidComparison* out) {
  out->volume = brep::volume_of(solid);
  out->true_volume = brep::volume_of(truth);
  // Of solids that all but coincide, boolean operations may be wrong without a word.
  const double by_lines = brep::overlap_by_lines(faces, true_faces);
  const double exact = brep::overlap_by_boolean(solid, truth);
  out->iou_is_exact = exact >= 0 && std::abs(exact - by_lines) <= kPlausible;
  out->iou = out->iou_is_exact ? std::min(exact, 1.0) : by_lines;
}

SolidComparison compare(const TopoDS_Shape& solid, const TopoDS_Shape& truth, double side) {
  const std::vector<MeshedFace> faces = brep::mesh_faces(solid, kDeflection * side),
                                true_faces = brep::mesh_faces(truth, kDeflection * side);
  SolidComparison out;
  out.valid = is_valid(solid);
  out.faces = int(faces.size());
  out.true_faces = int(true_faces.size());
  compare_volumes(solid, truth, faces, true_faces, &out);
  out.face_precision = share_right(faces, true_faces, side);
  out.face_recall = share_right(true_faces, faces, side);
  const double sum = out.face_precision + out.face_recall;
  out.face_f = sum > 0 ? 2 * out.face_precision * out.face_recall / sum : 0;
  out.to_truth = largest_distance(faces, true_faces, side);
  out.from_truth = largest_distance(true_faces, faces, side);
  out.largest_distance = std::max(out.to_truth, out.from_truth);
  return out;
}

SolidComparison compare_files(const std::string& path, const std::string& true_path) {
  const TopoDS_Shape solid = read_solids(path), truth = read_solids(true_path);
  const double factor = std::exp2(7 - std::ceil(std::log2(longest_side(truth, true_path))));
  const TopoDS_Shape large = scaled(truth, factor);
  SolidComparison out = compare(scaled(solid, factor), large, longest_side(large, true_path));
  out.volume /= factor * factor * factor;
  out.true_volume /= factor * factor * factor;
  for (double* length : {&out.to_truth, &out.from_truth, &out.largest_distance}) *length /= factor;
  return out;
}
static_assert(std::is_trivially_copyable_v<SolidComparison>);

}  // namespace

SolidComparison compare_solids(const std::string& path, const std::string& true_path) {
  // Boolean operations of strangers' solids are no safer than reading them.
  const std::string bytes = guarded(path, "a solid that can be compared", kSeconds, [&] {
    const SolidComparison found = compare_files(path, true_path);
    return std::string(reinterpret_cast<const char*>(&found), sizeof found);
  });
  SolidComparison out;
  std::memcpy(&out, bytes.data(), sizeof out);
  return out;
}

}  // namespace sketchsplat
