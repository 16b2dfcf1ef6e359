// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "datasets/types/view.h"
#include "edges/image/detect.h"
#include "edges/views/hull.h"
#include "edges/views/object_region.h"

namespace sketchsplat {

/// Views, their edgels, and what every geometric step needs of them. Views and maps have one order;
/// maps have look-ups.
struct EdgeWorld {
  std::vector<View> views;
  std::vector<EdgelMap> maps;
  /// Per view, 3 x (edgels): unit normal, in the world, of the plane through camera centre and
  /// edgel.
  std::vector<Eigen::Matrix3Xf> plane_normal;
  Eigen::AlignedBox3d bounds;  ///< holds the object, world units
  ObjectRegion object;         ///< what is known of it; nothing, as a rule, where masks tell
  double footprint = 0;        ///< world length of one pixel at the object (median over the views)
  /// Per view, what is known without masks of where the object is (silhouettes.h), as a mask that
  /// is no smaller than it; empty where nothing is. Null without any.
  std::shared_ptr<const std::vector<Image<uint8_t>>> silhouettes;
  VisualHull hull;  ///< of the masks, or else the silhouettes; empty without

  /// Do masks tell what is the object in any view?
  bool has_masks() const;
};

/// Bounds from the edgels' boxes in all views: with masks, the part of space that (nearly) every
/// view sees inside its own box of edgels; without, the part of what the cameras look at that a
/// quarter of them sees. Views without edgels do not vote. `bounds` is empty if nothing remains.
/// Maps without a look-up get one.
EdgeWorld make_edge_world(std::vector<View> views, std::vector<EdgelMap> maps);

/// EdgeWorld::hull as the world is.
VisualHull hull_of(const EdgeWorld& world);

/// EdgeWorld::plane_normal of a view.
Eigen::Matrix3Xf plane_normals(const View& view, const EdgelMap& map);

/// The point nearest to all optical axes.
Eigen::Vector3d meeting_point(const std::vector<View>& views);

/// Points on edges in space.
struct EdgePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d tangent = Eigen::Vector3d::Zero();  ///< unit, sign arbitrary
  int views = 0;     ///< that hold an edgel here with this direction
  float rms_px = 0;  ///< of these edgels, across the edge
  int view = 0;      ///< the edgel it was lifted from
  int edgel = 0;
};

struct LiftOptions {
  double stride_px = 3.0;  ///< [px] along a chain between edgels that are lifted
  int sweep_views = 24;    ///< views that score the depths of an edgel
  int min_views = 4;       ///< views that must agree
  /// Edges of neighbours are tried, too: more points where few views see an edge, and of edges that
  /// run close to one another more that lie on the one more views see.
  bool follow = true;
};

/// Space sweep: an edgel (every stride_px of a chain) is tried at all depths inside the bounds; the
/// depth and tangent on which most other views agree is kept and refined. Where a neighbour on the
/// chain lies on an edge that many views see, the place where that goes on is tried, too, and two
/// of three edgels are tried nowhere else if it does.
/// Edgels that a good point already explains are not lifted again, points outside of the object
/// are left out. Same result for any number of threads.
std::vector<EdgePoint> lift_edges(const EdgeWorld& world, const LiftOptions& options);

}  // namespace sketchsplat
