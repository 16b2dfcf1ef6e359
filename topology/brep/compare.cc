// SPDX-License-Identifier: MIT
#include "topology/brep/compare.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

constexpr int kPlaces = 30000;
constexpr double kNear = 5e-3;  // of the longest side
constexpr double kShare = 0.9;  // of a face's places
constexpr int kPlacesPerFace = 24;

struct Part {
  TopoDS_Shape solid;
  std::vector<TopoDS_Face> faces;
  std::vector<std::vector<gp_Pnt>> places;                 // of every face
  std::map<GeomAbs_SurfaceType, TopoDS_Compound> of_kind;  // the faces of every kind
  TopoDS_Compound all;
};

GeomAbs_SurfaceType kind_of(const TopoDS_Face& face) { return BRepAdaptor_Surface(face).GetType(); }

// Middles of triangles, spread over the face.
std::vector<gp_Pnt> places_on(const TopoDS_Face& face) {
  TopLoc_Location where;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, where);
  std::vector<gp_Pnt> places;
  if (mesh.IsNull()) return places;
  const int n = mesh->NbTriangles(), used = std::min(n, kPlacesPerFace);
  for (int k = 0; k < used; ++k) {
    int corner[3];
    mesh->Triangle(1 + int((k + 0.5) * n / used)).Get(corner[0], corner[1], corner[2]);
    gp_XYZ sum(0, 0, 0);
    for (const int c : corner) sum += mesh->Node(c).XYZ();
    places.push_back(gp_Pnt(sum / 3).Transformed(where.Transformation()));
  }
  return places;
}

TopoDS_Shape read_solid(const std::string& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    throw InputError(path, "a STEP file", "something else");
  reader.TransferRoots();
  TopExp_Explorer solids(reader.OneShape(), TopAbs_SOLID);
  if (!solids.More()) throw InputError(path, "a solid", "none");
  return solids.Current();
}

Part part_of(const TopoDS_Shape& solid, double deflection) {
  Part part;
  part.solid = solid;
  BRepMesh_IncrementalMesh(solid, deflection);
  BRep_Builder builder;
  builder.MakeCompound(part.all);
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    const auto [kind, first] = part.of_kind.emplace(kind_of(face), TopoDS_Compound());
    if (first) builder.MakeCompound(kind->second);
    builder.Add(kind->second, face);
    builder.Add(part.all, face);
    part.faces.push_back(face);
    part.places.push_back(places_on(face));
  }
  return part;
}

double distance(const gp_Pnt& place, const TopoDS_Shape& shape) {
  const BRepExtrema_DistShapeShape d(BRepBuilderAPI_MakeVertex(place).Vertex(), shape);
  return d.IsDone() ? d.Value() : HUGE_VAL;
}

// Share of the faces of one part that lie on those of the other; raises the largest distance.
double faces_found(const Part& part, const Part& other, double near, double* largest) {
  int right = 0;
  for (size_t f = 0; f < part.faces.size(); ++f) {
    const auto same = other.of_kind.find(kind_of(part.faces[f]));
    int on = 0;
    for (const gp_Pnt& place : part.places[f]) {
      *largest = std::max(*largest, distance(place, other.all));
      on += same != other.of_kind.end() && distance(place, same->second) <= near;
    }
    right += !part.places[f].empty() && on >= kShare * part.places[f].size();
  }
  return part.faces.empty() ? 0 : double(right) / part.faces.size();
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return std::abs(properties.Mass());
}

Bnd_Box box_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  return box;
}

// Boolean operations of parts that all but coincide are not to be relied upon; places are.
double intersection_over_union(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  Bnd_Box box = box_of(a);
  box.Add(box_of(b));
  const gp_XYZ low = box.CornerMin().XYZ(), size = box.CornerMax().XYZ() - low;
  BRepClass3d_SolidClassifier in_a(a), in_b(b);
  int both = 0, either = 0;
  for (int i = 0; i < kPlaces; ++i) {
    // Roberts' sequence of even spread: no plane of the part holds many of its points.
    const gp_XYZ share(std::fmod(0.5 + i * 0.8191725133961645, 1.0),
                       std::fmod(0.5 + i * 0.6710436067037893, 1.0),
                       std::fmod(0.5 + i * 0.5497004779019703, 1.0));
    const gp_Pnt place(low + share.Multiplied(size));
    in_a.Perform(place, 1e-9);
    in_b.Perform(place, 1e-9);
    const bool a_holds = in_a.State() == TopAbs_IN, b_holds = in_b.State() == TopAbs_IN;
    both += a_holds && b_holds;
    either += a_holds || b_holds;
  }
  return either > 0 ? double(both) / either : 0;
}

}  // namespace

SolidComparison compare_solids(const std::string& path, const std::string& true_path) {
  try {
    const TopoDS_Shape solid = read_solid(path), truth = read_solid(true_path);
    const gp_XYZ size = box_of(truth).CornerMax().XYZ() - box_of(truth).CornerMin().XYZ();
    const double side = std::max({size.X(), size.Y(), size.Z()});
    const Part a = part_of(solid, 1e-3 * side), b = part_of(truth, 1e-3 * side);
    SolidComparison out;
    out.volume = volume_of(solid);
    out.true_volume = volume_of(truth);
    out.iou = intersection_over_union(solid, truth);
    out.face_precision = faces_found(a, b, kNear * side, &out.largest_distance);
    out.face_recall = faces_found(b, a, kNear * side, &out.largest_distance);
    const double sum = out.face_precision + out.face_recall;
    out.face_f = sum > 0 ? 2 * out.face_precision * out.face_recall / sum : 0;
    return out;
  } catch (const Standard_Failure& failure) {
    throw InputError(path, "solids that can be compared",
                     failure.GetMessageString() ? failure.GetMessageString() : "");
  }
}

}  // namespace sketchsplat
