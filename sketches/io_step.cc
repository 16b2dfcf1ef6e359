// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ostream>

#include "sketches/conic.h"
#include "sketches/curve.h"
#include "sketches/io.h"
#include "sketches/io_number.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

constexpr int kKinds = 5;
// Colours of the kinds, in the order of StrokeKind: dark grey, blue, green, violet, orange.
constexpr double kColour[kKinds][3] = {
    {0.15, 0.15, 0.15}, {0.0, 0.35, 0.85}, {0.0, 0.6, 0.3}, {0.6, 0.1, 0.7}, {0.9, 0.45, 0.0}};

// A share of the sketch's extent that no CAD program looks at: arcs flatter than it are lines.
constexpr double kUncertainty = 1e-7;

std::string real(double x) {
  std::string text = shortest(x == 0 ? 0.0 : x);  // no negative zero
  const size_t e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') == std::string::npos) mantissa += '.';
  return e == std::string::npos ? mantissa : mantissa + "E" + text.substr(e + 1);
}

std::string triple(const Vector3d& p) {
  return "(" + real(p.x()) + "," + real(p.y()) + "," + real(p.z()) + ")";
}

// The code point at `i` of UTF-8 text, and `i` moved behind it; U+FFFD for what is no UTF-8.
uint32_t decode(const std::string& text, size_t* i) {
  const auto byte = [&](size_t k) -> uint32_t { return k < text.size() ? uint8_t(text[k]) : 0; };
  const uint32_t first = byte((*i)++);
  const int more = first < 0x80       ? 0
                   : first >> 5 == 6  ? 1
                   : first >> 4 == 14 ? 2
                   : first >> 3 == 30 ? 3
                                      : -1;
  if (more == 0) return first;
  if (more < 0) return 0xfffd;
  uint32_t code = first & (0x3f >> more);
  for (int k = 0; k < more; ++k) {
    if (byte(*i) >> 6 != 2) return 0xfffd;
    code = code << 6 | (byte((*i)++) & 0x3f);
  }
  return code > 0x10ffff ? 0xfffd : code;
}

// A string of ISO 10303-21: quotes and backslashes doubled, all but printable ASCII in hexadecimal.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (size_t i = 0; i < text.size();) {
    const uint32_t code = decode(text, &i);
    if (code == '\'' || code == '\\') {
      out += std::string(2, char(code));
    } else if (code >= 32 && code < 127) {
      out += char(code);
    } else {
      char hex[24];
      std::snprintf(hex, sizeof(hex), code > 0xffff ? "\\X4\\%08X\\X0\\" : "\\X2\\%04X\\X0\\",
                    code);
      out += hex;
    }
  }
  return out + "'";
}

std::string reference(int id) { return "#" + std::to_string(id); }

std::string list(const std::vector<int>& ids) {
  std::string out = "(";
  for (size_t i = 0; i < ids.size(); ++i) out += (i ? "," : "") + reference(ids[i]);
  return out + ")";
}

// Writes numbered entities; every method returns the number of the one that stands for the whole.
class StepFile {
 public:
  StepFile(std::ostream& out, double scale) : out_(out), scale_(scale) {}

  int add(const std::string& entity) {
    out_ << "#" << ++last_ << "=" << entity << ";\n";
    return last_;
  }
  int point(const Vector3d& p) { return add("CARTESIAN_POINT(''," + triple(scale_ * p) + ")"); }
  int direction(const Vector3d& d) { return add("DIRECTION(''," + triple(d) + ")"); }
  int vertex(const Vector3d& p) { return add("VERTEX_POINT(''," + reference(point(p)) + ")"); }
  int placement(const Vector3d& origin, const Vector3d& axis, const Vector3d& x) {
    const int o = point(origin), a = direction(axis), r = direction(x);
    return add("AXIS2_PLACEMENT_3D(''," + reference(o) + "," + reference(a) + "," + reference(r) +
               ")");
  }
  int line(const Vector3d& begin, const Vector3d& end) {
    const int p = point(begin), d = direction((end - begin).normalized());
    const int v =
        add("VECTOR(''," + reference(d) + "," + real(scale_ * (end - begin).norm()) + ")");
    return add("LINE(''," + reference(p) + "," + reference(v) + ")");
  }
  int circle(const Vector3d& centre, const Vector3d& normal, const Vector3d& x, double radius) {
    const int axes = placement(centre, normal, x);
    return add("CIRCLE(''," + reference(axes) + "," + real(scale_ * radius) + ")");
  }
  int ellipse(const Vector3d& centre, const EllipseAxes& axes) {
    const int frame =
        placement(centre, axes.major.cross(axes.minor).normalized(), axes.major.normalized());
    return add("ELLIPSE(''," + reference(frame) + "," + real(scale_ * axes.major.norm()) + "," +
               real(scale_ * axes.minor.norm()) + ")");
  }
  int cubic(const ControlPoints& c) {
    std::vector<int> points;
    for (int k = 0; k < 4; ++k) points.push_back(point(c.p[k]));
    return add("B_SPLINE_CURVE_WITH_KNOTS('',3," + list(points) +
               ",.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),.PIECEWISE_BEZIER_KNOTS.)");
  }

 private:
  std::ostream& out_;
  double scale_;
  int last_ = 0;
};

// A unit vector square to a unit normal, along the world's axes as far as it can be.
Vector3d plain_direction(const Vector3d& normal) {
  int k;
  normal.cwiseAbs().minCoeff(&k);
  const Vector3d axis = Vector3d::Unit(k);
  return (axis - normal * normal[k]).normalized();
}

// EDGE_CURVE of a stroke; a closed one gets a vertex of its own and uses it twice.
int write_edge(const Sketch& sketch, int s, const std::vector<int>& vertex, double uncertainty,
               StepFile* file) {
  const Stroke& stroke = sketch.strokes[s];
  const ControlPoints c = control_points(sketch, s);
  int curve = 0, begin = 0, end = 0;
  if (!is_closed(stroke.kind)) {
    begin = vertex[stroke.begin];
    end = vertex[stroke.end];
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
      const Vector3d x = plain_direction(k.normal);
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
      curve = file->cubic(c);
      break;
  }
  const std::string name = std::string(kind_name(stroke.kind)) + "_" + std::to_string(s);
  return file->add("EDGE_CURVE(" + quoted(name) + "," + reference(begin) + "," + reference(end) +
                   "," + reference(curve) + ",.T.)");
}

// Strokes in chains that end where not exactly two strokes meet (a closed chain anywhere).
// Not whole components: OpenCASCADE reads every CONNECTED_EDGE_SET as a wire and repairs it, and
// where a wire branches the repair merges vertices that are an edge apart.
std::vector<std::vector<int>> chains(const Sketch& sketch) {
  std::vector<std::vector<int>> at_node(sketch.nodes.cols()), out;
  for (int i = 0; i < sketch.size(); ++i) {
    if (is_closed(sketch.strokes[i].kind)) continue;
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
      const Stroke& s = sketch.strokes[stroke];
      node = s.begin == node ? s.end : s.begin;
    }
  };
  for (int i = 0; i < sketch.size(); ++i) {
    if (done[i]) continue;
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

// Units (millimetres, radians) and the distance below which points are the same.
int write_context(StepFile* file, double uncertainty) {
  const int mm = file->add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const int rad = file->add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const int sr = file->add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const int u =
      file->add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + real(uncertainty) + ")," +
                reference(mm) + ",'distance_accuracy_value','maximum model space distance')");
  return file->add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" +
                   reference(u) + "))GLOBAL_UNIT_ASSIGNED_CONTEXT(" + list({mm, rad, sr}) +
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

// One style a kind, one STYLED_ITEM an edge.
void write_colours(StepFile* file, const Sketch& sketch, const std::vector<int>& edges,
                   int context) {
  int style[kKinds] = {};
  std::vector<int> items;
  const int font = file->add("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')");
  for (int i = 0; i < sketch.size(); ++i) {
    const int kind = int(sketch.strokes[i].kind);
    if (style[kind] == 0) {
      const double* rgb = kColour[kind];
      const int colour = file->add("COLOUR_RGB(''," + real(rgb[0]) + "," + real(rgb[1]) + "," +
                                   real(rgb[2]) + ")");
      const int curve = file->add("CURVE_STYLE(''," + reference(font) +
                                  ",POSITIVE_LENGTH_MEASURE(0.1)," + reference(colour) + ")");
      style[kind] = file->add("PRESENTATION_STYLE_ASSIGNMENT(" + list({curve}) + ")");
    }
    items.push_back(
        file->add("STYLED_ITEM('colour'," + list({style[kind]}) + "," + reference(edges[i]) + ")"));
  }
  file->add("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(''," + list(items) + "," +
            reference(context) + ")");
}

// Edges of all strokes and the model that holds them, one CONNECTED_EDGE_SET a chain.
int write_wireframe(StepFile* file, const Sketch& sketch, const std::string& name,
                    double uncertainty, std::vector<int>* edges) {
  std::vector<int> vertex, sets;
  for (int i = 0; i < sketch.nodes.cols(); ++i) vertex.push_back(file->vertex(sketch.nodes.col(i)));
  for (int i = 0; i < sketch.size(); ++i)
    edges->push_back(write_edge(sketch, i, vertex, uncertainty, file));
  for (const std::vector<int>& chain : chains(sketch)) {
    std::vector<int> ids;
    for (int i : chain) ids.push_back((*edges)[i]);
    sets.push_back(file->add("CONNECTED_EDGE_SET(''," + list(ids) + ")"));
  }
  return file->add("EDGE_BASED_WIREFRAME_MODEL(" + quoted(name) + "," + list(sets) + ")");
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
  const int context = write_context(&file, uncertainty * options.scale);
  const int origin = file.placement({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const std::string label = quoted(options.name);
  if (sketch.size() == 0) {  // a wireframe must not be empty, a plain representation may be
    const int shape = file.add("SHAPE_REPRESENTATION(" + label + "," + list({origin}) + "," +
                               reference(context) + ")");
    write_product(&file, options.name, shape);
  } else {
    std::vector<int> edges;
    const int model = write_wireframe(&file, sketch, options.name, uncertainty, &edges);
    const int shape = file.add("EDGE_BASED_WIREFRAME_SHAPE_REPRESENTATION(" + label + "," +
                               list({origin, model}) + "," + reference(context) + ")");
    write_product(&file, options.name, shape);
    write_colours(&file, sketch, edges, context);
  }
  out << "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace sketchsplat
