// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>
#include <tuple>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "sketches/io/utf8.h"

namespace sketchsplat {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Box2 = Eigen::AlignedBox2d;

// Millimetres on paper: A3 and what is left free.
constexpr double kWidth = 420, kHeight = 297, kMargin = 20, kGap = 20, kTitle = 12;
constexpr double kInvisible = 1e-4;

constexpr const char* kClass[kNumKinds] = {"line",    "arc",    "circle",
                                           "ellipse", "spline", "elliptic_arc"};

// A direction to look from: rows are right and up on paper.
struct View {
  const char* name;
  Eigen::Matrix<double, 2, 3> project;
  Box2 box;        ///< of the part, real mm
  Vector2d shift;  ///< of the part's origin on paper
};

std::string number(double x) {
  char text[64];
  std::string out(text,
                  std::to_chars(text, text + sizeof(text), x, std::chars_format::fixed, 5).ptr);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

// Six digits, for people.
std::string rounded(double x) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof(text), x, std::chars_format::general, 6).ptr};
}

std::string escaped(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const uint32_t code = next_code_point(text, &i);
    if (code < 32) continue;
    if (code > 126 || code == '&' || code == '<' || code == '>')
      out += "&#" + std::to_string(code) + ";";
    else
      out += char(code);
  }
  return out;
}

// Writes the path of a curve on paper, where y points down.
class Path {
 public:
  explicit Path(const Vector2d& begin) { text_ = "M" + pair(begin); }
  void line(const Vector2d& to) { text_ += " L" + pair(to); }
  void cubic(const Vector2d& a, const Vector2d& b, const Vector2d& to) {
    text_ += " C" + pair(a) + " " + pair(b) + " " + pair(to);
  }
  // centre + a cos t + b sin t from 0 to `angle`: conjugate half axes.
  void arc(const Vector2d& centre, const Vector2d& a, const Vector2d& b, double angle) {
    const EllipseAxes axes = principal_axes({a.x(), a.y(), 0}, {b.x(), b.y(), 0});
    const Vector2d major = axes.major.head<2>();
    const double r = major.norm(), q = axes.minor.norm();
    if (!(q > kInvisible)) return edge_on(centre, a, b, angle, major / std::max(r, 1e-300));
    const double turn = std::atan2(major.y(), major.x()) * 180 / M_PI;
    const bool positive = a.x() * b.y() - a.y() * b.x() > 0;
    const int pieces = int(std::ceil(angle / (2 * M_PI / 3) - 1e-9));
    for (int k = 1; k <= std::max(pieces, 1); ++k) {
      const double t = angle * k / std::max(pieces, 1);
      text_ += " A" + number(r) + "," + number(q) + " " + number(turn) + " 0 " +
               (positive ? "1 " : "0 ") + pair(centre + a * std::cos(t) + b * std::sin(t));
    }
  }
  const std::string& text() const { return text_; }

 private:
  static std::string pair(const Vector2d& p) { return number(p.x()) + "," + number(p.y()); }
  // Seen along its plane an arc runs to and fro on a line.
  void edge_on(const Vector2d& centre, const Vector2d& a, const Vector2d& b, double angle,
               const Vector2d& along) {
    const double first = std::atan2(b.dot(along), a.dot(along));
    for (int k = -2; k <= 3; ++k) {
      const double t = first + k * M_PI;
      if (t > 0 && t < angle) line(centre + a * std::cos(t) + b * std::sin(t));
    }
    line(centre + a * std::cos(angle) + b * std::sin(angle));
  }
  std::string text_;
};

// The path of a stroke under x -> project (3D to paper, affine: linear part and shift).
std::string path_of(const Sketch& sketch, int i, const Eigen::Matrix<double, 2, 3>& linear,
                    const Vector2d& shift) {
  const ControlPoints c = control_points(sketch, i);
  const auto at = [&](const Vector3d& p) -> Vector2d { return linear * p + shift; };
  const auto conic = [&](const Vector3d& centre, const Vector3d& a, const Vector3d& b,
                         double angle) {
    Path path(at(centre + a));
    path.arc(at(centre), linear * a, linear * b, angle);
    return path.text();
  };
  switch (sketch.strokes[i].kind) {
    case StrokeKind::kLine:
      break;
    case StrokeKind::kArc: {
      const CircleParameters k = circle_parameters(sketch, i);
      if (k.straight) break;
      const Vector3d a = c.p[0] - k.centre;
      return conic(k.centre, a, k.normal.cross(a), k.angle);
    }
    case StrokeKind::kCircle: {
      const CircleParameters k = circle_parameters(sketch, i);
      Vector3d x, y;
      frame_of<double>(k.normal, &x, &y);
      return conic(k.centre, k.radius * x, k.radius * y, 2 * M_PI) + " Z";
    }
    case StrokeKind::kEllipse:
      return conic(c.p[0], c.p[1], c.p[2], 2 * M_PI) + " Z";
    case StrokeKind::kEllipticArc: {
      const EllipticArcParameters e = elliptic_arc_parameters(c);
      if (e.straight) break;
      const double begin = -e.half_angle;
      return conic(e.centre, std::cos(begin) * e.p + std::sin(begin) * e.q,
                   std::cos(begin) * e.q - std::sin(begin) * e.p, 2 * e.half_angle);
    }
    case StrokeKind::kBezier: {
      Path path(at(c.p[0]));
      path.cubic(at(c.p[1]), at(c.p[2]), at(c.p[3]));
      return path.text();
    }
  }
  Path path(at(c.p[0]));
  path.line(at(c.p[c.count - 1]));
  return path.text();
}

Box2 box_of(const Sketch& sketch, const Eigen::Matrix<double, 2, 3>& linear) {
  Box2 box;
  for (int i = 0; i < sketch.size(); ++i) {
    const Eigen::Matrix3Xd points = sample_stroke(sketch, i, stroke_length(sketch, i) / 64);
    for (int k = 0; k < points.cols(); ++k) box.extend(Vector2d(linear * points.col(k)));
  }
  if (box.isEmpty()) box.extend(Vector2d(0, 0));
  return box;
}

// The largest of 1, 2, 5 x 10^k that is not above; 1 for what has no extent.
double standard_scale(double largest) {
  if (!(largest > 0) || !std::isfinite(largest)) return 1;
  const double power = std::pow(10, std::floor(std::log10(largest)));
  for (const double m : {5.0, 2.0})
    if (m * power <= largest) return m * power;
  return power;
}

std::string ratio(double scale) {
  return scale >= 1 ? rounded(scale) + " : 1" : "1 : " + rounded(1 / scale);
}

// Views of a part in real mm, in their places; returns paper mm per real mm.
double lay_out(const Sketch& sketch, double real, View (&views)[4]) {
  for (View& v : views) v.box = box_of(sketch, real * v.project);
  const auto [front, top, right, iso] =
      std::tie(views[0].box, views[1].box, views[2].box, views[3].box);
  const Vector2d left_column(front.sizes().x(), right.sizes().y());
  const double right_width = std::max(right.sizes().x(), iso.sizes().x());
  const double top_height = std::max(top.sizes().y(), iso.sizes().y());
  const double scale = standard_scale(
      std::min((kWidth - 2 * kMargin - kGap) / (left_column.x() + right_width),
               (kHeight - 2 * kMargin - kGap - kTitle) / (left_column.y() + top_height)));
  // Centres of the columns and rows; front and top, front and right share coordinates.
  const double used_x = scale * (left_column.x() + right_width) + kGap;
  const double used_y = scale * (left_column.y() + top_height) + kGap;
  const double x0 = (kWidth - used_x) / 2 + scale * left_column.x() / 2;
  const double x1 = (kWidth + used_x) / 2 - scale * right_width / 2;
  const double y0 = (kHeight - kTitle - used_y) / 2 + scale * top_height / 2;
  const double y1 = (kHeight - kTitle + used_y) / 2 - scale * left_column.y() / 2;
  const Vector2d places[4] = {{x0, y1}, {x0, y0}, {x1, y1}, {x1, y0}};
  for (int k = 0; k < 4; ++k) {
    const Vector2d centre = scale * views[k].box.center();
    views[k].shift = places[k] + Vector2d(-centre.x(), centre.y());
  }
  return scale;
}

void write_view(std::ostream& out, const Sketch& sketch, const View& view, double scale,
                double real) {
  Eigen::Matrix<double, 2, 3> linear = scale * real * view.project;
  linear.row(1) *= -1;
  out << "<g id=\"" << view.name << "\">\n";
  for (int i = 0; i < sketch.size(); ++i)
    out << "<path class=\"stroke " << kClass[int(sketch.strokes[i].kind)] << "\" d=\""
        << path_of(sketch, i, linear, view.shift) << "\"/>\n";
  const double x = view.shift.x() + scale * view.box.center().x();
  const double y = view.shift.y() - scale * view.box.min().y() + 7;
  out << "<text x=\"" << number(x) << "\" y=\"" << number(y) << "\">" << view.name
      << "</text>\n</g>\n";
}

}  // namespace

void write_svg(std::ostream& out, const Sketch& sketch, const SvgOptions& options) {
  View views[4] = {
      {"front", {}, {}, {}}, {"top", {}, {}, {}}, {"right", {}, {}, {}}, {"isometric", {}, {}, {}}};
  views[0].project << 1, 0, 0, 0, 0, 1;
  views[1].project << 1, 0, 0, 0, 1, 0;
  views[2].project << 0, 1, 0, 0, 0, 1;
  const double a = std::sqrt(0.5), b = std::sqrt(1.0 / 6), c = std::sqrt(2.0 / 3);
  views[3].project << a, a, 0, -b, b, c;  // from (1, -1, 1): the front on the left
  const double unit = millimetres(options.unit), real = options.scale * unit;
  const double scale = lay_out(sketch, real, views);
  const Vector2d front = views[0].box.sizes() / unit, top = views[1].box.sizes() / unit;
  const std::string unit_name = length_unit_names()[int(options.unit)];
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << number(kWidth) << "mm\" height=\""
      << number(kHeight) << "mm\" viewBox=\"0 0 " << number(kWidth) << " " << number(kHeight)
      << "\">\n<title>" << escaped(options.name) << "</title>\n<style>\n"
      << ".stroke{fill:none;stroke-width:0.35;stroke-linecap:round;stroke-linejoin:round}\n"
      << ".line{stroke:#262626}.arc{stroke:#0059d9}.circle{stroke:#00994d}"
      << ".ellipse{stroke:#991ab3}.spline{stroke:#e67300}"
      << ".elliptic_arc{stroke:#d91a73}\n"
      << "text{font:3.5px sans-serif;text-anchor:middle;fill:#262626}\n</style>\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (const View& view : views) write_view(out, sketch, view, scale, real);
  out << "<text x=\"" << number(kWidth / 2) << "\" y=\"" << number(kHeight - 8) << "\">"
      << escaped(options.name) << ", " << rounded(front.x()) << " x " << rounded(top.y()) << " x "
      << rounded(front.y()) << " " << unit_name << ", scale " << ratio(scale)
      << ", third-angle projection</text>\n</svg>\n";
}

}  // namespace sketchsplat
