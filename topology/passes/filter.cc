// SPDX-License-Identifier: MIT
#include "topology/core/draft.h"
#include "topology/core/passes.h"

namespace sketchsplat {

PassResult remove_low_opacity(const Sketch& sketch, double min_opacity,
                              const StrokePoints& points) {
  Draft draft(sketch, points);
  for (int i = 0; i < draft.size(); ++i)
    if (draft.pieces[i].alive && !(draft.pieces[i].evidence.opacity >= min_opacity))
      draft.remove(i);
  return draft.finish();
}

PassResult visibility_filter(const Sketch& sketch, int min_support_views, double max_rms_px,
                             const StrokePoints& points) {
  Draft draft(sketch, points);
  for (int i = 0; i < draft.size(); ++i) {
    const Evidence& e = draft.pieces[i].evidence;
    const bool seen = e.support_views >= min_support_views && e.rms_px <= max_rms_px;
    if (draft.pieces[i].alive && !seen) draft.remove(i);
  }
  return draft.finish();
}

}  // namespace sketchsplat
