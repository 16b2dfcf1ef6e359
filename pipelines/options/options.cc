// SPDX-License-Identifier: MIT
#include "pipelines/options/options.h"

#include <cmath>
#include <sstream>

#include "pipelines/options/common_options.h"
#include "pipelines/options/output_options.h"
#include "pipelines/options/scale_reference.h"

namespace sketchsplat {
namespace {

struct Preset {
  const char* name;
  void (*apply)(ReconstructOptions*);
};

void make_fast(ReconstructOptions* o) {
  o->optimize.steps = 0;
  o->rounds = 1;
  o->lift.sweep_views = 16;
  o->polish.rounds = 4, o->polish.spacing_px = 5;
  o->surfels.surfels = 4000, o->surfels.most_surfels = 5000;
  o->surfels.side_px = 400, o->surfels.renderings = 600;
}

void make_accurate(ReconstructOptions* o) {
  o->optimize.steps = 24;
  o->lift.sweep_views = 49, o->lift.stride_px = 2;
  o->surfels.renderings = 2400;
}

constexpr Preset kPresets[] = {
    {"fast", make_fast}, {"balanced", [](ReconstructOptions*) {}}, {"accurate", make_accurate}};

// "kernel=skew-normal,count=2000", or the count alone. Throws UsageError.
void set_surfels(const std::string& text, SurfelFieldOptions* o) {
  const std::string option = "surfel ";
  Fields f;
  f.choose(option + "kernel", &o->kernel, {"gaussian", "skew-normal"}, "");
  f.choose(option + "density", &o->density, {"steep", "clone-split", "fixed"}, "");
  f.add(option + "count", &o->surfels, "surfels", 10, 1e5, "");
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    const size_t equals = part.find('=');
    const bool named = equals != std::string::npos;
    const Field* field = find_field(f.list, option + (named ? part.substr(0, equals) : "count"));
    if (!field)
      throw UsageError("--surfel: expected kernel=, density= or count=, got '" + part + "'");
    assign(*field, named ? part.substr(equals + 1) : part);
  }
}

// A step that can be left out by its name.
struct Step {
  std::string name;
  std::vector<bool*> switches;
};

std::vector<Step> steps_of(ReconstructOptions* o) {
  return {{"silhouettes", {&o->silhouettes}},
          {"conics", {&o->segment.conics}},
          {"topology", {&o->simplify}},
          {"polish", {&o->early_polish, &o->final_polish}},
          {"visibility", {&o->optimize.visibility}},
          {"second-look", {&o->second_look}},
          {"missing", {&o->missing.on}},
          {"close", {&o->close.on}},
          {"regularize", {&o->regularize.on}},
          {"inferred", {&o->inferred}}};
}

void list_without(ReconstructOptions* o, Fields* f) {
  const std::vector<Step> steps = steps_of(o);
  std::vector<std::string> names;
  for (const Step& step : steps) names.push_back(step.name);
  f->pick("without", &o->without, names, "Leave out some of these steps").applied = [steps, o] {
    for (const Step& step : steps)
      for (bool* on : step.switches) *on = !picked(o->without, step.name);
  };
}

// In "results/./a/box" the folder before "/./" is where it lies, not what it is called.
void split_like(ReconstructOptions* o) {
  const std::string mark = "/./";
  const size_t at = o->like.substr(0, o->like.find('\n')).rfind(mark);
  if (at == std::string::npos) return;
  o->like_folder = o->like.substr(0, at);
  std::string names;
  for (const std::string& line : lines_of(o->like)) {
    if (line.rfind(o->like_folder + mark, 0) != 0)
      throw UsageError("--like: expected all of them in " + o->like_folder + mark + ", got '" +
                       line + "'");
    names += (names.empty() ? "" : "\n") + line.substr(at + mark.size());
  }
  o->like = names;
}

// "auto", or six numbers separated by commas.
Eigen::AlignedBox3d parse_box(const std::string& text) {
  if (text == "auto") return {};
  double x[6];
  char comma[6] = {};
  std::istringstream in(text);
  bool good = true;
  for (int k = 0; k < 6 && good; ++k) {
    good = bool(in >> x[k]) && std::isfinite(x[k]);
    if (good && k < 5) good = in.get(comma[k]) && comma[k] == ',';
  }
  Eigen::AlignedBox3d box;
  if (good) {
    box.extend(Eigen::Vector3d(x[0], x[1], x[2]));
    box.extend(Eigen::Vector3d(x[3], x[4], x[5]));
  }
  if (!good || !(in >> std::ws).eof() || !(box.sizes().minCoeff() > 0))
    throw UsageError("--box: expected auto or two opposite corners as x0,y0,z0,x1,y1,z1, got '" +
                     text + "'");
  return box;
}

void list_method(ReconstructOptions* o, Fields* f) {
  f->add("picture-side", &o->least_side, "px", 0, 100000,
         "Reduce images that are at least twice as large, to no less than this; 0: never")
      .expert = true;
  f->choose("refine-poses", &o->refine_poses, {"auto", "off", "on"},
            "Refine the cameras with the curves: if they seem inaccurate, never, or always");
  f->choose("solid", &o->solid, {"auto", "off", "require"},
            "Build a solid: if the curves enclose one, never, or fail without one");
  Field& like = f->add("like", &o->like, "SKETCH",
                       "Start from what the results of parts of the same family have in common");
  like.several = like.takes_more = true;
  like.applied = [o] { split_like(o); };
  f->add("box", &o->box_text, "x0,y0,z0,x1,y1,z1|auto",
         "The object lies in this box; auto: masks or a table determine it")
      .applied = [o] { o->box = parse_box(o->box_text); };
  f->add("min-confidence", &o->min_confidence, "", 0, 1,
         "Leave out curves that are less probable than this");
  f->add("budget", &o->budget, "s", 0, 1e9, "Stop refining after this time; 0: never");
}

void list_details(ReconstructOptions* o, Fields* f) {
  f->group("Details", true);
  list_without(o, f);
  f->add("lift-views", &o->lift.sweep_views, "views", 2, 10000,
         "Views that vote on the depth of an edge point");
  f->add("min-views", &o->select.min_views, "views", 2, 10000, "Drop curves that fewer views see");
  f->add("least-round", &o->select.round.least_radius_px, "px", 0.5, 1e6,
         "Leave out rounded edges with at least this radius");
  f->add("rounds", &o->rounds, "rounds", 0, 1000,
         "Rounds of joining, simplifying and refining curves; fewer if nothing changes");
  f->add("steps", &o->optimize.steps, "per round", 0, 100000,
         "Gradient steps on rendered edges in each round");
  f->add("blends", &o->blends, "List rounded edges and their radii in report.json");
}

}  // namespace

void list_fields(DetectionOptions* o, Fields* f) {
  f->choose("detector", &o->detector, {"image", "geometry", "2dgs-sn", "maps:NAME"},
            "Detect edges in images, in depth/ and normal/, by surfels, or read edge_NAME/");
  f->add("normals", &o->normals, "DIR",
         "Folder of the normal maps for --detector geometry, in the scene or anywhere")
      .expert = true;
  Field& surfel = f->add("surfel", &o->surfel, "NAME=VALUE,...",
                         "Surfels of --detector 2dgs-sn: kernel=gaussian or skew-normal, "
                         "density=steep, clone-split or "
                         "fixed, and how many at first: count=N");
  surfel.expert = true;
  surfel.applied = [o] { set_surfels(o->surfel, &o->surfels); };
}

void list_fields(CommonOptions* o, Fields* f) {
  f->group("Everywhere");
  f->add("threads", &o->threads, "threads", 0, 1024, "Threads to use; 0: one per core");
  f->add("seed", &o->seed, "", 0, HUGE_VAL,
         "Seed of all random numbers: noise of scenes, samples of RANSAC, starts of surfels");
  f->add("quiet", &o->quiet, "Print only results and errors").short_name = "q";
  f->add("verbose", &o->verbose, "Print more about the progress").short_name = "v";
  f->add("json", &o->json, "Write results to standard output as JSON");
  f->add("log", &o->log, "FILE", "Append all messages to this file, with the time");
  f->add("config", &o->config, "FILE",
         "Read options from this file (TOML); the command line overrides them");
  f->add("save-config", &o->save_config, "FILE", "Write the given options to a file for --config");
}

void list_fields(ReconstructOptions* o, Fields* f) {
  f->group("Method");
  // First of its kind: options after it override what it sets.
  f->choose("preset", &o->preset, preset_names(), "Set several options at once; others override")
      .applied = [o] { apply_preset(o->preset, o); };
  list_fields(static_cast<DetectionOptions*>(o), f);
  list_method(o, f);
  list_details(o, f);
}

void list_fields(CadOptions* o, Fields* f) {
  f->group("Files for CAD programs");
  f->choose("unit", &o->unit, length_unit_names(), "Unit of lengths in CAD files").applied = [o] {
    o->unit_given = true;
  };
  f->add("scale", &o->scale, "units per world unit", 1e-9, 1e9, "Size of a world unit").applied =
      [o] { o->scale_given = true; };
  f->add("scale-by", &o->scale_by, "WHAT=LENGTH|none",
         "Scale by a known length: tag, size, diameter, circle:N or line:N")
      .applied = [o] {
    if (o->scale_by != "none") parse_scale_reference(o->scale_by);
  };
}

void list_fields(OutputOptions* o, Fields* f) {
  f->group("Output");
  f->add("overlays", &o->overlays, "views", 0, 100, "Draw the curves over this many views");
  f->add("reproducible", &o->reproducible,
         "Leave times, memory and threads out of reports: same input, same bytes")
      .expert = true;
  list_fields(&o->cad, f);
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  return names;
}

void apply_preset(const std::string& name, ReconstructOptions* options) {
  for (const Preset& preset : kPresets) {
    if (preset.name != name) continue;
    preset.apply(options);
    options->preset = name;
    return;
  }
  throw UsageError("--preset: expected one of fast, balanced, accurate, got '" + name + "'");
}

void set_options(const OptionTexts& texts, ReconstructOptions* options) {
  Fields fields;
  list_fields(options, &fields);
  for (const auto& [name, text] : texts) {
    const Field* field = find_field(fields.list, name);
    if (!field) throw UsageError(unknown_option(fields.list, name, "reconstruct"));
    assign(*field, text);
    if (field->applied) field->applied();
  }
}

}  // namespace sketchsplat
