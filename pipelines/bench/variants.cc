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
      {"lift and fit only", {{"rounds", "0"}, {"without", "polish"}}},
      {"+ raster rounds", {{"without", "polish,topology,visibility"}, {"steps", "8"}}},
      {"+ topology", {{"without", "polish,visibility"}, {"steps", "8"}}},
      {"+ visibility", {{"without", "polish"}, {"steps", "8"}}},
      {"+ polish", {{"without", "regularize"}}},
      {"+ regularities = all", {}},
      {"all but rounds", {{"rounds", "0"}}},
      {"all, and raster steps", {{"steps", "8"}}},
      {"all, and raster steps without visibility", {{"without", "visibility"}, {"steps", "8"}}},
      {"all but topology", {{"without", "topology"}}},
      {"all but polish", {{"without", "polish"}}},
      {"all but conics", {{"without", "conics"}}},
      {"all but closing", {{"without", "close"}}},
      {"all but the second look", {{"without", "second-look"}}},
      {"all but what is missing", {{"without", "missing"}}},
  };
}

std::vector<BenchVariant> ablation_variants_of(const std::vector<std::string>& detectors) {
  if (detectors != std::vector<std::string>{"2dgs-sn"}) return ablation_variants();
  std::vector<BenchVariant> variants = {
      {"2dgs-sn", {}},
      {"skew-normal kernel", {{"surfel", "kernel=skew-normal"}}},
      {"clone and split", {{"surfel", "density=clone-split"}}},
      {"fixed number of surfels", {{"surfel", "density=fixed"}}},
  };
  for (BenchVariant& variant : variants) variant.options.push_back({"detector", "2dgs-sn"});
  variants.push_back({"image", {{"detector", "image"}}});
  return variants;
}

}  // namespace sketchsplat
