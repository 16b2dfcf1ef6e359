// SPDX-License-Identifier: MIT
#include "topology/brep/plugin.h"

namespace {

const sketchsplat::BrepPlugin kPlugin = {
    sketchsplat::write_solid_step,
    sketchsplat::mesh_solid,
    sketchsplat::compare_solids,
};

}  // namespace

extern "C" const void* sketchsplat_brep_plugin() { return &kPlugin; }
