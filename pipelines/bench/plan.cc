// SPDX-License-Identifier: MIT
#include "pipelines/bench/plan.h"

#include <algorithm>
#include <cstdio>

#include "datasets/synthetic/render/rig.h"

namespace sketchsplat {
namespace {

// The later of two texts for one option wins; but steps that are left out add up.
void add_options(const OptionTexts& more, OptionTexts* options) {
  for (const auto& [name, text] : more) {
    bool known = false;
    for (auto& [n, t] : *options) {
      if (n != name) continue;
      const bool both = name == "without" && t != "none";
      if (!both)
        t = text;
      else if (text != "none")
        t += "," + text;
      known = true;
    }
    if (!known) options->push_back({name, text});
  }
}

double number_of(const OptionTexts& options, const std::string& name, double otherwise) {
  for (const auto& [n, text] : options)
    if (n == name) return std::stod(text);
  return otherwise;
}

std::string value_at(const BenchAxis& axis, const std::string& level,
                     const OptionTexts& synthesize) {
  if (!axis.in_pixels) return level;
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", std::stod(level) / object_pixels(synthesize));
  return text;
}

// A scene at a level, without the variants.
BenchJob scene_job(const Suite& suite, const BenchScene& scene, const BenchAxis* axis,
                   const std::string& level, const std::string& part_seed) {
  BenchJob job;
  job.scene = scene.name;
  job.folder = scene.folder;
  job.axis = axis;
  job.level = level;
  if (scene.folder.empty()) {
    job.synthesize = {{"part", scene.part}, {"seed", part_seed}};
    add_options(suite.synthesize, &job.synthesize);
    add_options(scene.synthesize, &job.synthesize);
    if (axis) add_options(axis->synthesize, &job.synthesize);
    if (axis && !axis->option.empty() && !axis->of_reconstruct)
      add_options({{axis->option, value_at(*axis, level, job.synthesize)}}, &job.synthesize);
  }
  return job;
}

void add_runs(const Suite& suite, const BenchJob& scene, const OptionTexts& with,
              BenchLevel* jobs) {
  for (const BenchVariant& variant : suite.variants) {
    BenchJob job = scene;
    job.variant = variant.name;
    add_options(variant.options, &job.reconstruct);
    add_options(suite.reconstruct, &job.reconstruct);
    if (job.axis) add_options(job.axis->reconstruct, &job.reconstruct);
    add_options(with, &job.reconstruct);
    if (job.axis && job.axis->of_reconstruct)
      add_options({{job.axis->option, job.level}}, &job.reconstruct);
    jobs->push_back(job);
  }
}

}  // namespace

double object_pixels(const OptionTexts& synthesize) {
  RigOptions rig;
  rig.resolution = int(number_of(synthesize, "resolution", rig.resolution));
  rig.object_size = number_of(synthesize, "object-size", rig.object_size);
  rig.focal = number_of(synthesize, "focal", rig.focal);
  rig.distance = number_of(synthesize, "distance", rig.distance);
  const bool photographs =
      std::find(synthesize.begin(), synthesize.end(),
                std::pair<std::string, std::string>("style", "photo")) != synthesize.end();
  rig = resolved(rig, photographs);
  return rig.focal / rig.distance;
}

std::vector<BenchLevel> plan_jobs(const Suite& suite, const BenchAxis* axis,
                                  const OptionTexts& with) {
  const std::vector<BenchScene>& scenes =
      axis && !axis->scenes.empty() ? axis->scenes : suite.scenes;
  const std::vector<std::string>& part_seeds =
      axis && !axis->part_seeds.empty() ? axis->part_seeds : suite.part_seeds;
  std::vector<BenchLevel> levels;
  for (const std::string& level : axis ? axis->levels : std::vector<std::string>{""}) {
    levels.emplace_back();
    for (const BenchScene& scene : scenes) {
      const size_t copies = scene.folder.empty() ? part_seeds.size() : 1;
      for (size_t k = 0; k < copies; ++k) {
        BenchJob job = scene_job(suite, scene, axis, level, part_seeds[k]);
        if (copies > 1) job.scene += "-" + part_seeds[k];
        add_runs(suite, job, with, &levels.back());
      }
    }
  }
  return levels;
}

std::vector<std::string> flags_of(const OptionTexts& options, const std::vector<Field>& fields) {
  std::vector<std::string> flags, positional;
  for (const auto& [name, text] : options) {
    const size_t dot = name.find('.');
    const Field* field = find_field(fields, name.substr(0, dot));
    if (field && field->positional) {
      positional.push_back(text);
    } else if (field && std::holds_alternative<bool*>(field->value)) {
      flags.push_back((text == "true" ? "--" : "--no-") + name);
    } else if (dot != std::string::npos) {
      flags.push_back("--" + name.substr(0, dot));
      flags.push_back(name.substr(dot + 1) + "=" + text);
    } else {
      flags.push_back("--" + name);
      flags.push_back(text);
    }
  }
  positional.insert(positional.end(), flags.begin(), flags.end());
  return positional;
}

}  // namespace sketchsplat
