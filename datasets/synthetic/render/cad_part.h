// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "datasets/synthetic/cad/brep.h"
#include "datasets/synthetic/cad/truth.h"
#include "datasets/synthetic/render/tracer.h"
#include "datasets/types/view.h"

namespace sketchsplat {

/// A CAD file for those who compare with it: its sharp edges, and who can see them.
struct CadPart {
  std::string path;
  Brep brep;
  UnitFrame frame;
  Truth edges;                           ///< sharp ones [mm], in the file's frame
  std::shared_ptr<const Tracer> tracer;  ///< of its faces, unit frame; made when it is needed
};

/// Reads a STEP file. Throws InputError (see read_step; no sharp edge).
CadPart read_cad_part(const std::string& path, double smooth_angle_deg);

/// The same of what read_step made of the file.
CadPart cad_part_of(Brep brep, const std::string& path, double smooth_angle_deg);

/// By how many of the views (in the file's frame, [mm]) each of the `points` (3 x N [mm]) of an
/// edge of the part is seen: inside of the picture, nothing before it. `strokes`: of each point,
/// the stroke of edges.sketch that it lies on.
std::vector<int> count_views(CadPart* part, const std::vector<View>& views,
                             const Eigen::Matrix3Xd& points, const std::vector<int>& strokes);

}  // namespace sketchsplat
