// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>

#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "pipelines/base/atomic_file.h"
#include "pipelines/base/sketch_input.h"
#include "pipelines/base/version.h"
#include "pipelines/cameras/gauge.h"
#include "pipelines/command/cli.h"
#include "pipelines/pages/overlay.h"
#include "pipelines/results/inspection_outputs.h"
#include "pipelines/verbs/synthesis_plugin.h"
#include "sketches/curve/curve.h"
#include "sketches/io/json.h"
#include "sketches/io/length_unit.h"

namespace sketchsplat {
namespace fs = std::filesystem;
namespace {

struct InspectArguments {
  std::string results;  // one a line
  std::string nominal, out, scene;
  std::string datums;  // one a line
  std::string calibration, prior = "part";
  LengthUnit unit = LengthUnit::kMillimetre;
  double scale = 0;          // units per world unit; 0: fitted
  double nominal_scale = 1;  // units per unit of a sketch.json
  double reach_percent = 1.5;
  double smooth_angle_deg = 1;
  int overlays = 2;
  bool pieces = false;
  bool scale_sigma_given = false;
  InspectOptions inspect;
};

// The nominal part, and, if it came with faces, who can see its edges.
struct NominalFile {
  Nominal nominal;
  std::shared_ptr<CadPart> cad;
};

NominalFile read_nominal(const InspectArguments& a) {
  std::string ending = fs::path(a.nominal).extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (ending != ".step" && ending != ".stp") {
    const Sketch sketch = moved(read_sketch(a.nominal), {a.nominal_scale});
    return {make_nominal(sketch, a.nominal), nullptr};
  }
  const SynthesisPlugin& plugin = synthesis_plugin();
  const std::shared_ptr<CadPart> cad(plugin.read_cad(a.nominal, a.smooth_angle_deg),
                                     plugin.release_cad);
  return {make_nominal(moved(cad->edges.sketch, {1 / millimetres(a.unit)}), a.nominal), cad};
}

// The scene that a result was made of; without views if it is unknown or cannot be read.
Scene scene_of(const std::string& given, const SketchOrigin& origin, Progress* progress) {
  const std::string folder = given.empty() ? origin.scene : given;
  if (folder.empty()) return {};
  try {
    return open_scene(folder);
  } catch (const InputError& e) {
    if (!given.empty()) throw;
    progress->warn(e.what());
    return {};
  }
}

// `world_scale`: units per world unit; `to_mm`: millimetres of a unit.
Visibility visibility_of(const NominalFile& file, const Scene& scene, double world_scale,
                         double to_mm) {
  if (!file.cad || scene.views.empty()) return {};
  return [&file, &scene, world_scale, to_mm](const Similarity& pose,
                                             const std::vector<std::vector<EdgePlace>>& places) {
    std::vector<View> views;
    const Similarity to = Similarity{to_mm} * pose * Similarity{world_scale};
    for (const View& v : scene.views) views.push_back(moved(v, to));
    size_t total = 0;
    for (const auto& edge : places) total += edge.size();
    Eigen::Matrix3Xd points(3, total);
    std::vector<int> strokes;
    for (size_t e = 0; e < places.size(); ++e)
      for (const EdgePlace& p : places[e]) {
        points.col(Eigen::Index(strokes.size())) = to_mm * p.nominal;
        strokes.push_back(file.nominal.edges[e].strokes[0]);
      }
    const std::vector<int> counts =
        synthesis_plugin().count_views(file.cad.get(), views, points, strokes);
    std::vector<std::vector<int>> out;
    auto next = counts.begin();
    for (const auto& edge : places) {
      out.emplace_back(next, next + long(edge.size()));
      next += long(edge.size());
    }
    return out;
  };
}

// Edges that are not in, worst first.
std::vector<int> worst_edges(const Inspection& inspection, size_t most) {
  std::vector<int> out;
  for (int e = 0; e < int(inspection.edges.size()); ++e) {
    const Judgement v = inspection.edges[e].verdict;
    if (v == Judgement::kOut || v == Judgement::kUndecided) out.push_back(e);
  }
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) {
    return inspection.edges[a].within.likely < inspection.edges[b].within.likely;
  });
  if (out.size() > most) out.resize(most);
  return out;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Nominal green, measured blue, the worst edges red, over a few views.
std::vector<ReportImage> draw_worst(const std::string& folder, const Inspection& inspection,
                                    const Nominal& nominal, const Scene& scene, double scale,
                                    int count, Progress* progress) {
  const std::vector<int> worst = worst_edges(inspection, 3);
  const Similarity to_world = (inspection.alignment.pose * Similarity{scale}).inverse();
  std::vector<PaintedLine> lines;
  const auto add = [&](const Sketch& sketch, int s, std::array<float, 3> colour, int width) {
    Eigen::Matrix3Xd points = sample_stroke(sketch, s, stroke_length(sketch, s) / 96);
    for (int i = 0; i < points.cols(); ++i) points.col(i) = to_world * points.col(i);
    lines.push_back({points, colour, width});
  };
  for (int s = 0; s < nominal.sketch.size(); ++s) add(nominal.sketch, s, {0.1f, 0.6f, 0.3f}, 1);
  for (int s = 0; s < inspection.measured.size(); ++s)
    add(inspection.measured, s, {0.15f, 0.39f, 0.92f}, 1);
  for (const int e : worst)
    for (const int s : nominal.edges[e].strokes) add(nominal.sketch, s, {0.86f, 0.15f, 0.15f}, 2);
  const Eigen::Vector3d target = lines.back().points.rowwise().mean();
  std::vector<ReportImage> images;
  const auto warn = [&](const std::string& text) { progress->warn(text); };
  for (const std::string& path : write_overlays(folder, "inspection", lines, scene.views, target,
                                                worst.empty() ? 0 : count, warn, 800))
    images.push_back({fs::path(path).filename().string(), bytes_of(path)});
  return images;
}

std::string name_of(const std::string& result) {
  const fs::path path = fs::path(result + "/.").lexically_normal().parent_path();
  return path.extension() == ".json" ? path.stem().string() : path.filename().string();
}

// Where the files of a result go.
std::string folder_of(const std::string& result, const InspectArguments& a, bool alone) {
  if (!a.out.empty()) return alone ? a.out : a.out + "/" + name_of(result);
  std::error_code none;
  if (fs::is_directory(result, none)) return result;
  const std::string parent = fs::path(result).parent_path().string();
  return parent.empty() ? "." : parent;
}

Inspection inspect_one(const std::string& result, const NominalFile& file,
                       const InspectArguments& a, bool alone, Progress* progress,
                       InspectionTitle* title) {
  const SketchOrigin origin = sketch_origin(result);
  const Scene scene = scene_of(a.scene, origin, progress);
  const double scale = a.scale > 0 ? a.scale : 1;
  const Sketch measured = moved(read_sketch(result), {scale});
  if (measured.size() == 0) throw InputError(sketch_file(result), "a sketch with curves", "none");
  InspectOptions options = a.inspect;
  if (!a.scale_sigma_given && a.scale > 0) options.align.scale_sigma = origin.pose_scale_sigma;
  const Inspection inspection = inspect(file.nominal, measured, scale * origin.footprint, options,
                                        visibility_of(file, scene, scale, millimetres(a.unit)));
  const std::string folder = folder_of(result, a, alone);
  prepare_output_folder(folder);
  *title = {result, a.nominal, length_unit_names()[int(a.unit)], a.scale, program_version()};
  write_inspection(
      folder, inspection, file.nominal, options, *title,
      draw_worst(folder, inspection, file.nominal, scene, scale, a.overlays, progress));
  if (a.pieces)
    write_atomically(folder + "/inspection_pieces.json", [&](std::ostream& out) {
      out << pieces_json(inspection, file.nominal,
                         scale * origin.footprint * inspection.alignment.pose.scale);
    });
  for (const std::string& warning : inspection.warnings)
    progress->warn((alone ? "" : result + ": ") + warning);
  return inspection;
}

// One line a part.
void print_line(const LotPart& part) {
  std::cout << part.name << ": " << verdict_name(part.verdict) << " (" << part.out << " out, "
            << part.undecided << " undecided)\n";
}

[[noreturn]] void answer_no(const Inspection& inspection) {
  const JudgementCounts out = count_verdicts(inspection, Judgement::kOut);
  const JudgementCounts open = count_verdicts(inspection, Judgement::kUndecided);
  throw NotAllInError("not all in: " + std::to_string(out.edges) + " edges and " +
                      std::to_string(out.dimensions) + " dimensions out, " +
                      std::to_string(open.edges) + " and " + std::to_string(open.dimensions) +
                      " undecided");
}

void inspect_lot(const std::vector<std::string>& results, const NominalFile& file,
                 const InspectArguments& a, Progress* progress) {
  std::vector<LotPart> parts;
  std::set<std::string> names;
  Inspection first;
  InspectionTitle title;
  for (const std::string& result : results) {
    if (!names.insert(name_of(result)).second)
      throw UsageError("two results are called " + name_of(result) +
                       ": their files would overwrite one another");
    try {
      Inspection inspection = inspect_one(result, file, a, false, progress, &title);
      parts.push_back(lot_part(name_of(result), inspection));
      print_line(parts.back());
      if (parts.size() == 1) first = std::move(inspection);
    } catch (const InputError& e) {  // one broken result does not stop a lot
      progress->warn(e.what());
    }
  }
  if (parts.empty()) throw InputError(results[0], "results that can be inspected", "none");
  write_lot(a.out, parts, first, file.nominal, title);
  const auto in = std::count_if(parts.begin(), parts.end(),
                                [](const LotPart& p) { return p.verdict == Judgement::kIn; });
  std::cout << a.out << "/lot.html: " << in << " of " << results.size() << " parts are in\n";
  if (in < long(results.size()))
    throw NotAllInError("not all in: " + std::to_string(results.size() - size_t(in)) + " of " +
                        std::to_string(results.size()) + " parts");
}

// Numbers by the names that inspection.json gives them.
void read_calibration(const std::string& path, SigmaOptions* options) {
  const JsonValue file = load_json(path);
  for (const auto& [name, value] : named_numbers(options)) {
    *value = file[name].number();
    if (!(*value >= 0)) file[name].complain("a number that is not negative");
  }
}

void run_inspect(InspectArguments a, Progress* progress) {
  InspectOptions& o = a.inspect;
  if (!a.calibration.empty()) read_calibration(a.calibration, &o.sigma);
  if (!(o.tolerance > 0) && o.iso == Iso2768::kNone)
    throw UsageError("inspect needs --tolerance X or --iso2768 f|m|c|v");
  const std::vector<std::string> results = lines_of(a.results);
  const bool alone = results.size() == 1;
  if (!alone && a.out.empty()) throw UsageError("several results need --out DIR");
  if (a.scale == 0 && o.align.to == AlignTo::kAsGiven)
    throw UsageError("--align as-given needs --scale");
  o.unit_mm = millimetres(a.unit);
  o.learn_prior = a.prior == "part";
  o.align.fit_scale = a.scale == 0;
  o.align.datums = lines_of(a.datums);
  o.associate.reach = a.reach_percent / 100;
  if (!a.out.empty()) prepare_output_folder(a.out);
  const NominalFile file = read_nominal(a);
  if (!alone) return inspect_lot(results, file, a, progress);
  InspectionTitle title;
  const Inspection inspection = inspect_one(results[0], file, a, true, progress, &title);
  std::cout << inspection_table(inspection, file.nominal, title) << folder_of(results[0], a, true)
            << "/inspection.html: to look at\n";
  if (inspection.verdict != Judgement::kIn) answer_no(inspection);
}

Fields list_inspect_fields(InspectArguments* a) {
  Fields f;
  f.group("Arguments");
  Field& results = f.add("results", &a->results, "RESULT",
                         "A result folder of reconstruct, or its sketch.json; several: a lot");
  results.required = results.positional = results.several = true;
  f.add("nominal", &a->nominal, "PART.step|SKETCH.json", "The nominal part").required = true;
  f.add("out", &a->out, "DIR", "Folder to write into; default: that of the result").short_name =
      "o";
  f.add("scene", &a->scene, "SCENE",
        "The images, which determine what is visible; default: those of the result");
  f.group("Tolerance and size");
  f.add("tolerance", &a->inspect.tolerance, "units", 0, HUGE_VAL,
        "Radius of the tube around every edge, and +- of dimensions");
  f.choose("iso2768", &a->inspect.iso, {"none", "f", "m", "c", "v"},
           "General tolerances: of dimensions by their size; of edges, without --tolerance, by the "
           "part's");
  f.choose("unit", &a->unit, length_unit_names(), "Unit of all lengths");
  f.add("scale", &a->scale, "units per world unit", 0, 1e12,
        "Scale of the result; 0: fitted, then only shapes are judged");
  f.add("nominal-scale", &a->nominal_scale, "units per unit of SKETCH.json", 1e-12, 1e12,
        "Scale of the nominal part, unless it is STEP");
  f.group("Alignment");
  f.choose("align", &a->inspect.align.to, {"fit", "as-given"},
           "Align by the best fit of all edges, or not at all");
  f.add("datum", &a->datums, "NAME",
        "An edge (E1) or plane (P1) to align by; may be repeated, in the order of precedence")
      .several = true;
  f.add("reach", &a->reach_percent, "% of the part", 0.01, 50,
        "Largest distance of a curve to its nominal edge; at least three tolerances");
  f.add("least-views", &a->inspect.associate.least_views, "views", 1, 10000,
        "An edge is missing if so many views could see it");
  f.add("smooth-angle", &a->smooth_angle_deg, "deg", 0.01, 89,
        "Faces of the STEP file that meet at a smaller angle have no edge");
  f.group("Errors");
  f.add("scale-sigma", &a->inspect.sigma.scale_percent, "%", 0, 100,
        "Standard deviation of the scale; default: by the refined cameras")
      .applied = [a] { a->scale_sigma_given = true; };
  f.choose("prior", &a->prior, {"part", "none"},
           "Prior of deviations: from all edges of the part, or none");
  f.add("calibration", &a->calibration, "FILE.json",
        "Numbers of the error model, as eval/calibrate_inspection.py writes them");
  f.group("Output");
  f.add("overlays", &a->overlays, "images", 0, 100, "Draw the worst edges over this many images");
  f.add("pieces", &a->pieces, "Write inspection_pieces.json, for eval/calibrate_inspection.py");
  return f;
}

}  // namespace

Verb inspect_verb() {
  const auto arguments = std::make_shared<InspectArguments>();
  Verb verb;
  verb.name = "inspect";
  verb.summary = "Compare a result with its nominal part, with probabilities";
  verb.examples = {
      "sketchsplat inspect out/part --nominal part.step --tolerance 0.1 --unit mm --scale 80",
      "sketchsplat inspect out/part --nominal part.step --iso2768 m --scale 80 --datum P1 --datum "
      "P2",
      "sketchsplat inspect out/part --nominal good/sketch.json --tolerance 0.002 --scale 1",
      "sketchsplat inspect out/* --nominal part.step --tolerance 0.1 --scale 80 --out lot"};
  verb.fields = list_inspect_fields(arguments.get()).list;
  verb.run = [arguments](const CommonOptions&, Progress* progress) {
    run_inspect(*arguments, progress);
  };
  return verb;
}

}  // namespace sketchsplat
