// SPDX-License-Identifier: MIT
#include "pipelines/bench/suite.h"

namespace sketchsplat {

std::vector<BenchVariant> preset_variants(const std::vector<std::string>& presets,
                                          const std::vector<std::string>& detectors) {
  std::vector<BenchVariant> variants;
  for (const std::string& preset : presets)
    for (const std::string& detector : detectors)
      variants.push_back({preset + (detectors.size() > 1 ? ", " + detector : ""),
                          {{"preset", preset}, {"detector", detector}}});
  return variants;
}

std::vector<BenchVariant> ablation_variants() {
  const std::pair<std::string, std::string> no_rounds = {"rounds", "0"}, no_steps = {"steps", "0"},
                                            no_topology = {"simplify", "false"},
                                            no_visibility = {"visibility", "false"},
                                            no_early = {"early-polish", "false"},
                                            no_final = {"final-polish", "false"},
                                            no_regular = {"regularize", "false"},
                                            no_conics = {"conics", "false"},
                                            no_rewrite = {"rewrite", "false"},
                                            no_closing = {"close", "false"},
                                            no_second = {"second-look", "false"},
                                            no_missing = {"missing", "false"};
  return {
      {"lift and fit only", {no_early, no_final, no_rounds}},
      {"+ raster rounds", {no_early, no_final, no_topology, no_visibility}},
      {"+ topology", {no_early, no_final, no_visibility}},
      {"+ visibility", {no_early, no_final}},
      {"+ final polish", {no_early, no_regular}},
      {"+ polish in fit and rounds", {no_regular}},
      {"+ regularities = all", {}},
      {"all but rounds", {no_rounds}},
      {"all but raster steps", {no_steps}},
      {"all but topology", {no_topology}},
      {"all but visibility", {no_visibility}},
      {"all but final polish", {no_final}},
      {"all but conics", {no_conics}},
      {"all but rewriting", {no_rewrite}},
      {"all but closing", {no_closing}},
      {"all but the second look", {no_second}},
      {"all but what is missing", {no_missing}},
  };
}

std::vector<BenchVariant> ablation_variants_of(const std::vector<std::string>& detectors) {
  if (detectors != std::vector<std::string>{"2dgs-sn"}) return ablation_variants();
  std::vector<BenchVariant> variants = {
      {"2dgs-sn", {}},
      {"skew-normal kernel", {{"surfel-kernel", "skew-normal"}}},
      {"without shading", {{"surfel-shading", "false"}}},
      {"clone and split", {{"surfel-density", "clone-split"}}},
      {"fixed number of surfels", {{"surfel-density", "fixed"}}},
      {"without merging", {{"surfel-merge", "false"}}},
      {"without moves", {{"surfel-moves", "0"}}},
      {"without planes", {{"surfel-planes", "0"}}},
      {"without cylinders", {{"surfel-cylinders", "0"}}},
      {"without smoothness", {{"surfel-smoothness", "0"}}},
      {"without carving", {{"surfel-carving", "0"}}},
      {"without lines of sight", {{"surfel-sights", "0"}}},
      {"normals blended", {{"surfel-mode", "0"}}},
      {"edges where surfels say", {{"surfel-snap", "0"}}},
  };
  for (BenchVariant& variant : variants) variant.options.push_back({"detector", "2dgs-sn"});
  variants.push_back({"image", {{"detector", "image"}}});
  return variants;
}

}  // namespace sketchsplat
