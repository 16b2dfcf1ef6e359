// SPDX-License-Identifier: MIT
#include "sketches/io/step_file.h"

#include <Eigen/Geometry>
#include <cstdio>
#include <ostream>

#include "sketches/io/io_number.h"
#include "sketches/io/utf8.h"

namespace sketchsplat::step {

using Eigen::Vector3d;

std::string real(double x) {
  std::string text = shortest(x == 0 ? 0.0 : x);  // no negative zero
  const size_t e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') == std::string::npos) mantissa += '.';
  return e == std::string::npos ? mantissa : mantissa + "E" + text.substr(e + 1);
}

namespace {

std::string triple(const Vector3d& p) {
  return "(" + real(p.x()) + "," + real(p.y()) + "," + real(p.z()) + ")";
}

}  // namespace

// A string of ISO 10303-21: quotes and backslashes doubled, all but printable ASCII in hexadecimal.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (size_t i = 0; i < text.size();) {
    const std::uint32_t code = next_code_point(text, &i);
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

int StepFile::add(const std::string& entity) {
  out_ << "#" << ++last_ << "=" << entity << ";\n";
  return last_;
}

int StepFile::point(const Vector3d& p) {
  return add("CARTESIAN_POINT(''," + triple(scale_ * p) + ")");
}

int StepFile::direction(const Vector3d& d) { return add("DIRECTION(''," + triple(d) + ")"); }

int StepFile::vertex(const Vector3d& p) {
  return add("VERTEX_POINT(''," + reference(point(p)) + ")");
}

int StepFile::placement(const Vector3d& origin, const Vector3d& axis, const Vector3d& x) {
  const int o = point(origin), a = direction(axis), r = direction(x);
  return add("AXIS2_PLACEMENT_3D(''," + reference(o) + "," + reference(a) + "," + reference(r) +
             ")");
}

int StepFile::line(const Vector3d& begin, const Vector3d& end) {
  const int p = point(begin), d = direction((end - begin).normalized());
  const int v = add("VECTOR(''," + reference(d) + "," + real(scale_ * (end - begin).norm()) + ")");
  return add("LINE(''," + reference(p) + "," + reference(v) + ")");
}

int StepFile::circle(const Vector3d& centre, const Vector3d& normal, const Vector3d& x,
                     double radius) {
  const int axes = placement(centre, normal, x);
  return add("CIRCLE(''," + reference(axes) + "," + real(scale_ * radius) + ")");
}

int StepFile::ellipse(const Vector3d& centre, const EllipseAxes& axes) {
  const int frame =
      placement(centre, axes.major.cross(axes.minor).normalized(), axes.major.normalized());
  return add("ELLIPSE(''," + reference(frame) + "," + real(scale_ * axes.major.norm()) + "," +
             real(scale_ * axes.minor.norm()) + ")");
}

int StepFile::spline(const Spline& spline) {
  std::vector<int> points;
  for (int k = 0; k < spline.points.cols(); ++k) points.push_back(point(spline.points.col(k)));
  std::string multiplicities, knots;
  const int n = int(spline.breaks.size());
  for (int k = 0; k < n; ++k) {
    multiplicities += std::string(k ? "," : "") + (k == 0 || k == n - 1 ? "4" : "2");
    knots += (k ? "," : "") + real(spline.breaks[k]);
  }
  return add("B_SPLINE_CURVE_WITH_KNOTS('',3," + list(points) + ",.UNSPECIFIED.,.F.,.F.,(" +
             multiplicities + "),(" + knots +
             (n == 2 ? "),.PIECEWISE_BEZIER_KNOTS.)" : "),.UNSPECIFIED.)"));
}

Vector3d plain_direction(const Vector3d& normal) {
  int k;
  normal.cwiseAbs().minCoeff(&k);
  const Vector3d axis = Vector3d::Unit(k);
  return (axis - normal * normal[k]).normalized();
}

}  // namespace sketchsplat::step
