// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

struct DxfEntity {
  std::string type, layer;
  std::multimap<int, std::string> values;
  double real(int code) const { return std::stod(values.find(code)->second); }
  Vector3d point(int code) const { return {real(code), real(code + 10), real(code + 20)}; }
};

// Pairs of group code and value; entities of the section of that name, and the header's variables.
struct Dxf {
  std::vector<DxfEntity> entities;
  std::map<std::string, std::string> header;
  std::string last;
};
Dxf parse_dxf(const std::string& text) {
  Dxf out;
  std::istringstream in(text);
  std::string code, value, section, variable;
  while (std::getline(in, code) && std::getline(in, value)) {
    const int c = std::stoi(code);
    if (c == 0) out.last = value;
    if (c == 2 && out.last == "SECTION") section = value;
    if (section == "HEADER" && c == 9) variable = value;
    if (section == "HEADER" && c != 9 && c != 0) out.header.emplace(variable, value);
    if (section != "ENTITIES") continue;
    if (c == 0 && value != "ENDSEC" && value != "SECTION") out.entities.push_back({value, "", {}});
    if (c == 0 && value == "ENDSEC") section.clear();
    if (out.entities.empty()) continue;
    if (c == 8) out.entities.back().layer = value;
    out.entities.back().values.emplace(c, value);
  }
  return out;
}

std::string dxf_of(const Sketch& s, const DxfOptions& options = {}) {
  std::ostringstream out;
  write_dxf(out, s, options);
  return out.str();
}

// The arbitrary axis algorithm once more, from its description.
void expect_arc_on_stroke(const DxfEntity& e, const Sketch& s, int i, double scale) {
  const Vector3d n = e.point(210);
  const Vector3d x = (std::abs(n.x()) < 1.0 / 64 && std::abs(n.y()) < 1.0 / 64 ? Vector3d(0, 1, 0)
                                                                               : Vector3d(0, 0, 1))
                         .cross(n)
                         .normalized();
  const Vector3d y = n.cross(x), c = e.point(10);
  double from = 0, to = 360;
  if (e.type == "ARC") from = e.real(50), to = e.real(51);
  if (to <= from) to += 360;
  EXPECT_NEAR((to - from) * M_PI / 180 * e.real(40), scale * stroke_length(s, i), 1e-6 * scale);
  for (int k = 0; k <= 8; ++k) {
    const double a = (from + (to - from) * k / 8) * M_PI / 180;
    const Vector3d p =
        x * (c.x() + e.real(40) * std::cos(a)) + y * (c.y() + e.real(40) * std::sin(a)) + n * c.z();
    EXPECT_LT(distance_to_stroke(s, i, p / scale).distance, 1e-9);
  }
}

TEST(Dxf, HoldsEveryKindOnItsLayerAndInItsPlace) {
  Random random;
  for (int round = 0; round < 5; ++round) {
    const Sketch s = moved(all_kinds(), 1, random.rotation(), random.point());
    const Dxf dxf = parse_dxf(dxf_of(s, {50, LengthUnit::kInch}));
    ASSERT_EQ(int(dxf.entities.size()), s.size());
    const char* types[] = {"LINE", "ARC", "SPLINE", "LINE", "CIRCLE", "ELLIPSE", "ELLIPSE"};
    for (int i = 0; i < s.size(); ++i) {
      const DxfEntity& e = dxf.entities[i];
      EXPECT_EQ(e.type, types[i]);
      EXPECT_EQ(e.layer, i == 6 ? "ELLIPTIC_ARC" : types[i]);
      if (e.type == "ARC" || e.type == "CIRCLE") {
        expect_arc_on_stroke(e, s, i, 50);
      } else if (e.type == "ELLIPSE") {
        const Vector3d major = e.point(11), minor = e.real(40) * e.point(210).cross(major);
        const double from = e.real(41), to = e.real(42) + (e.real(42) <= from ? 2 * M_PI : 0);
        for (const double f : {0.0, 0.2, 0.5, 0.7, 1.0}) {
          const double a = from + f * (to - from);
          const Vector3d p = e.point(10) + major * std::cos(a) + minor * std::sin(a);
          const ClosestPoint on = distance_to_stroke(s, i, p / 50);
          EXPECT_LT(on.distance, 1e-9);
          // Both ends are there, and the arc is the one between them.
          EXPECT_NEAR(i == 6 ? on.t : f, f, 1e-6);
        }
        EXPECT_LE(e.real(40), 1);
      } else {
        EXPECT_LT((e.point(10) / 50 - control_points(s, i).p[0]).norm(), 1e-12);
      }
    }
    EXPECT_EQ(dxf.header.at("$INSUNITS"), "1");
    EXPECT_EQ(dxf.header.at("$ACADVER"), "AC1015");
    EXPECT_EQ(dxf.last, "EOF");
  }
  EXPECT_EQ(parse_dxf(dxf_of(Sketch())).last, "EOF");
}

}  // namespace
}  // namespace sketchsplat
