// SPDX-License-Identifier: MIT
#include "pipelines/options.h"

#include <cmath>
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

void list_lift(LiftOptions* o, Fields* f) {
  f->group("Lifting to space");
  f->add("lift-stride", &o->stride_px, "px", 0.5, 100, "Distance of edgels that are lifted");
  f->add("lift-views", &o->sweep_views, "views", 2, 10000, "Views that vote on a depth");
  f->add("lift-match", &o->match_px, "px", 0.1, 20, "Largest distance of an edgel that votes");
  f->add("lift-inlier", &o->inlier_px, "px", 0.1, 20, "The same for a point that was refined");
  f->add("lift-angle", &o->angle_deg, "deg", 0.1, 90, "Largest angle of its plane to the tangent");
  f->add("lift-min-views", &o->min_views, "views", 2, 10000, "Views that must agree");
}

void list_link(LinkOptions* o, Fields* f) {
  f->group("Linking to curves");
  f->add("link-merge", &o->merge_px, "px", 0, 100, "Points nearer along a curve become one");
  f->add("link-aside", &o->aside_px, "px", 0.1, 100, "Largest offset across a curve");
  f->add("link-reach", &o->reach_px, "px", 1, 1000, "Longest step from point to point");
  f->add("link-bend", &o->bend_deg, "deg", 0.1, 180, "Largest departure from a common circle");
}

void list_match(MatchOptions* o, Fields* f) {
  f->group("Matching curves to edges");
  f->add("match-reach", &o->reach_px, "px", 0.1, 100, "Largest distance across an edge");
  f->add("match-angle", &o->angle_deg, "deg", 0.1, 90, "Largest angle between edge and curve");
  f->add("match-min-run", &o->min_run, "", 0, 1, "Share of a curve below which a view is ignored");
}

}  // namespace

void list_fields(DetectOptions* o, Fields* f) {
  f->group("Edges in the images");
  f->add("detect-sigma", &o->sigma_px, "px", 0.3, 5, "Smoothing of the gradient");
  f->add("detect-high", &o->high_sigma, "times the noise", 1, 100, "Gradient that starts an edge");
  f->add("detect-low", &o->low_sigma, "times the noise", 0.5, 100, "Gradient that continues it");
  f->add("detect-high-floor", &o->high_floor, "grey levels per px", 0, 255,
         "Smallest gradient that starts an edge, even without noise");
  f->add("detect-low-floor", &o->low_floor, "grey levels per px", 0, 255,
         "Smallest gradient that continues it");
  f->add("detect-min-chain", &o->min_chain, "px", 1, 1000, "Shorter edges are dropped");
}

void list_fields(CommonOptions* o, Fields* f) {
  f->group("Everywhere");
  f->add("threads", &o->threads, "threads", 0, 1024, "Threads to use; 0 is one per core");
  f->add("seed", &o->seed, "", 0, HUGE_VAL, "Seed of everything that is drawn at random");
  f->add("quiet", &o->quiet, "Say nothing but errors").short_name = "q";
  f->add("verbose", &o->verbose, "Say more while working").short_name = "v";
}

void list_fields(ReconstructOptions* o, Fields* f) {
  f->group("Method");
  // First of its kind: options after it override what it sets.
  f->choose("preset", &o->preset, preset_names(),
            "Sets several options at once; others override it")
      .applied = [o] { apply_preset(o->preset, o); };
  f->choose("detector", &o->detector, {"image", "maps:NAME"},
            "Where edges come from: the images, or maps in edge_NAME/ of the scene");
  list_fields(&o->detect, f);
  list_lift(&o->lift, f);
  list_link(&o->link, f);
  list_match(&o->match, f);
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
