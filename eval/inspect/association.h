// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "eval/inspect/nominal.h"

namespace sketchsplat {

/// A place of a nominal edge and what was measured beside it.
struct EdgePlace {
  Eigen::Vector3d nominal, tangent;  ///< on the nominal curve; unit
  double length = 0;                 ///< of the edge that it stands for
  int seen_by = -1;                  ///< views that can see it; -1 if nobody knows
  int stroke = -1;                   ///< that was measured here; -1 if nothing was
  double t = 0;                      ///< curve parameter of the measured stroke
  Eigen::Vector3d measured;          ///< its point nearest to the nominal one
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();  ///< to it, across the nominal curve
};

enum class Presence { kFound, kPartly, kMissing, kNotVisible };
const char* presence_name(Presence presence);  ///< "found", "partly", "missing", "not visible"

struct EdgeMatch {
  std::vector<EdgePlace> places;  ///< along the edge, uniform in arc length
  std::vector<int> strokes;       ///< measured ones that lie on it, ascending
  double found = 0;               ///< share of its length beside which something was measured
  double visible = 1;             ///< share of its length that enough views can see; 1 if unknown
  Presence presence = Presence::kMissing;
};

/// Places beside one stroke, at most so many, the first and the last among them.
std::vector<EdgePlace> places_beside(const EdgeMatch& match, int stroke, int most);

struct ExtraStroke {
  int stroke = 0;
  double length = 0;
  double beside = 0;  ///< share of its length that lies on nominal edges
};

struct Association {
  std::vector<EdgeMatch> edges;     ///< one per nominal edge
  std::vector<ExtraStroke> extras;  ///< measured strokes that are no nominal edge, mostly
};

struct AssociateOptions {
  double reach = 0.015;   ///< [nominal extents] farther away nothing is the same edge
  double spacing = 0.01;  ///< [nominal extents] of places, at most
  int least_views = 4;    ///< that see a place which must be found
};

/// Which measured strokes lie on which nominal edges. `measured` is where alignment put it.
/// `seen_by`: of every place of every edge (in the order of nominal_places) how many views can see
/// it, or empty. A measured place belongs to the nominal edge nearest to it that runs its way.
/// Found: 90 % of what can be seen; partly: a tenth, at least; not visible: less than a tenth of
/// the edge can be seen and was found.
Association associate(const Sketch& measured, const Nominal& nominal,
                      const AssociateOptions& options,
                      const std::vector<std::vector<int>>& seen_by = {});

/// The places that associate() looks at; nothing measured.
std::vector<std::vector<EdgePlace>> nominal_places(const Nominal& nominal, double spacing);

}  // namespace sketchsplat
