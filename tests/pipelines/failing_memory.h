// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace sketchsplat::test {

/// Memory of this program that runs out on demand: malloc and its kin, and with them operator new,
/// Eigen, OpenCV and all else.
struct FailingMemory {
  /// Can memory fail here at all? Not under sanitizers, and not without glibc.
  static bool possible();
  /// How often it was asked for since begin().
  static long asked();
  /// Shall this request fail, counted from 1? It is free to use memory itself.
  using Fails = bool (*)(long number, size_t bytes);
  /// From now on asks this each time.
  static void begin(Fails fails);
  static void end();
};

}  // namespace sketchsplat::test
