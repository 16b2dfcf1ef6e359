// SPDX-License-Identifier: MIT
#include "pipelines/candidates/append_candidate.h"

namespace sketchsplat {

void append_candidate(const Candidate& c, Sketch* sketch) {
  const int inner = num_handles(c.kind), first = is_closed(c.kind) ? 0 : 1;
  int begin = -1, end = -1;
  if (!is_closed(c.kind)) {
    begin = sketch->add_node(c.curve.p[0]);
    end = sketch->add_node(c.curve.p[c.curve.count - 1]);
  }
  sketch->add_stroke(c.kind, begin, end,
                     {c.curve.p.begin() + first, c.curve.p.begin() + first + inner});
}

}  // namespace sketchsplat
