// SPDX-License-Identifier: MIT
#include "topology/brep/build_solid.h"

#include <BRep_Builder.hxx>
#include <ShapeFix.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "sketches/curve/curve.h"
#include "topology/brep/build_face.h"
#include "topology/brep/geometry.h"

namespace sketchsplat::brep {
namespace {

// A share of the extent within which places are one; gaps that are larger are so, up to kMostNear.
constexpr double kNear = 1e-6, kMostNear = 5e-5;

std::string of_face(size_t face, SurfaceKind kind) {
  return "face " + std::to_string(face) + ", a " + surface_name(kind) + ": ";
}

void check_loop(const Sketch& sketch, const Loop& loop) {
  for (size_t i = 0; i < loop.size(); ++i) {
    const LoopStroke &a = loop[i], &b = loop[(i + 1) % loop.size()];
    if (a.stroke < 0 || a.stroke >= sketch.size()) throw Refused("it names an edge that is not");
    if (b.stroke < 0 || b.stroke >= sketch.size()) throw Refused("it names an edge that is not");
    const Stroke &s = sketch.strokes[a.stroke], &t = sketch.strokes[b.stroke];
    if ((a.forward ? s.end : s.begin) != (b.forward ? t.begin : t.end) ||
        (is_closed(s.kind) && loop.size() > 1))
      throw Refused("a loop of it is not closed");
  }
  if (loop.empty()) throw Refused("a loop of it is empty");
}

// Every stroke bounds two faces, run in opposite directions.
void check_uses(const Solid& solid) {
  std::vector<int> forward(solid.edges.size()), backward(solid.edges.size());
  for (const SolidFace& face : solid.faces)
    for (const Loop& loop : face.loops)
      for (const LoopStroke& s : loop) ++(s.forward ? forward : backward)[s.stroke];
  for (int i = 0; i < solid.edges.size(); ++i) {
    const std::string edge =
        "edge " + std::to_string(i) + ", " + (kind_name(solid.edges.strokes[i].kind)) + ": ";
    const int uses = forward[i] + backward[i];
    if (uses != 2)
      throw Refused(edge + "it bounds " + std::to_string(uses) + (uses == 1 ? " face" : " faces") +
                    ", not two");
    if (forward[i] != 1) throw Refused(edge + "both of its faces run it in the same direction");
  }
}

void check_indices(const Solid& solid) {
  if (solid.faces.empty()) throw Refused("it has no faces");
  for (size_t f = 0; f < solid.faces.size(); ++f) {
    const SolidFace& face = solid.faces[f];
    if (face.surface < 0 || face.surface >= int(solid.surfaces.size()))
      throw Refused("face " + std::to_string(f) + ": it lies on no surface");
    try {
      for (const Loop& loop : face.loops) check_loop(solid.edges, loop);
    } catch (const Refused& why) {
      throw Refused(of_face(f, solid.surfaces[face.surface].kind) + why.what());
    }
  }
  check_uses(solid);
}

// Faces that share strokes, in sets.
std::vector<std::vector<int>> connected(const Solid& solid) {
  std::vector<int> set(solid.faces.size()), owner(solid.edges.size(), -1);
  std::iota(set.begin(), set.end(), 0);
  for (int f = 0; f < int(solid.faces.size()); ++f)
    for (const Loop& loop : solid.faces[f].loops)
      for (const LoopStroke& s : loop) {
        int& first = owner[s.stroke];
        if (first < 0) first = f;
        const int from = set[f], to = set[first];
        std::replace(set.begin(), set.end(), std::max(from, to), std::min(from, to));
      }
  std::vector<std::vector<int>> out;
  for (int id = 0; id < int(set.size()); ++id) {
    std::vector<int> members;
    for (int f = 0; f < int(set.size()); ++f)
      if (set[f] == id) members.push_back(f);
    if (!members.empty()) out.push_back(members);
  }
  return out;
}

// The faces as shells of a solid.
TopoDS_Solid assembled(const Solid& solid, const std::vector<TopoDS_Face>& faces) {
  const BRep_Builder builder;
  TopoDS_Solid whole;
  builder.MakeSolid(whole);
  for (const std::vector<int>& members : connected(solid)) {
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    for (const int f : members) builder.Add(shell, faces[f]);
    shell.Closed(true);
    builder.Add(whole, shell);
  }
  return whole;
}

// Of the box about the edges and the surfaces that have none.
double extent_of(const Solid& solid) {
  double extent = largest_extent(solid.edges);
  for (const SolidFace& face : solid.faces) {
    if (!face.loops.empty() || face.surface < 0 || face.surface >= int(solid.surfaces.size()))
      continue;
    const Surface& s = solid.surfaces[face.surface];
    extent = std::max(extent, 2 * (s.radius + s.minor_radius));
  }
  return extent;
}

}  // namespace

BuiltSolid build_solid(const Solid& given) {
  BuiltSolid built;
  built.extent = extent_of(given);
  if (!std::isfinite(built.extent) || !(built.extent > 0)) throw Refused("it has no extent");
  built.scale = std::exp2(7 - std::ceil(std::log2(built.extent)));
  built.extent *= built.scale;
  const Solid solid = scaled(given, built.scale);
  check_indices(solid);
  const std::vector<TopoDS_Edge> edges = build_edges(solid, built.extent * kNear);
  // Poles and ends of seams are where curves end, up to what these lie beside their surfaces.
  const double near = std::clamp(4 * solid.gap, kNear * built.extent, kMostNear * built.extent);
  const Handle(ShapeBuild_ReShape) context = new ShapeBuild_ReShape;
  for (size_t f = 0; f < solid.faces.size(); ++f) {
    try {
      built.faces.push_back(build_face(solid, solid.faces[f], edges, near, context));
    } catch (const Refused& why) {
      throw Refused(of_face(f, solid.surfaces[solid.faces[f].surface].kind) + why.what());
    }
  }
  for (TopoDS_Face& face : built.faces) face = TopoDS::Face(context->Apply(face));
  built.shape = assembled(solid, built.faces);
  ShapeFix::SameParameter(built.shape, /*enforce=*/false);  // tolerances, by curves on surfaces
  return built;
}

}  // namespace sketchsplat::brep
