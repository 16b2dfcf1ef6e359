// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/cost_function.h>

#include "sketches/solve/relations.h"

namespace sketchsplat {

/// Residuals of a relation over its sigma, by its blocks. The caller owns it.
ceres::CostFunction* make_relation_cost(const Sketch& sketch, const Relations& relations,
                                        const Relation& relation);

}  // namespace sketchsplat
