// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "pipelines/method/reconstruct.h"
#include "pipelines/pages/page_photos.h"
#include "pipelines/results/known_scale.h"
#include "pipelines/results/solid_output.h"

namespace sketchsplat {

/// Everything that a report is made from.
struct ReportInput {
  const Reconstruction* reconstruction;
  const Scene* scene;
  std::string options_json;             ///< object of option -> value (fields_json)
  bool reproducible = false;            ///< without seconds, memory and threads
  const KnownScale* scale = nullptr;    ///< null: unknown
  const SolidOutcome* solid = nullptr;  ///< null: not reported
};

/// report.json: seconds per stage, peak memory, counts, the scale if it is known, rounds,
/// warnings, options, version, commit, threads.
std::string report_json(const ReportInput& input);

struct ReportImage {
  std::string name;  ///< of the view
  std::string png;   ///< the bytes of the file
};

/// What report.html shows beside the report.
struct ReportPage {
  const Sketch* sketch;
  std::vector<PagePhoto> photos = {};   ///< under the curves
  const SolidOutcome* solid = nullptr;  ///< whose faces are shown; null: none
};

/// report.html: one page that needs nothing but itself. `report` is the text of report.json.
std::string report_html(const std::string& report, const ReportPage& page);

/// Box around the curves, from samples of them; zero-sized at the origin if there are none.
struct Extent {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double size = 0;  ///< longest side, world units
  Eigen::Vector3d sides = Eigen::Vector3d::Zero();
};
Extent sketch_extent(const Sketch& sketch);

}  // namespace sketchsplat
