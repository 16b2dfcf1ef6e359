// SPDX-License-Identifier: MIT
#include "pipelines/options/steps.h"

namespace sketchsplat {
namespace {

// Something that can be left out.
struct Step {
  std::string name;
  std::function<void(bool on)> turn;
};

// A switch, a weight or a number of which 0 means none.
template <typename T>
Step step(const std::string& name, T* value) {
  return {name, [value, usual = *value](bool on) { *value = on ? usual : T(0); }};
}

std::vector<Step> method_steps(ReconstructOptions* o) {
  return {step("coarse-scales", &o->detect.coarser),
          step("sharpening", &o->detect.most_blur_px),
          step("conics", &o->segment.conics),
          step("rewrite", &o->rechain.on),
          step("silhouettes", &o->silhouettes),
          step("visibility", &o->optimize.visibility),
          step("simplify", &o->simplify),
          step("early-polish", &o->early_polish),
          step("second-look", &o->second_look),
          step("missing", &o->missing.on),
          step("final-polish", &o->final_polish),
          step("close", &o->close.on),
          step("regularize", &o->regularize.on)};
}

std::vector<Step> surfel_terms(DetectionOptions* o) {
  SurfelFieldOptions* s = &o->surfels;
  return {step("surfel-shading", &s->shading),
          step("surfel-albedo", &s->common_albedo),
          step("surfel-consistency", &s->loss.consistency),
          step("surfel-smoothness", &s->smoothness),
          step("surfel-carving", &s->hull.sweeps),
          step("surfel-sights", &s->hull.sights),
          step("surfel-moves", &s->moves.rounds),
          step("surfel-merge", &s->merge),
          step("surfel-planes", &s->planes.fewest),
          step("surfel-cylinders", &s->cylinders.fewest),
          step("surfel-mode", &s->mode_deg),
          step("surfel-snap", &o->surfel_snap_px)};
}

void list(const std::vector<Step>& steps, std::string* text, Fields* f) {
  std::vector<std::string> names;
  for (const Step& s : steps) names.push_back(s.name);
  f->pick("without", text, names, "Some of these steps are left out").applied = [steps, text] {
    for (const Step& s : steps) s.turn(!picked(*text, s.name));
  };
}

}  // namespace

void list_without(DetectionOptions* options, Fields* fields) {
  list(surfel_terms(options), &options->without, fields);
}

void list_without(ReconstructOptions* options, Fields* fields) {
  std::vector<Step> steps = method_steps(options);
  for (const Step& term : surfel_terms(options)) steps.push_back(term);
  list(steps, &options->without, fields);
}

}  // namespace sketchsplat
