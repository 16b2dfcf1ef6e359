// SPDX-License-Identifier: MIT
#include "topology/brep/check.h"

#include <BRepCheck.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListIteratorOfListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace sketchsplat::brep {
namespace {

constexpr double kMostTolerance = 1e-4;  // of the extent

double area_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return properties.Mass();
}

// "BRepCheck_UnorientableShape" as "UnorientableShape"; empty if there is no error.
std::string first_error(const BRepCheck_ListOfStatus& list) {
  for (BRepCheck_ListIteratorOfListOfStatus it(list); it.More(); it.Next()) {
    if (it.Value() == BRepCheck_NoError) continue;
    std::ostringstream text;
    BRepCheck::Print(it.Value(), text);
    std::string name;
    std::istringstream(text.str()) >> name;
    const size_t prefix = name.find("BRepCheck_");
    return prefix == 0 ? name.substr(10) : name;
  }
  return "";
}

std::string fault_in(const BRepCheck_Analyzer& analyzer, const TopoDS_Shape& shape) {
  const Handle(BRepCheck_Result)& result = analyzer.Result(shape);
  if (result.IsNull()) return "";
  std::string error = first_error(result->Status());
  for (result->InitContextIterator(); error.empty() && result->MoreShapeInContext();
       result->NextShapeInContext())
    error = first_error(result->StatusOnShape());
  return error.empty() ? "" : kind_of(shape) + " with " + error;
}

// The outer shell has the most volume; turns all if it looks inwards, and says what is wrong with
// the others.
std::string orient(BuiltSolid* built) {
  std::vector<double> volumes;
  for (TopExp_Explorer it(built->shape, TopAbs_SHELL); it.More(); it.Next())
    volumes.push_back(volume_of(it.Current()));
  const auto outer = std::max_element(volumes.begin(), volumes.end(),
                                      [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (*outer < 0) {
    TopoDS_Solid turned = TopoDS::Solid(built->shape.EmptyCopied());
    const BRep_Builder builder;
    for (TopExp_Explorer it(built->shape, TopAbs_SHELL); it.More(); it.Next())
      builder.Add(turned, it.Current().Reversed());
    built->shape = turned;
    for (TopoDS_Face& face : built->faces) face.Reverse();
    for (double& volume : volumes) volume = -volume;
  }
  if (std::count_if(volumes.begin(), volumes.end(), [](double v) { return v > 0; }) > 1)
    return "it is of more than one piece";
  return "";
}

std::string why_not(const Solid& solid, const SolidCheck& check, const BuiltSolid& built) {
  if (!(check.tolerance <= kMostTolerance * built.extent)) {
    std::ostringstream text;
    text.precision(2);
    text << "curves lie beside their faces by " << check.tolerance / built.extent
         << " of the extent";
    return text.str();
  }
  const std::string fault = brep::fault_of(built.shape);
  if (!fault.empty()) return fault;
  for (TopExp_Explorer it(built.shape, TopAbs_SHELL); it.More(); it.Next())
    if (!BRep_Tool::IsClosed(it.Current())) return "its faces do not close";
  if (!(check.volume > 1e-9 * std::pow(built.extent, 3))) return "it has no volume";
  return self_intersection(solid, built, check.tolerance);
}

}  // namespace

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

std::string kind_of(const TopoDS_Shape& shape) {
  constexpr const char* kNames[] = {"compound", "compsolid", "solid", "shell",
                                    "face",     "wire",      "edge",  "vertex"};
  return kNames[int(shape.ShapeType())];
}

std::string fault_of(const TopoDS_Shape& shape) {
  const BRepCheck_Analyzer analyzer(shape);
  if (analyzer.IsValid()) return "";
  for (const TopAbs_ShapeEnum kind :
       {TopAbs_VERTEX, TopAbs_EDGE, TopAbs_WIRE, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID})
    for (TopExp_Explorer it(shape, kind); it.More(); it.Next()) {
      const std::string fault = fault_in(analyzer, it.Current());
      if (!fault.empty()) return fault;
    }
  return "no valid shape";
}

double tolerance_of(const TopoDS_Shape& shape) {
  double most = 0;
  for (TopExp_Explorer it(shape, TopAbs_EDGE); it.More(); it.Next())
    most = std::max(most, BRep_Tool::Tolerance(TopoDS::Edge(it.Current())));
  for (TopExp_Explorer it(shape, TopAbs_VERTEX); it.More(); it.Next())
    most = std::max(most, BRep_Tool::Tolerance(TopoDS::Vertex(it.Current())));
  return most;
}

SolidCheck check_solid(const Solid& solid, BuiltSolid* built) {
  SolidCheck check;
  check.why = orient(built);
  check.tolerance = tolerance_of(built->shape);
  check.volume = volume_of(built->shape);
  check.area = area_of(built->shape);
  if (check.why.empty()) check.why = why_not(solid, check, *built);
  check.valid = check.why.empty();
  check.volume /= std::pow(built->scale, 3);
  check.area /= std::pow(built->scale, 2);
  check.tolerance /= built->scale;
  return check;
}

}  // namespace sketchsplat::brep
