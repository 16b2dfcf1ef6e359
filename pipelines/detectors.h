// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "datasets/scene.h"
#include "edges/detect.h"
#include "edges/detect_map.h"
#include "edges/geometry_edges.h"
#include "pipelines/run_report.h"

namespace sketchsplat {

/// Where edges come from, and the options of everything that may find them.
struct DetectionOptions {
  /// "image": the pictures; "geometry": depth and normal maps in the scene's folder; "maps:NAME":
  /// edge maps of others.
  std::string detector = "image";
  std::string normals = "normal";  ///< folder of normal maps for "geometry", see geometry_maps.h
  DetectOptions detect;
  MapOptions maps;
  GeometryOptions geometry;
};

/// Finds the edgels of views.
class Detector {
 public:
  virtual ~Detector() = default;
  /// Looks at the whole scene before the first view is asked for: where a detector that learns from
  /// all views does so. Called once. Throws InputError.
  virtual void prepare(const Scene&, RunReport*, Progress*) {}
  /// Edgels of one view. From many threads. Throws InputError, also if an image or map has another
  /// size than the view.
  virtual EdgelMap detect(const Scene& scene, const View& view) const = 0;
};

/// By the name in the options, which the detector copies.
std::unique_ptr<Detector> make_detector(const DetectionOptions& options);

/// The edgels of a view, or why there are none.
struct Detection {
  EdgelMap map;
  std::string complaint;  ///< of the InputError; empty if the view could be read
};

/// Prepares the detector and asks it for all views of the scene, in their order; stage "detect". A
/// view that cannot be read is left out with a warning. `report` and `progress` may be null. Throws
/// InputError if no view can be read.
std::vector<Detection> detect_all(const Scene& scene, const DetectionOptions& options,
                                  RunReport* report, Progress* progress);

}  // namespace sketchsplat
