// SPDX-License-Identifier: MIT
#include "pipelines/base/version.h"

#include <opencv2/core/version.hpp>

namespace sketchsplat {
namespace {

std::string& commit() {
  static std::string text = "unknown";
  return text;
}

}  // namespace

std::string program_version() { return SKETCHSPLAT_VERSION; }

std::string program_commit() { return commit(); }

void set_program_commit(const std::string& text) {
  if (!text.empty()) commit() = text;
}

std::string library_versions() {
  return SKETCHSPLAT_LIBRARIES ", OpenCV " CV_VERSION ", g++ " __VERSION__;
}

}  // namespace sketchsplat
