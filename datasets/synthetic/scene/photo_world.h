// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "datasets/synthetic/photo/photo_light.h"
#include "datasets/synthetic/scene/synthesize.h"

namespace sketchsplat {

/// The part and the room around it. Throws InputError as make_room() does.
PhotoWorld make_photo_world(const SynthesizeOptions& options, const SurfaceMesh& part);

/// Turns the cameras of a rig, whose up is z, as the part stands, and gives all of them one lens, a
/// principal point beside the middle and names in order (000.jpg ...). Throws InputError if one is
/// not above the table.
void make_photo_views(const SynthesizeOptions& options, const PhotoWorld& world,
                      std::vector<View>* views);

/// Free space (TruthCurve::outward) of points nearer to the table than `reach` lies above it.
void lift_off_table(const PhotoWorld& world, double reach, TruthCurve* curve);

}  // namespace sketchsplat
