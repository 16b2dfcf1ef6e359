// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"
#include "sketches/io/length_unit.h"

namespace sketchsplat {

/// Our own format (`sketch.json`): nodes, strokes, evidence. Numbers survive a round trip exactly;
/// handles come back in the order of the strokes. Centre, normal, radius, angle and principal axes
/// are written for readers and ignored when read. `extra` is a JSON object as text whose members
/// are added at the top (options, version); may be empty. Throws InputError if it is none.
/// As for all writers here, validate(sketch) has nothing to say and the caller looks at the stream.
void write_sketch_json(std::ostream& out, const Sketch& sketch, const std::string& extra = "");
/// Throws InputError(path, ...) if the text is no JSON, misses a key or breaks an invariant.
/// Absent evidence gets its default.
Sketch read_sketch_json(std::istream& in, const std::string& path);

/// EMAP's `parametric_edges.json`: lines by end points, everything else as cubics (arcs and
/// ellipses to 1e-5 of their size).
void write_parametric_edges(std::ostream& out, const Sketch& sketch);

/// All `v` first, then two-vertex `l` segments grouped by `o` per stroke; junctions share a vertex.
/// Chords stay within `deflection` (fraction of the sketch's largest extent) of the curve.
/// Coordinates are multiplied by `scale`.
void write_obj(std::ostream& out, const Sketch& sketch, double deflection = 1e-4,
               double scale = 1.0);

/// What strokes of a STEP file look like, and the layer that holds them.
struct StepPaint {
  std::string layer;
  double red = 0, green = 0, blue = 0;  ///< [0, 1]
};

struct StepOptions {
  std::string name = "sketch";                ///< of the product, as CAD programs show it
  double scale = 1.0;                         ///< units per world unit
  LengthUnit unit = LengthUnit::kMillimetre;  ///< of the numbers in the file
  std::vector<PlanarFace> faces = {};         ///< written as such; their strokes bound them
  std::vector<StepPaint> paints = {};         ///< empty: a colour and a layer by kind
  std::vector<int> paint_of_stroke = {};      ///< of each stroke; index into paints, if there are
};
/// AP214 edge-based wireframe: one product, one vertex per junction; LINE, CIRCLE, ELLIPSE,
/// B_SPLINE_CURVE as such, one CONNECTED_EDGE_SET per unbranched chain; a colour and a layer by
/// kind, an edge is named by kind and index. Arcs flatter than 1e-7 of the extent become lines. The
/// name is UTF-8. No time stamp, so the same sketch gives the same bytes. Without strokes: a valid
/// file with a product and nothing in it.
/// Faces go into a shell-based surface model beside the wireframe (related representations); a
/// stroke is in one of the two, so that readers count each once.
void write_step(std::ostream& out, const Sketch& sketch, const StepOptions& options = {});

struct DxfOptions {
  double scale = 1.0;                         ///< units per world unit
  LengthUnit unit = LengthUnit::kMillimetre;  ///< $INSUNITS
};
/// AutoCAD 2000 DXF (ASCII): LINE, ARC, CIRCLE, ELLIPSE, SPLINE on a layer by kind. Arcs and
/// circles lie in the plane of their extrusion direction (arbitrary axis algorithm). Arcs flatter
/// than 1e-7 of the extent become lines.
void write_dxf(std::ostream& out, const Sketch& sketch, const DxfOptions& options = {});

/// Binary little-endian PLY: samples of all strokes every `spacing` world units with
/// `stroke_index`.
void write_edge_points(std::ostream& out, const Sketch& sketch, double spacing);

/// A curve as cubic pieces, 3 x 4 control points each; error at most `tolerance` times its size.
std::vector<Eigen::Matrix<double, 3, 4>> to_cubics(const Sketch& sketch, int stroke,
                                                   double tolerance = 1e-5);

}  // namespace sketchsplat
