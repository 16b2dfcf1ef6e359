// SPDX-License-Identifier: MIT
#include <BOPAlgo_ArgumentAnalyzer.hxx>
#include <BOPAlgo_CheckResult.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Section.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <vector>

#include "topology/brep/check.h"

namespace sketchsplat::brep {
namespace {

std::string name_of(const TopoDS_Shape& faulty, const Solid& solid, const BuiltSolid& built) {
  for (size_t f = 0; f < built.faces.size(); ++f) {
    TopTools_IndexedMapOfShape parts;
    TopExp::MapShapes(built.faces[f], parts);
    if (!parts.Contains(faulty)) continue;
    const std::string face = "face " + std::to_string(f) + ", a " +
                             surface_name(solid.surfaces[solid.faces[f].surface].kind);
    return faulty.ShapeType() == TopAbs_FACE ? face : kind_of(faulty) + " of " + face;
  }
  return kind_of(faulty);
}

std::vector<BRepAdaptor_Curve> common_edges(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  TopTools_IndexedMapOfShape parts;
  TopExp::MapShapes(b, parts);
  std::vector<BRepAdaptor_Curve> out;
  for (TopExp_Explorer it(a, TopAbs_EDGE); it.More(); it.Next())
    if (parts.Contains(it.Current()) && !BRep_Tool::Degenerated(TopoDS::Edge(it.Current())))
      out.emplace_back(TopoDS::Edge(it.Current()));
  return out;
}

// By steps, then by sections around the nearest: Extrema finds no foot on ellipses of points that
// lie on them.
double distance(const gp_Pnt& p, const BRepAdaptor_Curve& curve) {
  constexpr int kSteps = 128;
  const double first = curve.FirstParameter(), step = (curve.LastParameter() - first) / kSteps;
  const auto off = [&](double x) { return p.Distance(curve.Value(first + x * step)); };
  int best = 0;
  for (int i = 1; i <= kSteps; ++i)
    if (off(i) < off(best)) best = i;
  double low = std::max(0, best - 1), high = std::min(kSteps, best + 1);
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (off(a) < off(b))
      high = b;
    else
      low = a;
  }
  return off((low + high) / 2);
}

// Where the surfaces of neighbours meet along their common edge, the analyzer may not recognise the
// edge, most of all beside a seam: what counts is where they meet.
bool meet_elsewhere(const TopoDS_Shape& a, const TopoDS_Shape& b, double near) {
  const std::vector<BRepAdaptor_Curve> border = common_edges(a, b);
  if (border.empty()) return true;
  BRepAlgoAPI_Section section(a, b, /*PerformNow=*/false);
  section.Build();
  if (!section.IsDone()) return true;
  for (TopExp_Explorer it(section.Shape(), TopAbs_EDGE); it.More(); it.Next()) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(it.Current()));
    constexpr int kSteps = 8;
    for (int i = 0; i <= kSteps; ++i) {
      const double share = double(i) / kSteps;
      const gp_Pnt place =
          curve.Value(curve.FirstParameter() * (1 - share) + curve.LastParameter() * share);
      const bool on_border = std::any_of(border.begin(), border.end(), [&](const auto& edge) {
        return distance(place, edge) <= near;
      });
      if (!on_border) return true;
    }
  }
  return false;
}

}  // namespace

std::string self_intersection(const Solid& solid, const BuiltSolid& built, double tolerance) {
  const double near = std::max(10 * tolerance, 1e-6 * built.extent);
  BOPAlgo_ArgumentAnalyzer analyzer;
  analyzer.SetShape1(built.shape);
  analyzer.ArgumentTypeMode() = false;
  analyzer.SelfInterMode() = true;
  analyzer.SetFuzzyValue(tolerance);
  analyzer.Perform();
  for (const BOPAlgo_CheckResult& result : analyzer.GetCheckResult()) {
    if (result.GetCheckStatus() != BOPAlgo_SelfIntersect) continue;
    const std::vector<TopoDS_Shape> faulty(result.GetFaultyShapes1().begin(),
                                           result.GetFaultyShapes1().end());
    if (faulty.size() == 2 && faulty[0].ShapeType() == TopAbs_FACE &&
        faulty[1].ShapeType() == TopAbs_FACE && !meet_elsewhere(faulty[0], faulty[1], near))
      continue;
    std::string who;
    for (const TopoDS_Shape& shape : faulty)
      who += (who.empty() ? "" : " and ") + name_of(shape, solid, built);
    return "it runs through itself: " + who;
  }
  return "";
}

}  // namespace sketchsplat::brep
