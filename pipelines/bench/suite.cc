// SPDX-License-Identifier: MIT
#include "pipelines/bench/suite.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "datasets/synthetic/cad/parts.h"
#include "datasets/types/errors.h"
#include "pipelines/command/cli.h"
#include "pipelines/command/cli_help.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

// A place in a suite file, with what is needed to complain about it.
struct Place {
  YAML::Node node;
  std::string path;

  [[noreturn]] void complain(const std::string& expected, const std::string& found) const {
    const int line = node.Mark().line;
    throw InputError(path + (line >= 0 ? ":" + std::to_string(line + 1) : ""), expected, found);
  }
  std::string shown() const {
    if (node.IsNull()) return "nothing";
    if (node.IsScalar()) return "'" + node.Scalar() + "'";
    return node.IsSequence() ? "a list" : "a mapping";
  }
  void check_keys(const Names& known) const {
    if (!node.IsMap()) complain("a mapping with " + joined(known), shown());
    for (const auto& entry : node) {
      const std::string key = entry.first.as<std::string>("");
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::string near = nearest_word(key, known);
      Place{entry.first, path}.complain(near.empty() ? "one of " + joined(known) : "'" + near + "'",
                                        "'" + key + "'");
    }
  }
  bool has(const std::string& key) const { return bool(node[key]); }
  Place operator[](const std::string& key) const {
    if (!has(key)) complain("the key '" + key + "'", "none");
    return {node[key], path};
  }
  std::vector<Place> elements() const {
    if (!node.IsSequence() || node.size() == 0) complain("a list", shown());
    std::vector<Place> all;
    for (const YAML::Node& element : node) all.push_back({element, path});
    return all;
  }
  std::string text() const {
    if (!node.IsScalar() || node.Scalar().empty()) complain("a text", shown());
    return node.Scalar();
  }
  Names texts() const {
    Names all;
    for (const Place& element : elements()) all.push_back(element.text());
    return all;
  }
  std::string one_of(const Names& names) const {
    const std::string word = text();
    if (std::find(names.begin(), names.end(), word) == names.end())
      complain("one of " + joined(names), shown());
    return word;
  }
  double number(double low, double high) const {
    try {
      const double value = node.as<double>();
      if (value >= low && value <= high) return value;
    } catch (const YAML::Exception&) {
    }
    char range[64];
    std::snprintf(range, sizeof range, "a number from %g to %g", low, high);
    complain(range, shown());
  }
  int integer(int low, int high) const {
    const double value = number(low, high);
    if (value != std::floor(value)) complain("a whole number", shown());
    return int(value);
  }
  bool boolean() const {
    bool value = false;
    if (!YAML::convert<bool>::decode(node, value)) complain("true or false", shown());
    return value;
  }
  // {views: 24, param: {gap: 0.1}} becomes views, param.gap.
  OptionTexts options(const std::string& prefix = "") const {
    if (!node.IsMap()) complain("options as NAME: VALUE", shown());
    OptionTexts all;
    for (const auto& entry : node) {
      const std::string name = prefix + entry.first.as<std::string>("");
      const Place value = {entry.second, path};
      if (entry.second.IsMap()) {
        const OptionTexts inner = value.options(name + ".");
        all.insert(all.end(), inner.begin(), inner.end());
      } else {
        all.push_back({name, value.text()});
      }
    }
    return all;
  }
  static std::string joined(const Names& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
  }
};

// Relative to the suite file.
std::string beside(const std::string& suite, const std::string& path) {
  return (fs::path(suite).parent_path() / path).lexically_normal();  // absolute ones stay
}

// A built-in part by its name; anything with an ending is a file.
BenchScene part_scene(const std::string& part, const std::string& suite) {
  const bool file = fs::path(part).has_extension();
  return {fs::path(part).stem(), "", file ? beside(suite, part) : part, {}};
}

BenchScene folder_scene(const std::string& folder) {
  return {fs::path(folder + "/.").lexically_normal().parent_path().filename(), folder, "", {}};
}

// Gives scenes of one name different ones.
void tell_apart(std::vector<BenchScene>* scenes) {
  std::set<std::string> taken;
  for (BenchScene& scene : *scenes) {
    const std::string stem = scene.name;
    for (int k = 2; !taken.insert(scene.name).second; ++k)
      scene.name = stem + "_" + std::to_string(k);
  }
}

BenchScene scene_of(const Place& place) {
  if (place.node.IsScalar()) return folder_scene(beside(place.path, place.text()));
  place.check_keys({"part", "folder", "name", "synthesize"});
  if (place.has("part") == place.has("folder"))
    place.complain("a scene with either part or folder",
                   place.has("part") ? "both of them" : "none of them");
  BenchScene scene =
      place.has("part") ? part_scene(place["part"].text(), place.path) : scene_of(place["folder"]);
  if (place.has("name")) scene.name = place["name"].text();
  if (place.has("synthesize")) {
    if (place.has("folder")) place["synthesize"].complain("no options of a folder", "some");
    scene.synthesize = place["synthesize"].options();
  }
  return scene;
}

// Scenes and parts of the suite or of one of its axes, by names that differ.
std::vector<BenchScene> scenes_of(const Place& place) {
  std::vector<BenchScene> scenes;
  if (place.has("scenes"))
    for (const Place& scene : place["scenes"].elements()) scenes.push_back(scene_of(scene));
  if (place.has("parts"))
    for (const std::string& part : place["parts"].texts())
      scenes.push_back(part_scene(part, place.path));
  tell_apart(&scenes);
  return scenes;
}

// "synthesize.noise", "reconstruct.seed"
void read_option(const Place& place, BenchAxis* axis) {
  const std::string text = place.text();
  const size_t dot = text.find('.');
  const std::string verb = text.substr(0, dot);
  if (dot == std::string::npos || (verb != "synthesize" && verb != "reconstruct"))
    place.complain("synthesize.OPTION or reconstruct.OPTION", place.shown());
  axis->of_reconstruct = verb == "reconstruct";
  axis->option = text.substr(dot + 1);
}

Names seeds_of(const Place& place) {
  Names seeds;
  for (const Place& seed : place.elements())
    seeds.push_back(std::to_string(seed.integer(0, 1 << 30)));
  return seeds;
}

BenchAxis axis_of(const Place& place) {
  place.check_keys({"name", "title", "vary", "levels", "pixels", "log", "report", "against",
                    "scenes", "parts", "part-seeds", "synthesize", "reconstruct"});
  BenchAxis axis;
  axis.name = place["name"].text();
  if (axis.name.find('/') != std::string::npos) place["name"].complain("a file's name", axis.name);
  axis.title = place.has("title") ? place["title"].text() : axis.name;
  axis.levels = {""};  // without an option to vary: one level, the scenes themselves
  if (place.has("vary")) {
    read_option(place["vary"], &axis);
    axis.levels = place["levels"].texts();
  }
  if (place.has("pixels")) axis.in_pixels = place["pixels"].boolean();
  if (place.has("log")) axis.log = place["log"].boolean();
  if (place.has("report")) axis.report = place["report"].one_of({"drop", "constant", "exponent"});
  if (place.has("against")) axis.against = place["against"].text();
  if (axis.against.empty() != (axis.report != "exponent"))
    place.complain("'against' where report is 'exponent', and only there", "'" + axis.name + "'");
  if (!place.has("vary") && axis.against.empty()) place["vary"];
  if (axis.report == "drop" || axis.in_pixels)
    for (const Place& level : place["levels"].elements())
      if (axis.in_pixels || !level_number(level.text())) level.number(-1e12, 1e12);
  axis.scenes = scenes_of(place);
  if (place.has("part-seeds")) axis.part_seeds = seeds_of(place["part-seeds"]);
  if (place.has("synthesize")) axis.synthesize = place["synthesize"].options();
  if (place.has("reconstruct")) axis.reconstruct = place["reconstruct"].options();
  return axis;
}

void read_axes(const Place& place, Suite* suite) {
  std::set<std::string> taken;
  for (const Place& axis : place.elements()) {
    suite->axes.push_back(axis_of(axis));
    if (!taken.insert(suite->axes.back().name).second)
      axis["name"].complain("a name of its own", axis["name"].shown());
    if (suite->scenes.empty() && suite->axes.back().scenes.empty())
      axis.complain("scenes or parts in the suite or in the axis", "none");
  }
}

Suite suite_of(const Place& place) {
  place.check_keys({"name", "scenes", "parts", "presets", "detectors", "ablation", "part-seeds",
                    "synthesize", "reconstruct", "axes", "repeats", "timeout"});
  Suite suite;
  suite.name = place.has("name") ? place["name"].text() : fs::path(place.path).stem().string();
  suite.scenes = scenes_of(place);
  const Names detectors = place.has("detectors") ? place["detectors"].texts() : Names{"image"};
  const Names presets = place.has("presets") ? place["presets"].texts() : preset_names();
  const bool ablation = place.has("ablation") && place["ablation"].boolean();
  suite.variants = ablation ? ablation_variants_of(detectors) : preset_variants(presets, detectors);
  if (place.has("part-seeds")) suite.part_seeds = seeds_of(place["part-seeds"]);
  if (place.has("synthesize")) suite.synthesize = place["synthesize"].options();
  if (place.has("reconstruct")) suite.reconstruct = place["reconstruct"].options();
  if (place.has("repeats")) suite.repeats = place["repeats"].integer(1, 1000);
  if (place.has("timeout")) suite.timeout_seconds = place["timeout"].number(0.001, 1e6);
  if (place.has("axes"))
    read_axes(place["axes"], &suite);
  else if (suite.scenes.empty())
    place.complain("scenes, parts or axes", "none");
  return suite;
}

// A verb's options, and those of all verbs.
class OptionCheck {
 public:
  explicit OptionCheck(Verb verb) : verb_(std::move(verb)) {
    list_fields(&common_, &fields_);
    fields_.list.insert(fields_.list.end(), verb_.fields.begin(), verb_.fields.end());
  }
  void check(const OptionTexts& options) const {
    for (const auto& [name, text] : options) {
      const bool nested = name.find('.') != std::string::npos;  // the verb itself reads NAME=VALUE
      const Field* field = find_field(fields_.list, name.substr(0, name.find('.')));
      if (!field || field->positional)
        throw UsageError(unknown_option(fields_.list, name, verb_.name));
      if (!nested) assign(*field, text);
    }
  }

 private:
  Verb verb_;  // values are assigned to what it owns
  CommonOptions common_;
  Fields fields_;
};

}  // namespace

std::optional<double> level_number(const std::string& level) {
  if (level == "true" || level == "false") return level == "true" ? 1 : 0;
  char* end = nullptr;
  const double number = std::strtod(level.c_str(), &end);
  if (level.empty() || *end != '\0') return std::nullopt;
  return number;
}

Suite suite_of_folders(const std::vector<std::string>& folders) {
  Suite suite;
  suite.keep = true;
  for (const std::string& folder : folders) suite.scenes.push_back(folder_scene(folder));
  tell_apart(&suite.scenes);
  return suite;
}

Suite read_suite(const std::string& path) {
  YAML::Node node;
  try {
    node = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw InputError(path, "a suite file", "none that can be read");
  } catch (const YAML::Exception& e) {
    throw InputError(path + ":" + std::to_string(e.mark.line + 1), "YAML or JSON", e.msg);
  }
  const Suite suite = suite_of({node, path});
  try {
    check_suite_options(suite);
  } catch (const UsageError& e) {
    throw InputError(path, "options that the program has", e.what());
  }
  return suite;
}

void check_suite_options(const Suite& suite) {
  const OptionCheck synthesize(synthesize_verb()), reconstruct(reconstruct_verb());
  synthesize.check(suite.synthesize);
  reconstruct.check(suite.reconstruct);
  for (const BenchVariant& variant : suite.variants) reconstruct.check(variant.options);
  for (const BenchScene& scene : suite.scenes) synthesize.check(scene.synthesize);
  for (const BenchAxis& axis : suite.axes) {
    synthesize.check(axis.synthesize);
    reconstruct.check(axis.reconstruct);
    for (const BenchScene& scene : axis.scenes) synthesize.check(scene.synthesize);
    for (const std::string& level : axis.levels)
      if (!axis.option.empty() && !axis.in_pixels)
        (axis.of_reconstruct ? reconstruct : synthesize).check({{axis.option, level}});
  }
}

}  // namespace sketchsplat
