// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ostream>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/graph/kind_color.h"
#include "sketches/io/io.h"
#include "sketches/io/step_file.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;
using step::list;
using step::quoted;
using step::real;
using step::reference;
using step::StepFile;

constexpr const char* kLayers[kNumKinds] = {"line",    "arc",    "circle",
                                            "ellipse", "spline", "elliptic_arc"};
const StepPaint kFacePaint = {"face", 0.8, 0.8, 0.8};

// A share of the sketch's extent that no CAD program looks at: arcs flatter than it are lines.
constexpr double kUncertainty = 1e-7;

// EDGE_CURVE of a curve; a closed one gets a vertex of its own and uses it twice.
int write_edge(const Sketch& sketch, const CurveChain& chain, int index,
               const std::vector<int>& vertex, double uncertainty, StepFile* file) {
  const int s = chain.strokes[0];
  const Stroke& stroke = sketch.strokes[s];
  const ControlPoints c = control_points(sketch, s);
  int curve = 0, begin = 0, end = 0;
  if (!is_closed(stroke.kind)) {
    begin = vertex[chain.begin];
    end = vertex[chain.end];
  }
  switch (stroke.kind) {
    case StrokeKind::kLine:
      curve = file->line(c.p[0], c.p[1]);
      break;
    case StrokeKind::kArc: {
      const CircleParameters k = circle_parameters(sketch, s);
      const double sagitta = k.straight ? 0 : 2 * k.radius * std::pow(std::sin(k.angle / 4), 2);
      curve = sagitta > uncertainty
                  ? file->circle(k.centre, k.normal, (c.p[0] - k.centre).normalized(), k.radius)
                  : file->line(c.p[0], c.p[2]);
      break;
    }
    case StrokeKind::kCircle: {
      const CircleParameters k = circle_parameters(sketch, s);
      const Vector3d x = step::plain_direction(k.normal);
      curve = file->circle(k.centre, k.normal, x, k.radius);
      begin = end = file->vertex(k.centre + k.radius * x);
      break;
    }
    case StrokeKind::kEllipse: {
      const EllipseAxes axes = principal_axes(c.p[1], c.p[2]);
      curve = file->ellipse(c.p[0], axes);
      begin = end = file->vertex(c.p[0] + axes.major);
      break;
    }
    case StrokeKind::kBezier:
      curve = file->spline(chain_spline(sketch, chain));
      break;
    case StrokeKind::kEllipticArc: {
      const EllipticArcParameters e = elliptic_arc_parameters(c);
      const Eigen::Vector3d rise = c.p[1] - (c.p[0] + c.p[3]) / 2;
      curve = !e.straight && rise.norm() > uncertainty
                  ? file->ellipse(e.centre, principal_axes(e.p, e.q))
                  : file->line(c.p[0], c.p[3]);
      break;
    }
  }
  const std::string name = std::string(kind_name(stroke.kind)) + "_" + std::to_string(index);
  return file->add("EDGE_CURVE(" + quoted(name) + "," + reference(begin) + "," + reference(end) +
                   "," + reference(curve) + ",.T.)");
}

// Free strokes in chains that end where not exactly two strokes meet (a closed chain anywhere).
// Not whole components: OpenCASCADE reads every CONNECTED_EDGE_SET as a wire and repairs it, and
// where a wire branches the repair merges vertices that are an edge apart.
std::vector<std::vector<int>> chains(const Sketch& sketch, const std::vector<bool>& free) {
  std::vector<std::vector<int>> at_node(sketch.nodes.cols()), out;
  for (int i = 0; i < sketch.size(); ++i) {
    if (!free[i] || is_closed(sketch.strokes[i].kind)) continue;
    at_node[sketch.strokes[i].begin].push_back(i);
    at_node[sketch.strokes[i].end].push_back(i);
  }
  std::vector<bool> done(sketch.size());
  // Follows a stroke out of one of its ends as far as the chain goes.
  const auto follow = [&](int stroke, int node, std::vector<int>* chain) {
    while (at_node[node].size() == 2) {
      stroke = at_node[node][at_node[node][0] == stroke ? 1 : 0];
      if (done[stroke]) return;
      done[stroke] = true;
      chain->push_back(stroke);
      node = other_end(sketch.strokes[stroke], node);
    }
  };
  for (int i = 0; i < sketch.size(); ++i) {
    if (done[i] || !free[i]) continue;
    done[i] = true;
    std::vector<int> chain;
    const Stroke& s = sketch.strokes[i];
    if (!is_closed(s.kind)) {
      follow(i, s.begin, &chain);
      std::reverse(chain.begin(), chain.end());
    }
    chain.push_back(i);
    if (!is_closed(s.kind)) follow(i, s.end, &chain);
    out.push_back(chain);
  }
  return out;
}

int write_length_unit(StepFile* file, LengthUnit unit) {
  const auto si = [&](const std::string& prefix) {
    return file->add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(" + prefix + ",.METRE.))");
  };
  if (unit == LengthUnit::kMillimetre) return si(".MILLI.");
  if (unit == LengthUnit::kCentimetre) return si(".CENTI.");
  if (unit == LengthUnit::kMetre) return si("$");
  const int size = file->add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + real(millimetres(unit)) +
                             ")," + reference(si(".MILLI.")) + ")");
  const int length = file->add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
  return file->add("(CONVERSION_BASED_UNIT('INCH'," + reference(size) +
                   ")LENGTH_UNIT()NAMED_UNIT(" + reference(length) + "))");
}

// Units and the distance, in them, below which points are the same.
int write_context(StepFile* file, LengthUnit unit, double uncertainty) {
  const int length = write_length_unit(file, unit);
  const int rad = file->add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const int sr = file->add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const int u =
      file->add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + real(uncertainty) + ")," +
                reference(length) + ",'distance_accuracy_value','maximum model space distance')");
  return file->add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" +
                   reference(u) + "))GLOBAL_UNIT_ASSIGNED_CONTEXT(" + list({length, rad, sr}) +
                   ")REPRESENTATION_CONTEXT('',''))");
}

void write_product(StepFile* file, const std::string& name, int representation) {
  const std::string label = quoted(name);
  const int context = file->add("APPLICATION_CONTEXT('automotive design')");
  file->add("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000," +
            reference(context) + ")");
  const int mechanical = file->add("PRODUCT_CONTEXT(''," + reference(context) + ",'mechanical')");
  const int product =
      file->add("PRODUCT(" + label + "," + label + ",''," + list({mechanical}) + ")");
  file->add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$," + list({product}) + ")");
  const int formation = file->add("PRODUCT_DEFINITION_FORMATION('',''," + reference(product) + ")");
  const int design = file->add("PRODUCT_DEFINITION_CONTEXT('part definition'," +
                               reference(context) + ",'design')");
  const int definition = file->add("PRODUCT_DEFINITION('design',''," + reference(formation) + "," +
                                   reference(design) + ")");
  const int shape = file->add("PRODUCT_DEFINITION_SHAPE('',''," + reference(definition) + ")");
  file->add("SHAPE_DEFINITION_REPRESENTATION(" + reference(shape) + "," +
            reference(representation) + ")");
}

// One for each kind, in the order of StrokeKind.
std::vector<StepPaint> kind_paints() {
  std::vector<StepPaint> paints;
  for (int k = 0; k < kNumKinds; ++k) {
    const auto hundredths = [&](int c) {
      return std::round(100.0 * kind_color(StrokeKind(k))[c]) / 100;
    };
    paints.push_back({kLayers[k], hundredths(0), hundredths(1), hundredths(2)});
  }
  return paints;
}

// How edges, or faces, of a paint look.
int write_style(StepFile* file, const StepPaint& paint, bool faces, int font) {
  const std::string colour = reference(file->add("COLOUR_RGB(''," + real(paint.red) + "," +
                                                 real(paint.green) + "," + real(paint.blue) + ")"));
  int style = 0;
  if (!faces) {
    style = file->add("CURVE_STYLE(''," + reference(font) + ",POSITIVE_LENGTH_MEASURE(0.1)," +
                      colour + ")");
  } else {
    const int fill = file->add("FILL_AREA_STYLE_COLOUR(''," + colour + ")");
    const int area = file->add("FILL_AREA_STYLE(''," + list({fill}) + ")");
    const int surface = file->add("SURFACE_STYLE_FILL_AREA(" + reference(area) + ")");
    const int side = file->add("SURFACE_SIDE_STYLE(''," + list({surface}) + ")");
    style = file->add("SURFACE_STYLE_USAGE(.BOTH.," + reference(side) + ")");
  }
  return file->add("PRESENTATION_STYLE_ASSIGNMENT(" + list({style}) + ")");
}

// One style and one layer a paint, one STYLED_ITEM an edge or face.
void write_presentation(StepFile* file, const std::vector<StepPaint>& paints,
                        const std::vector<int>& paint_of_stroke, const std::vector<int>& edges,
                        const std::vector<int>& faces, int context) {
  std::vector<std::vector<int>> painted(paints.size());
  std::vector<int> items;
  for (size_t i = 0; i < edges.size(); ++i) painted[paint_of_stroke[i]].push_back(edges[i]);
  for (std::vector<int>& ids : painted) {  // the strokes of a chain have one edge
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }
  const int font = file->add("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')");
  const auto write = [&](const StepPaint& paint, const std::vector<int>& ids, bool are_faces) {
    if (ids.empty()) return;
    const int style = write_style(file, paint, are_faces, font);
    for (const int item : ids)
      items.push_back(
          file->add("STYLED_ITEM('colour'," + list({style}) + "," + reference(item) + ")"));
    file->add("PRESENTATION_LAYER_ASSIGNMENT(" + quoted(paint.layer) + ",''," + list(ids) + ")");
  };
  for (size_t k = 0; k < paints.size(); ++k) write(paints[k], painted[k], false);
  write(kFacePaint, faces, true);
  file->add("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(''," + list(items) + "," +
            reference(context) + ")");
}

std::vector<int> kinds_of(const Sketch& sketch) {
  std::vector<int> kinds;
  for (const Stroke& s : sketch.strokes) kinds.push_back(int(s.kind));
  return kinds;
}

std::vector<bool> bounding(const Sketch& sketch, const std::vector<PlanarFace>& faces) {
  std::vector<bool> bounds(sketch.size());
  for (const PlanarFace& face : faces) {
    for (const LoopStroke& s : face.outer) bounds[s.stroke] = true;
    for (const Loop& hole : face.holes)
      for (const LoopStroke& s : hole) bounds[s.stroke] = true;
  }
  return bounds;
}

// The edge of every stroke; those of a smooth chain share one. Faces refer to strokes, so theirs
// stay apart.
std::vector<int> write_edges(StepFile* file, const Sketch& sketch, const std::vector<bool>& alone,
                             double uncertainty) {
  const std::vector<CurveChain> chains = curve_chains(sketch, alone);
  const std::vector<bool> inner = inner_joints(sketch, chains);
  std::vector<int> vertex(inner.size(), 0), edges(sketch.size());
  for (size_t i = 0; i < inner.size(); ++i)
    if (!inner[i]) vertex[i] = file->vertex(sketch.nodes.col(i));
  for (size_t c = 0; c < chains.size(); ++c) {
    const int edge = write_edge(sketch, chains[c], int(c), vertex, uncertainty, file);
    for (int s : chains[c].strokes) edges[s] = edge;
  }
  return edges;
}

// The edges that bound no face, one CONNECTED_EDGE_SET a chain; 0 if there is none.
int write_wireframe(StepFile* file, const Sketch& sketch, const std::vector<int>& edges,
                    std::vector<bool> bounds, const std::string& name) {
  bounds.flip();
  std::vector<int> sets;
  for (const std::vector<int>& chain : chains(sketch, bounds)) {
    std::vector<int> ids;
    for (int i : chain)
      if (std::find(ids.begin(), ids.end(), edges[i]) == ids.end()) ids.push_back(edges[i]);
    sets.push_back(file->add("CONNECTED_EDGE_SET(''," + list(ids) + ")"));
  }
  if (sets.empty()) return 0;
  return file->add("EDGE_BASED_WIREFRAME_MODEL(" + quoted(name) + "," + list(sets) + ")");
}

// The shape of the product: a wireframe, or a plain representation that a wireframe and faces are
// related to. A wireframe must not be empty, a plain representation may be.
int write_shape(StepFile* file, const std::string& name, int origin, int wireframe, int surfaces,
                int context) {
  const auto representation = [&](const char* entity, const std::vector<int>& items) {
    return file->add(std::string(entity) + "(" + quoted(name) + "," + list(items) + "," +
                     reference(context) + ")");
  };
  if (wireframe != 0 && surfaces == 0)
    return representation("EDGE_BASED_WIREFRAME_SHAPE_REPRESENTATION", {origin, wireframe});
  const int shape = representation("SHAPE_REPRESENTATION", {origin});
  const auto relate = [&](int other) {
    file->add("SHAPE_REPRESENTATION_RELATIONSHIP('',''," + reference(shape) + "," +
              reference(other) + ")");
  };
  if (surfaces != 0)
    relate(representation("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", {origin, surfaces}));
  if (wireframe != 0)
    relate(representation("EDGE_BASED_WIREFRAME_SHAPE_REPRESENTATION", {origin, wireframe}));
  return shape;
}

}  // namespace

void write_step(std::ostream& out, const Sketch& sketch, const StepOptions& options) {
  const double extent = largest_extent(sketch);
  const double uncertainty = extent > 0 ? kUncertainty * extent : kUncertainty;
  out << "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('edges as exact curves'),'2;1');\n"
      << "FILE_NAME(" << quoted(options.name)
      << ",'1970-01-01T00:00:00',(''),(''),'sketchsplat','sketchsplat','');\n"
      << "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n";
  StepFile file(out, options.scale);
  const int context = write_context(&file, options.unit, uncertainty * options.scale);
  const int origin = file.placement({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const std::vector<bool> bounds = bounding(sketch, options.faces);
  const std::vector<int> edges = write_edges(&file, sketch, bounds, uncertainty);
  std::vector<int> faces;
  const int surfaces =
      options.faces.empty()
          ? 0
          : step::write_surface_model(&file, options.faces, edges, options.name, &faces);
  const int wireframe = write_wireframe(&file, sketch, edges, bounds, options.name);
  write_product(&file, options.name,
                write_shape(&file, options.name, origin, wireframe, surfaces, context));
  const bool by_kind = options.paints.empty();
  if (sketch.size() > 0)
    write_presentation(&file, by_kind ? kind_paints() : options.paints,
                       by_kind ? kinds_of(sketch) : options.paint_of_stroke, edges, faces, context);
  out << "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace sketchsplat
