// SPDX-License-Identifier: MIT
#pragma once

#include "edges/views/match.h"
#include "edges/views/unexplained.h"

namespace sketchsplat {

struct RimOptions {
  double reach_px = 1.5;   ///< [px] of an edgel from where the rim is expected
  double angle_deg = 15;   ///< [deg] largest angle of its plane to the tangent
  double share = 0.5;      ///< of the samples that a view must show to tell
  double step_deg = 40;    ///< [deg] largest turn of the line of sight to the next view
  int samples = 24;        ///< along the curve, at the most
  double sigma_px = 0.2;   ///< [px] standard deviation of the median place that a view shows
};

/// What the views say if the curve is the rim of a round surface rather than an edge.
struct Rim {
  double radius = 0;       ///< of the surface across the curve, world units; its sign is the side
  double sigma = 0;        ///< standard deviation of it; infinite if nothing tells
  int views = 0;           ///< that show an edgel where the rim must be
  int fixed_views = 0;     ///< that show one where an edge must be
  double nats = 0;  ///< logarithm of the likelihood ratio of a rim and an edge, for all views
  std::vector<char> side;  ///< per view, which of its two rims it shows (1 or -1); 0: none
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< see rim.cc

  /// Is it a rim, beyond doubt?
  bool is_round(double footprint) const;
};

/// A rim is where lines of sight touch the surface: seen from view v it stands off from the axis of
/// the osculating cylinder by radius * n_v, n_v the normal of the line of sight and the tangent; an
/// edge has radius 0 (Vaillant, Faugeras: Using extremal boundaries for 3-D object modeling, PAMI
/// 1992). The views are followed from those that see the curve to their neighbours, as far as they
/// show what is foretold. `curve`: one curve, at least two samples.
Rim fit_rim(const EdgeWorld& world, const CurvePoints& curve, const RimOptions& options);

/// Flags the edgels of the rim in all views that show it. `curve` as it was for fit_rim.
void explain_rim(const EdgeWorld& world, const CurvePoints& curve, const Rim& rim,
                 const ExplainOptions& options, EdgelFlags* explained);

}  // namespace sketchsplat
