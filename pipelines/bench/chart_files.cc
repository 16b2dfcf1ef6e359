// SPDX-License-Identifier: MIT
#include <dlfcn.h>

#include <stdexcept>

#include "pipelines/base/atomic_file.h"
#include "pipelines/base/plugin_path.h"
#include "pipelines/bench/chart.h"

namespace sketchsplat {
namespace {

DrawChart* load_plugin() {
  const std::string path = plugin_path(kChartPluginFile, SKETCHSPLAT_CHARTS_FOLDER);
  if (void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
    if (void* draw = ::dlsym(library, kChartPluginSymbol))
      return reinterpret_cast<DrawChart*>(draw);
  throw std::runtime_error(std::string(kChartPluginFile) + " cannot be loaded: " + ::dlerror());
}

}  // namespace

ChartFiles draw_chart(const Chart& chart) {
  static DrawChart* const draw = load_plugin();
  ChartFiles files;
  draw(chart, &files);
  return files;
}

void write_chart(const Chart& chart, const std::string& path) {
  const ChartFiles files = draw_chart(chart);
  write_atomically(path + ".svg", [&](std::ostream& out) { out << files.svg; });
  write_atomically(path + ".png", [&](std::ostream& out) { out << files.png; });
}

}  // namespace sketchsplat
