// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "datasets/readers/scene.h"
#include "datasets/synthetic/scene/synthesize.h"
#include "datasets/truth/ground_truth.h"
#include "eval/metrics/evaluate.h"
#include "pipelines/method/reconstruct.h"
#include "sketches/io/io.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat::test {

/// A part, rendered into a folder with its truth.
inline void write_part(const std::string& part, int views, int resolution, double noise,
                       const std::string& folder) {
  SynthesizeOptions options;
  options.part = part;
  options.seed = 2;
  options.rig.views = views;
  options.rig.resolution = resolution;
  options.render.noise = noise;
  options.outputs = "none";
  write_scene(synthesize(options), folder);
}

/// One with rounded edges, their largest radius `round` of its longest side, which is 200 px.
inline void write_rounded_part(const std::string& part, int seed, double round,
                               const std::string& folder) {
  SynthesizeOptions options;
  options.part = part;
  options.seed = seed;
  options.parameters = {{"round", round}};
  options.rig.views = 24;
  options.rig.resolution = 400;
  options.rig.object_size = 0.5;
  options.outputs = "none";
  write_scene(synthesize(options), folder);
}

/// As without any option.
inline Reconstruction reconstruct_as_ever(const Scene& scene) {
  const ReconstructOptions options;
  return reconstruct(scene, options, nullptr);
}

/// What users find in the folder of a result.
inline std::string json_of(const Sketch& sketch) {
  std::ostringstream out;
  write_sketch_json(out, sketch);
  return out.str();
}

/// Against the truth in the folder of the scene, by way of the file that others read.
inline Evaluation score(const Sketch& sketch, const std::string& scene_folder) {
  const TempFolder folder;
  {
    std::ofstream edges(folder.file("parametric_edges.json"));
    write_parametric_edges(edges, sketch);
    std::ofstream points(folder.file("edge_points.ply"), std::ios::binary);
    write_edge_points(points, sketch, 0.005);
  }
  return evaluate(read_prediction(folder.path()), find_ground_truth(scene_folder));
}

/// F at a distance, per cent.
inline double f_at(const Score& score, double threshold) {
  for (const Level& level : score.levels)
    if (std::abs(level.threshold - threshold) < 1e-9) return level.f;
  return -1;
}

inline int num_of_kind(const Sketch& sketch, StrokeKind kind) {
  int n = 0;
  for (const Stroke& s : sketch.strokes) n += s.kind == kind;
  return n;
}

/// Nodes where at least two strokes end.
inline int num_junctions(const Sketch& sketch) {
  std::vector<int> degree(sketch.nodes.cols());
  for (const Stroke& s : sketch.strokes)
    if (!is_closed(s.kind)) ++degree[s.begin], ++degree[s.end];
  int n = 0;
  for (int d : degree) n += d >= 2;
  return n;
}

}  // namespace sketchsplat::test
