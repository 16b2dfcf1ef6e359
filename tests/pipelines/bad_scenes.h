// SPDX-License-Identifier: MIT
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "tests/support/damage.h"

namespace sketchsplat::test {

// {} is the folder of the scene.
inline constexpr char kOpen[] = "reconstruct {} --dry-run --out {}/out";
inline constexpr char kDetect[] = "detect {} --out {}/out";
inline constexpr char kMasks[] = "detect {} --masks {}/masks --out {}/out";
inline constexpr char kGeometry[] = "detect {} --detector geometry --out {}/out";
inline constexpr char kOutside[] = "reconstruct {} --dry-run --allow-outside --out {}/out";
inline constexpr char kSketch[] = "export {}/sketch.json --format obj --out {}/out.obj";
inline constexpr char kEmap[] = "evaluate --pred {}/emap.json --gt {}/gt.json";
inline constexpr char kNef[] = "evaluate --pred {}/nef.json --gt {}/gt.json";
inline constexpr char kPly[] = "evaluate --pred {}/points.ply --gt {}/gt.json";
inline constexpr char kObj[] = "evaluate --pred {}/lines.obj --gt {}/gt.json";
inline constexpr char kAbc[] = "evaluate --pred {}/emap.json --gt {}/abc";
inline constexpr char kStep[] = "synthesize {}/part.step --out {}/out";

inline const std::string kMeta = "meta_data.json", kTrain = "transforms_train.json",
                  kTrans = "transforms.json";
inline const std::string kCameras = "sparse/0/cameras", kImages = "sparse/0/images",
                  kPoints = "sparse/0/points3D";
inline const std::string kIdentity = "[[1,0,0,0.000000],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]";

/// A small good scene, damaged in one place.
struct BadScene {
  std::string name;
  std::string format;  ///< of the good scene
  std::string command;
  Damage damage;
  int status;
  std::string line;  ///< a regular expression, of the error or else of the warning
};
inline void PrintTo(const BadScene& row, std::ostream* out) { *out << row.name; }

/// The tables: what is wrong with the files that tell of a scene, and with all others.
std::vector<BadScene> bad_scene_files();
std::vector<BadScene> bad_transforms();
std::vector<BadScene> bad_colmap_files();
std::vector<BadScene> bad_images();
std::vector<BadScene> bad_edges();

}  // namespace sketchsplat::test
