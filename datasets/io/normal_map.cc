// SPDX-License-Identifier: MIT
#include "datasets/io/normal_map.h"

#include <cmath>

#include "datasets/io/image_io.h"
#include "datasets/types/errors.h"

namespace sketchsplat {

std::array<Image<float>, 3> read_normal_map(const std::string& path, const Camera& camera) {
  const Picture picture = read_picture(path);
  const int w = picture.width(), h = picture.height();
  if (w != camera.width || h != camera.height)
    throw InputError(path,
                     "a normal map of " + std::to_string(camera.width) + " x " +
                         std::to_string(camera.height) + " px",
                     std::to_string(w) + " x " + std::to_string(h));
  std::array<Image<float>, 3> normal;
  normal.fill(Image<float>(w, h));
  size_t towards = 0, away = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!picture.alpha.empty() && picture.alpha.at(x, y) < 0.5f) continue;
      // From x right, y up, z back to x right, y down, z forward.
      Eigen::Vector3d n(2 * picture.red.at(x, y) - 1, 1 - 2 * picture.green.at(x, y),
                        1 - 2 * picture.blue.at(x, y));
      const double length = n.norm();
      // Black is how programs paint nothing; as a vector it would be far longer than one.
      if (length < 0.5 || length > 1.5) continue;
      n /= length;
      ++(n.dot(camera.ray({double(x), double(y)})) < 0 ? towards : away);
      for (int c = 0; c < 3; ++c) normal[c].at(x, y) = float(n[c]);
    }
  if (away > towards)
    throw InputError(path, "normals towards the camera (x right, y up, z to the viewer)",
                     std::to_string(100 * away / (away + towards)) + " % that face away");
  return normal;
}

}  // namespace sketchsplat
