// SPDX-License-Identifier: MIT
// In: a scene. Out: the edgels of each view, and how to tell print from shape.
// This folder may not include anything of pipelines but base.
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "datasets/readers/scene.h"
#include "edges/depth/geometry_edges.h"
#include "edges/image/detect.h"
#include "edges/image/detect_map.h"
#include "edges/surfels/fit/surfel_field.h"
#include "edges/surfels/start/edge_tracks.h"
#include "pipelines/base/run_report.h"

namespace sketchsplat {

/// Where edges come from, and the options of everything that may find them.
struct DetectionOptions {
  int seed = 0;  ///< of everything that is drawn at random: starts, trials of RANSAC
  /// "image": the pictures; "geometry": depth and normal maps in the scene's folder; "2dgs-sn":
  /// depth and normals of surfels fitted to the pictures; "maps:NAME": edge maps of others.
  std::string detector = "image";
  std::string normals = "normal";  ///< folder of normal maps for "geometry", see geometry_maps.h
  DetectOptions detect;
  MapOptions maps;
  GeometryOptions geometry;
  SurfelFieldOptions surfels;
  std::string surfel;  ///< what the user changes of these: "kernel=skew-normal,count=2000"
};

/// Finds the edgels of views.
class Detector {
 public:
  virtual ~Detector() = default;
  /// Looks at the whole scene before the first view is asked for: where a detector that learns from
  /// all views does so. Called once. Throws InputError.
  virtual void prepare(const Scene&, const RunLog&) {}
  /// Edgels of one view, in its ideal pixels. From many threads. Throws InputError, also if an
  /// image or map has another size than the view.
  virtual EdgelMap detect(const Scene& scene, const View& view) const = 0;
  /// Does it look at the pictures one by one, and at nothing else? Then smaller ones will do.
  virtual bool takes_smaller_pictures() const { return false; }
  /// Does it make the geometry itself, rather than read it?
  virtual bool learns() const { return false; }
  /// The geometry in which the edges of a view were found; false if there is none. Throws
  /// InputError.
  virtual bool geometry(const Scene&, const View&, GeometryMaps*) const { return false; }
  /// What points on curves in space are by the geometry of all views: unknown wherever the detector
  /// has none of its own. Not before prepare().
  virtual std::vector<EdgeKind> judge(const CurvePoints& curves) const {
    return std::vector<EdgeKind>(curves.position.cols(), EdgeKind::kUnknown);
  }
  /// The surfels as a PLY file, see surfel_ply; empty if there are none.
  virtual std::string surfels() const { return ""; }
};

/// By the name in the options, which the detector copies.
std::unique_ptr<Detector> make_detector(const DetectionOptions& options);

/// The edgels of a view, or why there are none.
struct Detection {
  EdgelMap map;
  std::string complaint;  ///< of the InputError; empty if the view could be read
};

/// Prepares the detector and asks it for all views of the scene, in their order; stage "detect". A
/// view that cannot be read is left out with a warning. Throws InputError if no view can be read.
std::vector<Detection> detect_all(const Scene& scene, Detector* detector, const RunLog& log);

}  // namespace sketchsplat
