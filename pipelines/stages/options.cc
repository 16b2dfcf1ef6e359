// SPDX-License-Identifier: MIT
#include "pipelines/stages/options.h"

#include <cmath>
#include <sstream>

#include "pipelines/adjust/standard_series.h"
#include "pipelines/stages/scale_reference.h"

namespace sketchsplat {
namespace {

struct Preset {
  const char* name;
  OptionTexts values;
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> list = {
      {"fast",
       {{"steps", "0"},
        {"rounds", "1"},
        {"lift-views", "16"},
        {"polish-rounds", "4"},
        {"polish-spacing", "5"},
        {"surfels", "4000"},
        {"surfels-most", "5000"},
        {"surfel-side", "400"},
        {"surfel-renderings", "600"}}},
      {"balanced", {}},
      {"accurate",
       {{"steps", "24"},
        {"lift-views", "49"},
        {"lift-stride", "2"},
        {"surfel-renderings", "2400"}}},
  };
  return list;
}

void list_lift(LiftOptions* o, Fields* f) {
  f->group("Lifting to space", true);
  f->add("lift-stride", &o->stride_px, "px", 0.5, 100, "Distance of edgels that are lifted");
  f->add("lift-views", &o->sweep_views, "views", 2, 10000, "Views that vote on a depth");
  f->add("lift-match", &o->match_px, "px", 0.1, 20, "Largest distance of an edgel that votes");
  f->add("lift-inlier", &o->inlier_px, "px", 0.1, 20, "The same for a point that was refined");
  f->add("lift-angle", &o->angle_deg, "deg", 0.1, 90, "Largest angle of its plane to the tangent");
  f->add("lift-min-views", &o->min_views, "views", 2, 10000, "Views that must agree");
}

void list_link(LinkOptions* o, Fields* f) {
  f->group("Linking to curves", true);
  f->add("link-merge", &o->merge_px, "px", 0, 100, "Points nearer along a curve become one");
  f->add("link-aside", &o->aside_px, "px", 0.1, 100, "Largest offset across a curve");
  f->add("link-reach", &o->reach_px, "px", 1, 1000, "Longest step from point to point");
  f->add("link-bend", &o->bend_deg, "deg", 0.1, 180, "Largest departure from a common circle");
}

void list_segment(SegmentOptions* o, Fields* f) {
  f->group("Cutting into curves", true);
  f->add("segment-sigma", &o->sigma, "px", 0.02, 20, "Standard deviation of lifted points");
  f->add("price", &o->price, "nat", 0, 100, "Of a parameter, when curves are chosen");
  f->add("segment-corner", &o->corner_deg, "deg", 1, 180, "Turn that ends a curve");
}

void list_select(SelectOptions* o, Fields* f) {
  f->group("Choosing strokes", true);
  f->add("min-views", &o->min_views, "views", 2, 10000, "Views that must see a stroke");
  f->add("min-nats", &o->least_nats, "nat", -1000, 1000,
         "Logarithm of the likelihood ratio of an edge and of none that a stroke needs");
  f->add("least-round", &o->round.least_radius_px, "px", 0.5, 1e6,
         "Radius from which on a rounded edge is none any more");
  f->add("least-round-size", &o->round.least_radius, "world units", 0, 1e9,
         "The same in units of the cameras; 0: --least-round tells");
  f->add("min-length", &o->min_length_px, "px", 0, 1000, "Shorter strokes are dropped");
}

void list_extent(ExtentOptions* o, Fields* f) {
  f->group("Ends of strokes", true);
  f->add("extend", &o->outward_px, "px", 0, 1000, "How far beyond a free end is looked");
  f->add("extend-share", &o->share, "", 0.05, 1, "Share of the views that must go on seeing it");
  f->add("gap-price", &o->gap_price, "times", 0, 100,
         "A gap in a stroke is crossed if so much more is seen beyond it; 0: it is its end");
}

void list_optimize(OptimizeOptions* o, Fields* f) {
  f->group("Drawing and moving", true);
  f->add("steps", &o->steps, "per round", 0, 100000, "Gradient steps on the rendered edges");
  f->add("step-length", &o->step_px, "px", 1e-4, 10, "Length of the first steps");
  f->add("splat-spacing", &o->spacing_px, "px", 0.25, 50, "Distance of the Gaussians on a stroke");
  f->add("splat-sigma", &o->sigma_px, "px", 0.3, 20, "Width of drawn edges");
  f->add("visibility", &o->visibility, "Draw nothing where a stroke is hidden");
}

void list_topology(TopologyOptions* o, Fields* f) {
  f->group("Simplifying the graph", true);
  f->add("merge-ends", &o->endpoint_px, "px", 0, 100, "Ends that may become one");
  f->add("merge-gap", &o->gap_px, "px", 0, 1000, "Gap between pieces of one curve");
  f->add("merge-offset", &o->offset_px, "px", 0, 100, "Offset between pieces of one curve");
}

void list_polish(PolishOptions* o, Fields* f) {
  f->group("Least squares on edgels", true);
  f->add("polish-rounds", &o->rounds, "rounds", 0, 1000, "Of matching and solving, at the most");
  f->add("polish-spacing", &o->spacing_px, "px", 0.25, 50, "Distance of samples on a stroke");
  f->add("polish-reach", &o->reach_px, "px", 0.1, 20, "Largest distance of an edgel at first");
  f->add("polish-final-reach", &o->final_reach_px, "px", 0.1, 20, "And at last");
  f->add("smooth-joint", &o->smooth_deg, "deg", 0, 45,
         "Joints of cubics, with one another or lines, that turn less are kept smooth");
}

void list_detect(DetectOptions* o, Fields* f) {
  f->group("Edges in the images", true);
  f->add("detect-sigma", &o->sigma_px, "px", 0.3, 5, "Smoothing of the gradient");
  f->add("detect-high", &o->high_sigma, "times the noise", 1, 100, "Gradient that starts an edge");
  f->add("detect-low", &o->low_sigma, "times the noise", 0.5, 100, "Gradient that continues it");
  f->add("detect-high-floor", &o->high_floor, "grey levels per px", 0, 255,
         "Smallest gradient that starts an edge, even without noise");
  f->add("detect-low-floor", &o->low_floor, "grey levels per px", 0, 255,
         "Smallest gradient that continues it");
  f->add("detect-min-chain", &o->min_chain, "px", 1, 1000, "Shorter edges are dropped");
  f->add("detect-false", &o->meaning.most_false, "per image", 0, 1e12,
         "Edges that texture would make more often are dropped; 0: none");
  f->add("detect-most", &o->meaning.most_sides, "sides of the image", 0, 1e6,
         "Edgels that are kept at the most, the most meaningful first; 0: all");
}

void list_maps(MapOptions* o, Fields* f) {
  f->group("Edge maps of others (--detector maps:NAME)", true);
  f->add("map-sigma", &o->sigma_px, "px", 0.3, 10, "Smoothing before the ridge is looked for");
  f->add("map-high", &o->high, "of strong ridges", 0, 1, "Ridge that starts an edge");
  f->add("map-low", &o->low, "of strong ridges", 0, 1, "Ridge that continues it");
  f->add("map-min-chain", &o->min_chain, "px", 1, 1000, "Shorter edges are dropped");
}

void list_geometry(GeometryOptions* o, Fields* f) {
  f->group("Edges of depth and normal maps (--detector geometry)", true);
  f->add("geometry-sigma", &o->sigma_px, "px", 0.3, 5, "Smoothing of the gradients");
  f->add("geometry-jump", &o->jump_px, "pixel footprints", 0.1, 1000,
         "Step of depth between the planes of two sides that is an edge");
  f->add("geometry-crease", &o->crease_deg, "deg", 1, 170, "Turn of the normal that is an edge");
  f->add("geometry-shallow", &o->shallow_deg, "deg", 0, 170,
         "The same between sides that are even over twice the width; 0: not looked for");
  f->add("geometry-noise", &o->noise, "times the noise", 0, 100, "And what either must exceed");
  f->add("geometry-rims", &o->rims, "Keep the contours of round surfaces");
  f->add("geometry-min-chain", &o->min_chain, "px", 1, 1000, "Shorter edges are dropped");
}

void list_surfels(DetectionOptions* all, Fields* f) {
  SurfelFieldOptions* o = &all->surfels;
  f->group("Surfels fitted to the images (--detector 2dgs-sn)", true);
  f->add("surfels", &o->surfels, "surfels", 10, 1e5, "At the start");
  f->add("surfels-most", &o->most_surfels, "surfels", 10, 1e5, "Ever");
  f->add("surfel-renderings", &o->renderings, "of a view", 0, 1e6, "Forward and backward, at most");
  f->add("surfel-side", &o->side_px, "px", 64, 4096,
         "Longer side of the pictures they are fitted to");
  f->add("surfel-batch", &o->batch, "views", 1, 64, "Drawn for one step");
  f->add("surfel-pixels", &o->pixels, "px", 1000, 1e8,
         "Of the object in a picture, mean; where it has more, pictures are made smaller");
  f->add("surfel-halvings", &o->halvings, "", 0, 2, "Of that side at the start");
  f->add("surfel-lowpass", &o->lowpass_px, "px", 0.1, 2,
         "Smallest standard deviation of a drawn surfel");
  f->choose("surfel-kernel", &o->kernel, {"gaussian", "skew-normal"}, "Profile of a surfel");
  f->add("surfel-shading", &o->shading, "Colours follow normals under one light");
  f->choose("surfel-density", &o->density, {"steep", "clone-split", "fixed"},
            "Split along the splitting matrix, where footprints are pulled, or never");
  f->add("surfel-merge", &o->merge, "Merge surfels that do the same work");
  f->add("surfel-albedo", &o->common_albedo, "", 0, 100, "Weight of one common albedo");
  f->add("surfel-consistency", &o->loss.consistency, "", 0, 100,
         "Weight of normals against those of the depth");
  f->add("surfel-distortion", &o->loss.distortion, "", 0, 100, "Weight of the spread along a ray");
  f->add("surfel-smoothness", &o->smoothness, "", 0, 100, "Weight of common planes of neighbours");
  f->add("surfel-smooth-angle", &o->smooth_angle_deg, "deg", 1, 90, "Turn that neighbours keep");
  f->add("surfel-carving", &o->hull.sweeps, "sweeps", 0, 10000,
         "Of the first surface, where views disagree");
  f->add(
      "surfel-sights", &o->hull.sights, "", 0, 1,
      "Share of the first surface's cells between planes that lines of sight to edges must cross "
      "to empty them; 0 looks at none");
  f->add("surfel-moves", &o->moves.rounds, "rounds", 0, 1000,
         "Of surfels to planes on which views agree better, before each level");
  f->add("surfel-planes", &o->planes.fewest, "surfels", 0, 1e6,
         "That make a plane and are laid on it at the end; 0 looks for none");
  f->add("surfel-cylinders", &o->cylinders.fewest, "surfels", 0, 1e6, "The same of cylinders");
  f->add("surfel-mode", &o->mode_deg, "deg", 0, 90,
         "Turn of what is one surface at a pixel; 0 blends all surfels");
  f->add("surfel-shading-pull", &o->shading_pull, "", 0, 1,
         "Share of the gradient of the shading that reaches normals");
  f->add("surfel-snap", &all->surfel_snap_px, "px", 0, 20,
         "Edges of the image so near say where an edge is; 0 leaves it to the surfels");
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
         "What lies in it is the object; auto: masks or a table tell")
      .applied = [o] { o->box = parse_box(o->box_text); };
  f->add("budget", &o->budget, "s", 0, 1e9,
         "Stop refining then and report; 0: never");
}

}  // namespace

void list_fields(DetectionOptions* o, Fields* f) {
  f->choose("detector", &o->detector, {"image", "geometry", "2dgs-sn", "maps:NAME"},
            "Edges of images, of depth/ and normal/, surfels, edge_NAME/");
  f->add("normals", &o->normals, "DIR", "Normals for --detector geometry, in the scene or anywhere")
      .expert = true;
  list_detect(&o->detect, f);
  list_maps(&o->maps, f);
  list_geometry(&o->geometry, f);
  list_surfels(o, f);
}

void list_fields(CommonOptions* o, Fields* f) {
  f->group("Everywhere");
  f->add("threads", &o->threads, "threads", 0, 1024, "Threads to use; 0 is one per core");
  f->add("seed", &o->seed, "", 0, HUGE_VAL, "Seed of everything that is drawn at random");
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
            "Sets several options at once; others override it")
      .applied = [o] { apply_preset(o->preset, o); };
  list_fields(static_cast<DetectionOptions*>(o), f);
  f->add("picture-side", &o->least_side, "px", 0, 100000,
         "Pictures at least twice as large are made smaller, to no less than this; 0: never");
  f->choose("refine-poses", &o->refine_poses, {"auto", "off", "on"},
            "Move cameras with the strokes: if they seem to err, never, always");
  f->choose("solid", &o->solid, {"auto", "off", "require"},
            "Close the curves to a solid: if they tell one, never, or fail without");
  Field& like = f->add("like", &o->like, "SKETCH",
                       "Results of siblings, parts of the same family: a start from what they have "
                       "in common");
  like.several = like.takes_more = true;
  f->choose("snap", &o->snap, standard_system_names(),
            "Make radii and distances standard ones where the pictures agree; needs a scale");
  list_lift(&o->lift, f);
  list_link(&o->link, f);
  list_segment(&o->segment, f);
  f->group("Kinds of strokes", true);
  f->add("conics", &o->segment.conics,
         "Try arcs, circles and ellipses, not lines and cubics alone");
  f->add("rewrite", &o->rechain.on, "Describe chains of strokes anew, in the fewest words");
  f->add("joint-sigma", &o->rechain.sigma_px, "px", 0.01, 10,
         "Least standard deviation of what all views say of a place");
  list_select(&o->select, f);
  f->add("surfel-sigma", &o->surfel_sigma_px, "px", 0.01, 100,
         "Scatter of edges that surfels tell of about their stroke");
  f->add("surfel-gap-price", &o->surfel_gap_price, "times", 0, 100,
         "At least --gap-price of edges that surfels tell of");
  list_extent(&o->extent, f);
  list_optimize(&o->optimize, f);
  list_topology(&o->topology, f);
  list_polish(&o->polish, f);
  f->group("Rounds", true);
  f->add("rounds", &o->rounds, "rounds", 0, 1000, "Of drawing and simplifying, at the most");
  f->add("simplify", &o->simplify, "Simplify the graph between the rounds");
  f->add("early-polish", &o->early_polish,
         "Least squares on the edgels in the fit and between the rounds, too");
  f->add("second-look", &o->second_look, "Look again at the edgels that no stroke explains");
  f->add("missing", &o->missing.on,
         "Look in the pictures for edges that the others lead to expect");
  f->add("final-polish", &o->final_polish, "End with least squares on the edgels");
  f->add("close", &o->close.on, "Close gaps, loose ends and circles at last");
  f->add("regularize", &o->regularize.on,
         "Let strokes share directions, planes, axes and radii where that is simpler");
  f->add("inferred", &o->inferred, "Write edges, too, that no picture shows and the solid implies");
  f->group("Output");
  f->add("min-confidence", &o->min_confidence, "", 0, 1, "Less probable strokes are left out");
  list_region(o, f);
}

void list_fields(CadOptions* o, Fields* f) {
  f->group("Files for CAD programs");
  f->choose("unit", &o->unit, length_unit_names(), "Unit of the lengths in the file")
      .applied = [o] { o->unit_given = true; };
  f->add("scale", &o->scale, "units per world unit", 1e-9, 1e9, "Size of a world unit")
      .applied = [o] { o->scale_given = true; };
  f->add("scale-by", &o->scale_by, "WHAT=LENGTH|none",
         "The same, from tag, size, diameter, circle:N or line:N")
      .applied = [o] { if (o->scale_by != "none") parse_scale_reference(o->scale_by); };
  f->add("faces", &o->faces, "Write closed planar loops as faces in STEP");
  f->add("face-tolerance", &o->face.tolerance, "of the extent", 1e-9, 0.1,
         "Distance of a face's edges from its plane")
      .expert = true;
}

void list_fields(OutputOptions* o, Fields* f) {
  f->add("overlays", &o->overlays, "views", 0, 100, "Views over which the curves are drawn");
  f->add("shell", &o->shell, "If no solid closes, write the faces that are sure: shell.step")
      .expert = true;
  f->add("point-spacing", &o->point_spacing, "of the extent", 1e-5, 1,
         "Distance of the samples in edge_points.ply")
      .expert = true;
  f->add("reproducible", &o->reproducible,
         "Leave times, memory and threads out of the reports: same input, same bytes")
      .expert = true;
  list_fields(&o->cad, f);
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}

void apply_preset(const std::string& name, ReconstructOptions* options) {
  for (const Preset& preset : presets()) {
    if (preset.name != name) continue;
    set_options(preset.values, options);
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
    if (!field)
      throw UsageError("unknown option " + name + " (see sketchsplat reconstruct --help)");
    assign(*field, text);
    if (field->applied) field->applied();
  }
}

Prices prices(const ReconstructOptions& options) {
  return {options.segment.price, options.rechain.sigma_px};
}

}  // namespace sketchsplat
