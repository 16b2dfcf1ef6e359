// SPDX-License-Identifier: MIT
#include "topology/core/remap.h"

namespace sketchsplat {

Remap Remap::identity(int strokes) {
  Remap r;
  r.stroke.resize(strokes);
  for (int i = 0; i < strokes; ++i) r.stroke[i] = i;
  return r;
}

Remap Remap::compose(const Remap& first, const Remap& second) {
  Remap r;
  for (int i : first.stroke) r.stroke.push_back(i < 0 ? -1 : second.stroke[i]);
  return r;
}

bool Remap::is_identity() const {
  for (size_t i = 0; i < stroke.size(); ++i)
    if (stroke[i] != int(i)) return false;
  return true;
}

}  // namespace sketchsplat
