// SPDX-License-Identifier: MIT
#include "datasets/smaller_pictures.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sketchsplat {

Scene with_smaller_pictures(const Scene& scene, int least_side) {
  Scene out = scene;
  for (View& view : out.views) {
    const int longer = std::max(view.camera.width, view.camera.height);
    const int factor = least_side > 0 ? longer / least_side : 1;
    if (factor < 2) continue;
    const View full = view;
    view.make_picture = [full, factor] { return read_picture(full, factor); };
    view.mask_path.clear();  // the picture has it
    view.camera = full.camera.shrunk(factor);
  }
  return out;
}

std::vector<View> at_full_size(const std::vector<View>& smaller, const Scene& scene) {
  std::map<std::string, const View*> of_path;
  for (const View& view : scene.views) of_path[view.image_path] = &view;
  std::vector<View> out;
  for (const View& from : smaller) {
    View view = *of_path.at(from.image_path);
    // Blocks at the border may be cut off, those in the middle are whole.
    const double factor = std::round(double(view.camera.width) / from.camera.width);
    view.camera.fx = factor * from.camera.fx, view.camera.fy = factor * from.camera.fy;
    view.camera.cx = factor * (from.camera.cx + 0.5) - 0.5;
    view.camera.cy = factor * (from.camera.cy + 0.5) - 0.5;
    view.cam_from_world = from.cam_from_world;
    view.lens = from.lens;
    out.push_back(std::move(view));
  }
  return out;
}

}  // namespace sketchsplat
