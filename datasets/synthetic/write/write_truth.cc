// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/write_truth.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/synthetic/write/write_part.h"
#include "datasets/types/errors.h"
#include "sketches/io/io.h"
#include "sketches/io/json.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json ground_truth(const Truth& truth) {
  json out = json::array();
  for (const TruthCurve& curve : truth.curves)
    out.push_back({{"type", curve.type},
                   {"closed", curve.closed},
                   {"dihedral_deg", curve.dihedral_deg},
                   {"visible_views", curve.visible_views},
                   {"points", json_rows(curve.points.transpose())}});
  return out;
}

}  // namespace

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw OutputError(path, error.message());
}

json json_rows(const Eigen::MatrixXd& m) {
  json out = json::array();
  for (int r = 0; r < m.rows(); ++r) {
    json row = json::array();
    for (int c = 0; c < m.cols(); ++c) row.push_back(m(r, c));
    out.push_back(row);
  }
  return out;
}

void write_image(const std::string& path, Fate fate,
                 const std::function<void(const std::string&)>& write) {
  std::error_code error;
  if (fate == Fate::kMissing) {
    fs::remove(path, error);
  } else {
    write(path);
    if (fate == Fate::kTruncated) fs::resize_file(path, fs::file_size(path) / 2, error);
  }
  if (error) throw OutputError(path, error.message());
}

void write_truth(const SyntheticScene& scene, const std::string& folder) {
  make_folder(folder + "/groundtruth");
  write_whole(folder + "/groundtruth/gt.json", json_text(ground_truth(scene.truth)));
  std::ostringstream sketch;
  write_sketch_json(sketch, scene.truth.sketch);
  write_whole(folder + "/groundtruth/sketch.json", sketch.str());
  if (scene.brep.shape)
    write_part(scene.brep, scene.frame, scene.options.extent, folder + "/groundtruth/part.step");
}

}  // namespace sketchsplat
