// SPDX-License-Identifier: MIT
#include "pipelines/method/leave_out.h"

#include <algorithm>
#include <string>

#include "pipelines/survey/explained.h"
#include "pipelines/survey/other_things.h"

namespace sketchsplat {
namespace {

constexpr double kPrintSpacing = 4;  // [px] of the points of strokes that a detector judges

// Without the strokes that are marked; `what` names them, and `count` is their sum in the report.
Sketch without(const Sketch& sketch, const std::vector<char>& drop, const std::string& what,
               const std::string& count, const RunLog& log) {
  std::vector<bool> keep(sketch.size(), true);
  for (int i = 0; i < sketch.size(); ++i) {
    keep[i] = !drop[i];
    if (!keep[i])
      log.note(std::string(kind_name(sketch.strokes[i].kind)) + " " + std::to_string(i) + " is " +
               what);
  }
  const Sketch out = keep_strokes(sketch, keep);
  const double dropped = sketch.size() - out.size();
  Numbers& counts = log.report->counts;
  const auto at = std::find_if(counts.begin(), counts.end(),
                               [&](const auto& known) { return known.first == count; });
  if (at != counts.end())
    at->second += dropped;
  else if (dropped > 0)
    log.count(count, dropped);
  return out;
}

}  // namespace

Sketch drop_print(const Sketch& sketch, const EdgeWorld& world, const Detector& detector,
                  const RunLog& log) {
  const CurvePoints points = points_on(sketch, kPrintSpacing * world.footprint);
  const std::vector<EdgeKind> kinds = detector.judge(points);
  std::vector<char> drop(sketch.size());
  for (int i = 0; i < sketch.size(); ++i) {
    const auto begin = kinds.begin() + points.first[i], end = kinds.begin() + points.first[i + 1];
    drop[i] = std::count(begin, end, EdgeKind::kPrint) > std::count(begin, end, EdgeKind::kShape);
  }
  return without(sketch, drop, "print", "strokes_of_print", log);
}

Sketch drop_things(const Sketch& sketch, const EdgeWorld& world, const RunLog& log) {
  return without(sketch, of_other_things(sketch, world), "of another thing", "strokes_of_things",
                 log);
}

}  // namespace sketchsplat
