// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/inspect/inspection_files.h"
#include "eval/inspect/lot.h"
#include "pipelines/results/report.h"

namespace sketchsplat {

/// Into `folder`: inspection.json and .csv (eval/inspect/inspection_files.h), inspection.html, a
/// page that needs nothing but itself, and inspection.step, the nominal edges coloured by verdict.
/// Throws OutputError.
void write_inspection(const std::string& folder, const Inspection& inspection,
                      const Nominal& nominal, const InspectOptions& options,
                      const InspectionTitle& title, const std::vector<ReportImage>& overlays);

/// Of several parts: lot.json, lot.csv and lot.html. Throws OutputError.
void write_lot(const std::string& folder, const std::vector<LotPart>& parts,
               const Inspection& first, const Nominal& nominal, const InspectionTitle& title);

}  // namespace sketchsplat
