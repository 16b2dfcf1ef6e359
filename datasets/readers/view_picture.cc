// SPDX-License-Identifier: MIT
// Pictures of views with their masks, wherever these come from.
#include <algorithm>
#include <filesystem>

#include "datasets/io/shrink_planes.h"
#include "datasets/readers/frame.h"
#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

void check_size(const std::string& path, const std::string& what, int width, int height,
                const Camera& camera) {
  if (width == camera.width && height == camera.height) return;
  const auto text = [](int w, int h) { return std::to_string(w) + " x " + std::to_string(h); };
  throw InputError(path, what + " of " + text(camera.width, camera.height) + " px",
                   text(width, height));
}

Image<float> read_mask(const View& view, int denominator) {
  Image<float> mask = read_grey(view.mask_path, denominator);
  check_size(view.mask_path, "a mask", mask.width, mask.height, view.camera.shrunk(denominator));
  // Labels 0 and 1 in 8 bits look black to everybody.
  if (*std::max_element(mask.data.begin(), mask.data.end()) < 0.5f)
    throw InputError(view.mask_path, "a mask that is white where the object is", "nothing white");
  return mask;
}

Picture shrunk(Picture picture, int denominator) {
  if (denominator == 1) return picture;
  Image<float>* const images[] = {&picture.red, &picture.green, &picture.blue, &picture.alpha};
  Planes planes;
  planes.width = picture.width(), planes.height = picture.height();
  planes.channels = picture.alpha.empty() ? 3 : 4;
  for (int c = 0; c < planes.channels; ++c) planes.plane[c] = std::move(images[c]->data);
  shrink_planes(denominator, &planes);
  for (int c = 0; c < planes.channels; ++c) {
    images[c]->width = planes.width, images[c]->height = planes.height;
    images[c]->data = std::move(planes.plane[c]);
  }
  return picture;
}

/// Mask of an image by the longest end of its path that names one.
std::string mask_of(const std::string& folder, const std::string& image_path) {
  const fs::path image = fs::path(image_path).lexically_normal().relative_path();
  for (auto from = image.begin(); from != image.end(); ++from) {
    fs::path end;
    for (auto it = from; it != image.end(); ++it) end /= *it;
    const std::string found = find_mask(folder, end.string());
    if (!found.empty()) return found;
  }
  return "";
}

}  // namespace

void use_masks(const std::string& folder, Scene* scene) {
  std::error_code none;
  if (!fs::is_directory(folder, none))
    throw InputError(folder, "a folder of masks", fs::exists(folder, none) ? "a file" : "nothing");
  std::vector<std::string> without;
  for (View& view : scene->views) {
    const std::string found = mask_of(folder, view.image_path);
    if (found.empty()) {
      without.push_back(view.name);
    } else {
      view.mask_path = found;
      view.mask_over_alpha = true;
    }
  }
  if (without.size() == scene->views.size())
    throw InputError(folder, "masks named like the images (" + scene->views[0].name + ")", "none");
  warn_of("views without a mask in " + folder, without, scene);
}

Picture read_picture(const View& view, int denominator) {
  Picture picture = view.make_picture ? shrunk(view.make_picture(), denominator)
                                      : read_picture(view.image_path, denominator);
  check_size(view.image_path, "an image", picture.width(), picture.height(),
             view.camera.shrunk(denominator));
  const std::vector<float>& alpha = picture.alpha.data;  // says nothing if all is opaque
  const bool says = std::any_of(alpha.begin(), alpha.end(), [](float a) { return a < 1; });
  if (!view.mask_path.empty() && (view.mask_over_alpha || !says))
    picture.alpha = read_mask(view, denominator);
  if (view.when_read) view.when_read(picture);
  return picture;
}

}  // namespace sketchsplat
