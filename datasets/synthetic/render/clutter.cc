// SPDX-License-Identifier: MIT
#include "datasets/synthetic/render/clutter.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "datasets/synthetic/cad/flat_faces.h"
#include "datasets/synthetic/render/noise.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3f;

constexpr int kShapes = 160;  // a camera with the field of view of ABC-NEF sees about ten

// The frustum over a quadrilateral: a box if `taper` is 1, a pyramid if it is 0.
void add_shape(const Eigen::Affine3f& placed, float taper, SurfaceMesh* mesh) {
  std::array<Vector3f, 4> low, high;
  for (int i = 0; i < 4; ++i) {
    const float x = (i == 0 || i == 3) ? -1.0f : 1.0f, y = i < 2 ? -1.0f : 1.0f;
    low[i] = placed * Vector3f(x, y, -1);
    high[i] = placed * Vector3f(taper * x, taper * y, 1);
  }
  add_flat_face({low.begin(), low.end()}, mesh);
  if (taper > 0) add_flat_face({high.begin(), high.end()}, mesh);
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    if (taper > 0) {
      add_flat_face({low[i], low[j], high[j], high[i]}, mesh);
    } else {
      add_flat_face({low[i], low[j], high[i]}, mesh);
    }
  }
}

}  // namespace

Clutter make_clutter(double reach, std::uint64_t seed) {
  SurfaceMesh mesh;
  add_shape(Eigen::Affine3f(Eigen::Scaling(float(2.4 * reach))), 1.0f, &mesh);
  for (int i = 0; i < kShapes; ++i) {
    const auto draw = [&](int use) { return float(uniform(hash(seed, i, use, 60))); };
    const float z = 2 * draw(0) - 1, a = float(2 * M_PI) * draw(1), r = std::sqrt(1 - z * z);
    // Not larger than 0.3 from its middle to a corner: clear of the cameras, and of the walls.
    const float away = float(reach) * (1.45f + 0.55f * draw(2));
    const Vector3f half =
        float(reach) * (Vector3f(draw(3), draw(4), draw(5)) * 0.14f + Vector3f::Constant(0.03f));
    const Eigen::Quaternionf turn =
        Eigen::Quaternionf(draw(6) - 0.5f, draw(7) - 0.5f, draw(8) - 0.5f, draw(9) - 0.5f)
            .normalized();
    const Vector3f place = away * Vector3f(r * std::cos(a), r * std::sin(a), z);
    add_shape(Eigen::Translation3f(place) * turn * Eigen::Scaling(half),
              draw(10) < 0.4f ? 0.0f : 1.0f, &mesh);
  }
  return {Tracer(mesh), float(2 * reach)};
}

}  // namespace sketchsplat
