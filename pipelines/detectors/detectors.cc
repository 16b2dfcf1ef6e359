// SPDX-License-Identifier: MIT
#include "pipelines/detectors/detectors.h"

#include "datasets/types/errors.h"
#include "datasets/types/parallel.h"
#include "edges/image/undistort.h"
#include "pipelines/detectors/surfel_detector.h"

namespace sketchsplat {
namespace {

class ImageDetector : public Detector {
 public:
  explicit ImageDetector(const DetectOptions& options) : options_(options) {}
  EdgelMap detect(const Scene&, const View& view) const override {
    return undistort_edgels(detect_edges(read_picture(view), options_), view, options_.min_chain);
  }
  bool takes_smaller_pictures() const override { return true; }

 private:
  DetectOptions options_;
};

class MapDetector : public Detector {
 public:
  MapDetector(const std::string& name, const MapOptions& options)
      : name_(name), options_(options) {}
  EdgelMap detect(const Scene& scene, const View& view) const override {
    const std::string path = edge_map_path(scene, view, name_);
    if (path.empty())
      throw InputError(scene.folder, "an edge map '" + name_ + "' of " + view.name, "none");
    const Image<float> map = read_grey(path);
    if (map.width != view.camera.width || map.height != view.camera.height)
      throw InputError(path, "a map of the image's size",
                       std::to_string(map.width) + " x " + std::to_string(map.height) + " px");
    return undistort_edgels(detect_ridges(map, options_), view, options_.min_chain);
  }

 private:
  std::string name_;
  MapOptions options_;
};

class GeometryDetector : public Detector {
 public:
  GeometryDetector(const std::string& normals, const GeometryOptions& options)
      : normals_(normals), options_(options) {}
  EdgelMap detect(const Scene& scene, const View& view) const override {
    return geometry_edges(read_maps(scene, view), view.camera, options_);
  }
  bool geometry(const Scene& scene, const View& view, GeometryMaps* maps) const override {
    *maps = read_maps(scene, view);
    return true;
  }

 private:
  // Depth cannot be resampled: it has jumps.
  GeometryMaps read_maps(const Scene& scene, const View& view) const {
    if (!view.lens.is_identity())
      throw InputError(view.image_path,
                       "a picture without lens distortion for depth and normal maps (as colmap "
                       "image_undistorter makes them)",
                       "one with");
    return read_geometry_maps(scene, view, normals_);
  }

  std::string normals_;
  GeometryOptions options_;
};

}  // namespace

std::unique_ptr<Detector> make_detector(const DetectionOptions& options) {
  const std::string maps = "maps:";
  if (options.detector.rfind(maps, 0) == 0)
    return std::make_unique<MapDetector>(options.detector.substr(maps.size()), options.maps);
  if (options.detector == "geometry")
    return std::make_unique<GeometryDetector>(options.normals, options.geometry);
  if (options.detector == "2dgs-sn") return make_surfel_detector(options);
  return std::make_unique<ImageDetector>(options.detect);
}

std::vector<Detection> detect_all(const Scene& scene, Detector* detector, const RunLog& log) {
  const int n = int(scene.views.size());
  detector->prepare(scene, log);
  Stage stage("detect", log, n);
  std::vector<Detection> found(n);
  parallel_for(n, 1, [&](int i) {
    try {
      found[i].map = detector->detect(scene, scene.views[i]);
    } catch (const InputError& e) {
      found[i].complaint = e.what();
    }
    stage.step();
  });
  size_t edgels = 0;
  int read = 0;
  for (int i = 0; i < n; ++i) {
    edgels += found[i].map.edgels.size();
    read += found[i].complaint.empty();
    if (!found[i].complaint.empty())
      log.warn("view " + scene.views[i].name + " is left out: " + found[i].complaint);
  }
  if (read == 0) throw InputError(scene.folder, "a view that can be read", found[0].complaint);
  stage.result(std::to_string(edgels) + " edgels in " + std::to_string(read) + " views");
  return found;
}

}  // namespace sketchsplat
