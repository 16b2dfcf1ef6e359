// SPDX-License-Identifier: MIT
#include "sketches/solve/information.h"

#include <algorithm>
#include <vector>

#include "sketches/curve/curve_jacobian.h"

namespace sketchsplat {
namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

// Places of a stroke's control points among all, nodes first.
std::vector<int> places_of(const Sketch& sketch, int stroke) {
  const Stroke& s = sketch.strokes[stroke];
  std::vector<int> places;
  if (!is_closed(s.kind)) places.push_back(s.begin);
  for (int h = 0; h < num_handles(s.kind); ++h)
    places.push_back(int(sketch.nodes.cols()) + s.handle + h);
  if (!is_closed(s.kind)) places.push_back(s.end);
  return places;
}

}  // namespace

SketchQuadratic sketch_quadratic(const Sketch& sketch, const SampleLayout& layout,
                                 const SampleQuadratics& quadratics,
                                 const RefineSketchOptions& options) {
  const int points = int(sketch.nodes.cols() + sketch.handles.cols());
  SketchQuadratic out;
  out.slope = Eigen::VectorXd::Zero(3 * points);
  std::vector<Eigen::Triplet<double>> entries;
  double trace = 0;
  int informed = 0;
  for (int s = 0; s < sketch.size(); ++s) {
    const ControlPoints c = control_points(sketch, s);
    const std::vector<int> places = places_of(sketch, s);
    Matrix12 sum = Matrix12::Zero();
    Vector12 slope = Vector12::Zero();
    for (int i = layout.first[s]; i < layout.first[s + 1]; ++i) {
      const double strength = quadratics.information[i].trace();
      if (!(strength > 0)) continue;
      trace += strength, ++informed;
      const auto j = curve_jacobian(sketch.strokes[s].kind, c, layout.t[i]);
      sum += j.transpose() * quadratics.information[i] * j;
      slope += j.transpose() * quadratics.slope.col(i);
    }
    for (int a = 0; a < c.count; ++a) {
      out.slope.segment<3>(3 * places[a]) += slope.segment<3>(3 * a);
      for (int b = 0; b < c.count; ++b)
        for (int k = 0; k < 9; ++k)
          entries.emplace_back(3 * places[a] + k / 3, 3 * places[b] + k % 3,
                               sum(3 * a + k / 3, 3 * b + k % 3));
    }
  }
  const double hold = informed > 0 ? options.stiffness * trace / informed : 1;
  for (int i = 0; i < 3 * points; ++i) entries.emplace_back(i, i, hold);
  out.information.resize(3 * points, 3 * points);
  out.information.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace sketchsplat
