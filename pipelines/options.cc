// SPDX-License-Identifier: MIT
#include "pipelines/options.h"

#include <utility>

namespace sketchsplat {
namespace {

struct Preset {
  const char* name;
  std::vector<std::pair<const char*, const char*>> values;  // option, text
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list = {
      {"fast", {}},
      {"balanced", {}},
      {"accurate", {}},
  };
  return list;
}

}  // namespace

void list_fields(CommonOptions* o, Fields* f) {
  f->group("Everywhere");
  f->add("threads", &o->threads, "threads", 0, 1024, "Threads to use; 0 is one per core");
  f->add("seed", &o->seed, "", 0, 2147483647, "Seed of everything that is drawn at random");
  f->add("quiet", &o->quiet, "Say nothing but errors").short_name = "q";
  f->add("verbose", &o->verbose, "Say more while working").short_name = "v";
}

void list_fields(ReconstructOptions* o, Fields* f) {
  f->group("Method");
  // First of its kind: options after it override what it sets.
  f->choose("preset", &o->preset, preset_names(),
            "Sets several options at once; others override it")
      .applied = [o] { apply_preset(o->preset, o); };
  f->choose("detector", &o->detector, {"image", "2dgs-sn", "maps:NAME"},
            "Where edges come from: the images, or maps in edge_NAME/ of the scene");
}

void list_fields(OutputOptions* o, Fields* f) {
  f->group("Output");
  f->add("overlays", &o->overlays, "views", 0, 100, "Views over which the curves are drawn");
  f->add("point-spacing", &o->point_spacing, "of the extent", 1e-5, 1,
         "Distance of the samples in edge_points.ply");
  f->add("step-scale", &o->step_scale, "mm per world unit", 1e-9, 1e9,
         "Size of a world unit in sketch.step");
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}

void apply_preset(const std::string& name, ReconstructOptions* options) {
  Fields fields;
  list_fields(options, &fields);
  for (const Preset& preset : presets()) {
    if (preset.name != name) continue;
    for (const auto& [option, text] : preset.values) {
      const Field* field = find_field(fields.list, option);
      if (!field) throw std::logic_error(std::string("preset of unknown option ") + option);
      assign(*field, text);
    }
    options->preset = name;
    return;
  }
  throw UsageError("--preset: expected one of fast, balanced, accurate, got '" + name + "'");
}

}  // namespace sketchsplat
