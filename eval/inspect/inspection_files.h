// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/inspect/inspection.h"

namespace sketchsplat {

/// What files say beside the results.
struct InspectionTitle {
  std::string result, nominal;  ///< paths
  std::string unit;             ///< "mm"
  double scale = 1;             ///< units per world unit of the result; 0 if it was fitted
  std::string version;
};

/// Shares of draws whose largest deviations are written: `largest_quantiles` of an edge.
const std::vector<double>& quantile_shares();

/// inspection.json: everything; a number that nobody knows is null.
std::string inspection_json(const Inspection& inspection, const Nominal& nominal,
                            const InspectOptions& options, const InspectionTitle& title);

/// inspection.csv: a row per edge, dimension and curve that the nominal part has not.
std::string inspection_csv(const Inspection& inspection, const Nominal& nominal);

/// inspection_pieces.json: of every edge and stroke on it, how far it is off at some places, along
/// two directions across the edge, and what is known of errors there: the covariance of the stroke,
/// not calibrated, directions of a shift and of the curvature. eval/calibrate_inspection.py fits
/// SigmaOptions to it. `footprint`: length of a pixel in the nominal's unit.
std::string pieces_json(const Inspection& inspection, const Nominal& nominal, double footprint);

/// The worst of it and how much is in, for the terminal.
std::string inspection_table(const Inspection& inspection, const Nominal& nominal,
                             const InspectionTitle& title);

}  // namespace sketchsplat
