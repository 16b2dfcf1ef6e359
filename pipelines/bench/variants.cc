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
  return {
      {"lift and fit only", {{"rounds", "0"}, {"without", "early-polish,final-polish"}}},
      {"+ raster rounds",
       {{"without", "early-polish,final-polish,simplify,visibility"}, {"steps", "8"}}},
      {"+ topology", {{"without", "early-polish,final-polish,visibility"}, {"steps", "8"}}},
      {"+ visibility", {{"without", "early-polish,final-polish"}, {"steps", "8"}}},
      {"+ final polish", {{"without", "early-polish,regularize"}}},
      {"+ polish in fit and rounds", {{"without", "regularize"}}},
      {"+ regularities = all", {}},
      {"all but rounds", {{"rounds", "0"}}},
      {"all, and raster steps", {{"steps", "8"}}},
      {"all but topology", {{"without", "simplify"}}},
      {"all, and raster steps without visibility", {{"without", "visibility"}, {"steps", "8"}}},
      {"all but final polish", {{"without", "final-polish"}}},
      {"all but conics", {{"without", "conics"}}},
      {"all but rewriting", {{"without", "rewrite"}}},
      {"all but closing", {{"without", "close"}}},
      {"all but the second look", {{"without", "second-look"}}},
      {"all but what is missing", {{"without", "missing"}}},
  };
}

std::vector<BenchVariant> ablation_variants_of(const std::vector<std::string>& detectors) {
  if (detectors != std::vector<std::string>{"2dgs-sn"}) return ablation_variants();
  std::vector<BenchVariant> variants = {
      {"2dgs-sn", {}},
      {"skew-normal kernel", {{"surfel-kernel", "skew-normal"}}},
      {"without shading", {{"without", "surfel-shading"}}},
      {"clone and split", {{"surfel-density", "clone-split"}}},
      {"fixed number of surfels", {{"surfel-density", "fixed"}}},
      {"without merging", {{"without", "surfel-merge"}}},
      {"without moves", {{"without", "surfel-moves"}}},
      {"without planes", {{"without", "surfel-planes"}}},
      {"without cylinders", {{"without", "surfel-cylinders"}}},
      {"without smoothness", {{"without", "surfel-smoothness"}}},
      {"without carving", {{"without", "surfel-carving"}}},
      {"without lines of sight", {{"without", "surfel-sights"}}},
      {"normals blended", {{"without", "surfel-mode"}}},
      {"edges where surfels say", {{"without", "surfel-snap"}}},
  };
  for (BenchVariant& variant : variants) variant.options.push_back({"detector", "2dgs-sn"});
  variants.push_back({"image", {{"detector", "image"}}});
  return variants;
}

}  // namespace sketchsplat
