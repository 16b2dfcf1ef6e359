// SPDX-License-Identifier: MIT
#include "pipelines/method/scene_tags.h"

#include <algorithm>

#include "datasets/io/image_io.h"
#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"

namespace sketchsplat {

std::vector<TagSquare> measure_tags(const Scene& scene, const RunLog& log) {
  const int n = int(scene.views.size());
  Stage stage("tags", log, n);
  std::vector<std::vector<TagPatch>> found(n);
  parallel_for(n, 1, [&](int v) {
    try {
      const Picture picture = read_picture(scene.views[v].image_path);
      const Camera& camera = scene.views[v].camera;
      if (picture.width() == camera.width && picture.height() == camera.height)
        found[v] = tag_patches(picture, v);
    } catch (const InputError&) {
      // Whoever looks for edges in it will say so.
    }
    stage.step();
  });
  std::vector<TagPatch> patches;
  int with_tags = 0;
  for (std::vector<TagPatch>& here : found) {
    with_tags += !here.empty();
    for (TagPatch& p : here) patches.push_back(std::move(p));
  }
  const std::vector<TagSquare> tags = fit_tags(scene.views, patches);
  if (tags.empty())
    throw TooLittleError(
        scene.folder +
        ": expected an AprilTag 36h11 that lies still in at least three pictures, "
        "24 pixels wide or more, found " +
        (with_tags == 0 ? std::string("none")
                        : "tags in " + std::to_string(with_tags) + " that do not make one square"));
  std::string result;
  for (const TagSquare& t : tags) {
    const auto seen = std::count_if(patches.begin(), patches.end(),
                                    [&](const TagPatch& p) { return p.tag.id == t.id; });
    result += (result.empty() ? "tag " : ", tag ") + std::to_string(t.id) + " measured in " +
              std::to_string(t.views) + " of " + std::to_string(seen) + " views";
  }
  stage.result(result);
  return tags;
}

}  // namespace sketchsplat
