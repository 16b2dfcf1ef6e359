// SPDX-License-Identifier: MIT
#include "pipelines/options/options.h"

#include <cmath>
#include <sstream>

#include "pipelines/options/common_options.h"
#include "pipelines/options/output_options.h"
#include "pipelines/options/scale_reference.h"
#include "pipelines/options/steps.h"

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

void list_edges(DetectionOptions* o, Fields* f) {
  f->group("Edges in the images", true);
  f->add("detect-sigma", &o->detect.sigma_px, "px", 0.3, 5,
         "Images are smoothed by a Gaussian of this standard deviation before edges are detected");
  f->add("detect-high", &o->detect.high_sigma, "times the noise", 1, 100,
         "An edge starts where the gradient exceeds this multiple of the image's noise");
  f->add("detect-low", &o->detect.low_sigma, "times the noise", 0.5, 100,
         "An edge goes on as long as the gradient exceeds this multiple of the image's noise");
  Field& chain = f->add("detect-min-chain", &o->detect.min_chain, "px", 1, 1000,
                        "Edges that are shorter than this in an image or a map are dropped");
  chain.applied = [o] { o->maps.min_chain = o->geometry.min_chain = o->detect.min_chain; };
  chain.former = {"map-min-chain", "geometry-min-chain"};
  f->add("map-high", &o->maps.high, "of strong ridges", 0, 1,
         "In an edge map of others, an edge starts where its ridge is this high");
  f->add("map-low", &o->maps.low, "of strong ridges", 0, 1,
         "In an edge map of others, an edge goes on as long as its ridge is this high");
  f->add("geometry-jump", &o->geometry.jump_px, "pixel footprints", 0.1, 1000,
         "In a depth map, a step from the plane of one side to that of the other is an edge from "
         "this height on");
  f->add("geometry-crease", &o->geometry.crease_deg, "deg", 1, 170,
         "In a normal map, a turn of the normal is an edge from this angle on");
}

void list_surfels(SurfelFieldOptions* o, Fields* f) {
  f->group("Surfels fitted to the images (--detector 2dgs-sn)", true);
  f->add("surfels", &o->surfels, "surfels", 10, 1e5, "The fit starts with this many surfels");
  f->choose("surfel-kernel", &o->kernel, {"gaussian", "skew-normal"},
            "The profile in which a surfel is drawn");
  f->choose("surfel-density", &o->density, {"steep", "clone-split", "fixed"},
            "Surfels are split along the splitting matrix, cloned and split where their footprints "
            "are pulled, or stay as many as they are");
}

void list_strokes(ReconstructOptions* o, Fields* f) {
  f->group("Strokes", true);
  f->add("lift-views", &o->lift.sweep_views, "views", 2, 10000,
         "This many views vote on the depth of an edgel when it is lifted to space");
  f->add("price", &o->segment.price, "nat", 0, 100,
         "A curve gets one more parameter if that improves its log likelihood by this much");
  f->add("gap-price", &o->extent.gap_price, "times", 0, 100,
         "A stroke goes on past a gap if it is seen beyond for this many times the gap's length; "
         "0: a gap ends it");
  f->add("min-views", &o->select.min_views, "views", 2, 10000,
         "Strokes that fewer views see are dropped");
  f->add("min-nats", &o->select.least_nats, "nat", -1000, 1000,
         "Strokes are dropped whose log likelihood ratio of an edge to none is below this");
  f->add("min-length", &o->select.min_length_px, "px", 0, 1000,
         "Strokes that are shorter than this are dropped");
  f->add("least-round", &o->select.round.least_radius_px, "px", 0.5, 1e6,
         "Rounded edges are left out from this radius on");
  f->add(
      "least-round-size", &o->select.round.least_radius, "world units", 0, 1e9,
      "Rounded edges are left out from this radius on, in units of the cameras; 0: --least-round "
      "tells");
}

void list_rounds(ReconstructOptions* o, Fields* f) {
  f->group("Rounds", true);
  f->add(
      "rounds", &o->rounds, "rounds", 0, 1000,
      "Strokes are drawn, moved and simplified in this many rounds, or fewer if nothing changes");
  f->add("steps", &o->optimize.steps, "per round", 0, 100000,
         "Strokes are moved by this many gradient steps on the rendered edges");
  f->add("merge-ends", &o->topology.endpoint_px, "px", 0, 100,
         "Ends of strokes that are nearer than this may become one");
  f->add("polish-rounds", &o->polish.rounds, "rounds", 0, 1000,
         "Strokes are matched with edgels and moved by least squares this many times, or fewer if "
         "nothing moves");
}

// "auto", or six numbers with commas between.
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

void list_region(ReconstructOptions* o, Fields* f) {
  f->add("box", &o->box_text, "x0,y0,z0,x1,y1,z1|auto",
         "Only what lies in this box is the object; auto: masks or a table tell")
      .applied = [o] { o->box = parse_box(o->box_text); };
  f->add("budget", &o->budget, "s", 0, 1e9, "Refining stops after this time; 0: never");
}

// Of everything that finds edges.
void list_detection(DetectionOptions* o, Fields* f) {
  f->choose("detector", &o->detector, {"image", "geometry", "2dgs-sn", "maps:NAME"},
            "Edges come from images, from depth/ and normal/, from surfels, or from edge_NAME/");
  f->add("normals", &o->normals, "DIR",
         "Folder of the normal maps for --detector geometry, in the scene or anywhere")
      .expert = true;
  list_edges(o, f);
  list_surfels(&o->surfels, f);
}

// Which steps there are, and how they go.
void list_choices(ReconstructOptions* o, Fields* f) {
  f->group("Steps", true);
  f->add("picture-side", &o->least_side, "px", 0, 100000,
         "Pictures at least twice as large as this are made smaller, to no less; 0: never");
  f->choose("refine-poses", &o->refine_poses, {"auto", "off", "on"},
            "Cameras are moved with the strokes if they seem to err, never, or always");
  f->choose("solid", &o->solid, {"auto", "off", "require"},
            "Curves are closed to a solid if they tell one, never, or the run fails without");
  Field& like = f->add("like", &o->like, "SKETCH",
                       "What results of siblings, parts of the same family, have in common is the "
                       "start");
  like.several = like.takes_more = true;
  list_without(o, f);
  f->add("inferred", &o->inferred,
         "Edges that no picture shows and the solid implies are written, too");
}

}  // namespace

void list_fields(DetectionOptions* o, Fields* f) {
  list_detection(o, f);
  list_without(o, f);
}

void list_fields(CommonOptions* o, Fields* f) {
  f->group("Everywhere");
  f->add("threads", &o->threads, "threads", 0, 1024, "Threads to use; 0 is one per core");
  f->add(
      "seed", &o->seed, "", 0, HUGE_VAL,
      "Seed of all that is drawn at random: noise of scenes, trials of planes, starts of surfels");
  f->add("quiet", &o->quiet, "Say nothing but errors").short_name = "q";
  f->add("verbose", &o->verbose, "Say more while working").short_name = "v";
  f->add("json", &o->json, "Write results to standard output as JSON");
  f->add("log", &o->log, "FILE", "Add everything that is said to this file, with the time");
  f->add("config", &o->config, "FILE",
         "Take options from this file (TOML); those of the command line override them");
  f->add("save-config", &o->save_config, "FILE",
         "Write the options that are not at their defaults, for --config");
}

void list_fields(ReconstructOptions* o, Fields* f) {
  f->group("Method");
  // First of its kind: options after it override what it sets.
  f->choose("preset", &o->preset, preset_names(),
            "Sets several options at once, which others override")
      .applied = [o] { apply_preset(o->preset, o); };
  list_detection(o, f);
  list_choices(o, f);
  list_strokes(o, f);
  list_rounds(o, f);
  f->group("Output");
  f->add("blends", &o->blends, "List rounded edges with their radii in report.json, too").expert =
      true;
  f->add("largest-blend", &o->blend_px, "px", 1, 1e6, "Radius of what is no rounded edge any more")
      .expert = true;
  f->add("min-confidence", &o->min_confidence, "", 0, 1,
         "Strokes that are less probably edges are left out");
  list_region(o, f);
}

void list_fields(CadOptions* o, Fields* f) {
  f->group("Files for CAD programs");
  f->choose("unit", &o->unit, length_unit_names(), "Lengths in CAD files are in this unit")
      .applied = [o] { o->unit_given = true; };
  f->add("scale", &o->scale, "units per world unit", 1e-9, 1e9, "Size of a world unit").applied =
      [o] { o->scale_given = true; };
  f->add("scale-by", &o->scale_by, "WHAT=LENGTH|none",
         "Scale, from a tag, size, diameter, circle:N or line:N")
      .applied = [o] {
    if (o->scale_by != "none") parse_scale_reference(o->scale_by);
  };
  f->add("faces", &o->faces, "Closed planar loops are written as faces in STEP");
  f->add("face-tolerance", &o->face.tolerance, "of the extent", 1e-9, 0.1,
         "Edges of a face may lie this far from its plane")
      .expert = true;
}

void list_fields(OutputOptions* o, Fields* f) {
  f->add("overlays", &o->overlays, "views", 0, 100, "The curves are drawn over this many views");
  f->add("shell", &o->shell, "Faces that are sure are written to shell.step if no solid closes")
      .expert = true;
  f->add("point-spacing", &o->point_spacing, "of the extent", 1e-5, 1,
         "Samples in edge_points.ply are this far apart")
      .expert = true;
  f->add("reproducible", &o->reproducible,
         "Times, memory and threads are left out of the reports: same input, same bytes")
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
