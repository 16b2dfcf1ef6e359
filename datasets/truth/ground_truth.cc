// SPDX-License-Identifier: MIT
#include "datasets/truth/ground_truth.h"

#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/io/ply.h"
#include "datasets/truth/abc_features.h"
#include "datasets/truth/published_samples.h"
#include "datasets/types/errors.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "sketches/io/json.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace sketchsplat {
namespace {

constexpr double kPublishedInterval = 0.005;  // in the CAD file's units, before any normalisation
constexpr const char* kSamplesEnding = "_0.005.ply";

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

// Files of a folder whose name begins and ends so, sorted by name; none if there is no folder.
std::vector<fs::path> files_of(const fs::path& folder, const std::string& begin,
                               const std::string& ending) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, begin.size(), begin) == 0 && ends_with(name, ending) &&
        entry.is_regular_file(error)) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

// First file so called in these folders; empty if none.
std::string first_of(const std::vector<fs::path>& folders, const std::string& begin,
                     const std::string& ending) {
  for (const fs::path& folder : folders) {
    const auto files = files_of(folder, begin, ending);
    if (!files.empty()) return files[0].string();
  }
  return "";
}

std::string stats_above(fs::path folder) {
  folder = fs::absolute(folder);
  for (int level = 0; level < 4; ++level) {
    const std::string found = first_of({folder}, "chunk_", "_stats.json");
    if (!found.empty()) return found;
    folder = folder.parent_path();
  }
  return "";
}

// Models are called by the characters before the first underscore.
std::string model_id(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.substr(0, name.find('_'));
}

bool is_closed(const Eigen::Matrix3Xd& polyline) {
  const Eigen::Index n = polyline.cols();
  if (n < 3) return false;
  const Eigen::Vector3d size = polyline.rowwise().maxCoeff() - polyline.rowwise().minCoeff();
  return (polyline.col(0) - polyline.col(n - 1)).norm() <= 1e-6 * size.maxCoeff();
}

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// What lies beyond has no distances that a double can hold.
constexpr double kLargest = 1e100;
constexpr double kMostViews = 1e6;  // that may see a point

// Samples are taken every so often whatever the size: where that is too many, somebody means
// something else by the numbers.
void check_sampled_length(const std::vector<Eigen::Matrix3Xd>& curves, const std::string& path) {
  constexpr double kMost = 1e5;
  double length = 0;
  for (const Eigen::Matrix3Xd& curve : curves)
    for (Eigen::Index k = 0; k + 1 < curve.cols(); ++k)
      length += (curve.col(k + 1) - curve.col(k)).norm();
  if (!(length <= kMost))
    throw InputError(path, "sharp curves of at most 100000 units in all", std::to_string(length));
}

void set_samples(const std::vector<Eigen::Matrix3Xd>& raw, const Eigen::Vector3d& offset,
                 GroundTruth* truth) {
  truth->samples = concatenate(raw) * truth->raw_scale;
  truth->samples.colwise() += offset;
}

GroundTruth read_abc(const fs::path& features) {
  const fs::path folder = features.parent_path(), above = folder / "..";
  const std::string id = model_id(features);
  const AbcModel model =
      read_abc_model(features.string(), first_of({folder, above / "obj"}, id, ".obj"),
                     stats_above(folder.empty() ? "." : folder), id);
  GroundTruth truth;
  truth.path = features.string();
  truth.format = "abc";
  truth.raw_scale = model.scale;
  std::vector<Eigen::Matrix3Xd> sharp, raw;
  for (const AbcModel::Curve& curve : model.curves)
    if (curve.sharp) sharp.push_back(curve.polyline);
  check_sampled_length(sharp, truth.path);
  for (const Eigen::Matrix3Xd& curve : sharp)
    raw.push_back(sample_segments(curve, kPublishedInterval));
  for (const AbcModel::Curve& curve : model.curves) {
    const Eigen::Matrix3Xd world = (curve.polyline * model.scale).colwise() + model.offset;
    truth.curves.push_back({curve.type, world, curve.sharp, is_closed(world)});
  }
  const std::string published =
      first_of({folder, above / "sampled_pts", folder / "sampled_pts"}, id, kSamplesEnding);
  truth.samples_published = !published.empty();
  if (truth.samples_published) {
    truth.samples = read_ply_points(published).position;
  } else {
    set_samples(raw, model.offset, &truth);
  }
  return truth;
}

void set_extent(GroundTruth* truth) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL), high = -low;
  const auto add = [&](const Eigen::Matrix3Xd& points) {
    if (points.cols() == 0) return;
    low = low.cwiseMin(points.rowwise().minCoeff());
    high = high.cwiseMax(points.rowwise().maxCoeff());
  };
  for (const auto& curve : truth->curves) add(curve.polyline);
  if (truth->curves.empty()) add(truth->samples);
  const double longest = (high - low).maxCoeff();
  if (!(longest > 0)) throw InputError(truth->path, "edges with a length", "none");
  const bool in_unit_cube = low.minCoeff() > -0.05 && high.maxCoeff() < 1.05 && longest >= 0.5;
  truth->extent = in_unit_cube || (longest >= 0.9 && longest <= 1.1) ? 1.0 : longest;
  truth->center = (low + high) / 2;
}

GroundTruth read_samples(const fs::path& file) {
  GroundTruth truth;
  truth.path = file.string();
  truth.format = "samples";
  truth.samples = read_ply_points(truth.path).position;
  truth.samples_published = true;
  if (truth.samples.cols() == 0) throw InputError(truth.path, "samples", "none");
  set_extent(&truth);
  return truth;
}

Eigen::Matrix3Xd points_of(const json& list, const std::string& path) {
  Eigen::Matrix3Xd points(3, list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    if (list[i].size() != 3) throw InputError(path, "points of 3 numbers", json_text(list[i]));
    for (int k = 0; k < 3; ++k) points(k, i) = list[i].at(k).get<double>();
  }
  if (points.cols() < 2) {
    throw InputError(path, "curves of two points and more", std::to_string(points.cols()));
  }
  if (!(points.cwiseAbs().maxCoeff() < kLargest)) {
    throw InputError(path, "coordinates below 1e100", "another number");
  }
  return points;
}

// As many numbers as the curve has points in the file; none if the file does not say.
std::vector<int> visible_views_of(const json& item, Eigen::Index points, const std::string& path) {
  if (!item.contains("visible_views") || item["visible_views"].empty()) return {};
  const auto numbers = item["visible_views"].get<std::vector<double>>();
  if (Eigen::Index(numbers.size()) != points) {
    throw InputError(path, std::to_string(points) + " visible_views, one a point",
                     std::to_string(numbers.size()));
  }
  std::vector<int> views;
  for (const double n : numbers) {
    if (!(n >= 0 && n <= kMostViews))
      throw InputError(path, "numbers of views", json_text(json(n)));
    views.push_back(int(n));
  }
  return views;
}

GroundTruth read_point_curves(const json& document, const std::string& path) {
  GroundTruth truth;
  truth.path = path;
  truth.format = "curves";
  const json& list = document.is_array() ? document : document.at("curves");
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  if (document.is_object() && document.contains("scale")) {
    truth.raw_scale = document.at("scale").get<double>();
    offset = points_of(json::array({document.at("offset"), document.at("offset")}), path).col(0);
    if (!(truth.raw_scale > 0))
      throw InputError(path, "scale above 0", json_text(document["scale"]));
  }
  std::vector<Eigen::Matrix3Xd> raw;
  for (const json& item : list) {
    const bool in_raw = item.contains("points_mm");
    Eigen::Matrix3Xd points = points_of(item.at(in_raw ? "points_mm" : "points"), path);
    std::vector<int> views = visible_views_of(item, points.cols(), path);
    const bool closed = item.value("closed", is_closed(points));
    if (closed && !is_closed(points)) {
      if (!views.empty()) views.push_back(views.front());
      points.conservativeResize(3, points.cols() + 1);
      points.rightCols<1>() = points.col(0);
    }
    const bool sharp = item.value("sharp", true);
    if (in_raw && sharp) {
      check_sampled_length({points}, path);
      raw.push_back(sample_segments(points, kPublishedInterval));
    }
    if (in_raw) points = ((points * truth.raw_scale).colwise() + offset).eval();
    truth.curves.push_back({lower(item.value("type", "other")), points, sharp, closed, views});
  }
  if (truth.raw_scale > 0) set_samples(raw, offset, &truth);
  return truth;
}

GroundTruth read_sketch(const fs::path& file) {
  std::ifstream in(file);
  const Sketch sketch = read_sketch_json(in, file.string());
  GroundTruth truth;
  truth.path = file.string();
  truth.format = "sketch";
  for (int s = 0; s < sketch.size(); ++s) {
    const StrokeKind kind = sketch.strokes[s].kind;
    // 200 pieces: the chords of a full circle stay within 1.3e-4 of its radius.
    const Eigen::Matrix3Xd points = sample_stroke(sketch, s, stroke_length(sketch, s) / 200);
    truth.curves.push_back({kind_name(kind), points, true, is_closed(points)});
  }
  return truth;
}

GroundTruth read_json(const fs::path& file) {
  const std::string path = file.string();
  std::ifstream in(file);
  if (!in) throw InputError(path, "ground truth", "nothing that can be opened");
  GroundTruth truth;
  try {
    const json document = parse_json<json>(in, path);
    if (document.is_object() && document.contains("strokes")) {
      truth = read_sketch(file);
    } else {
      truth = read_point_curves(document, path);
    }
  } catch (const json::exception& e) {
    throw InputError(path, "curves with type and points", e.what());
  }
  if (truth.curves.empty()) throw InputError(path, "curves", "none");
  set_extent(&truth);
  return truth;
}

GroundTruth read_file(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  if (extension == ".yml" || extension == ".yaml") return read_abc(file);
  if (extension == ".json") return read_json(file);
  if (extension == ".ply") return read_samples(file);
  throw InputError(file.string(), "ground truth as .yml, .json or .ply", extension);
}

// The file that tells a folder's truth; of the model `id` only, if not empty. Empty if none.
fs::path truth_file(const fs::path& folder, const std::string& id) {
  for (const fs::path& place : {folder, folder / "feat"}) {
    const auto files = files_of(place, id, ".yml");
    if (files.empty()) continue;
    if (model_id(files.front()) != model_id(files.back())) {
      throw InputError(place.string(), "features of one model (or the path of one file)",
                       std::to_string(files.size()) + " files");
    }
    return files[0];
  }
  if (id.empty()) {
    for (const char* name : {"gt.json", "sketch.json"}) {
      if (fs::is_regular_file(folder / name)) return folder / name;
    }
  }
  return first_of({folder, folder / "sampled_pts"}, id, kSamplesEnding);
}

fs::path truth_file_of_scene(const fs::path& scene) {
  for (const char* name : {"gt", "groundtruth"}) {
    const fs::path file = truth_file(scene / name, "");
    if (!file.empty()) return file;
  }
  fs::path file = truth_file(scene, "");
  if (!file.empty()) return file;
  for (const fs::path& json_file : files_of(scene, "", ".json")) {
    if (json_file.filename().string().find("gt") != std::string::npos) return json_file;
  }
  // One folder of truths for a whole data set: ROOT/groundtruth/feat/ID* of ROOT/data/ID.
  fs::path above = fs::weakly_canonical(scene);
  const std::string id = above.filename().string();
  for (int level = 0; level < 2 && !id.empty(); ++level) {
    above = above.parent_path();
    for (const char* name : {"groundtruth", "gt"}) {
      file = truth_file(above / name, id);
      if (!file.empty()) return file;
    }
  }
  return {};
}

// EMAP's scenes may stand turned or scaled against their truth.
void undo_world_to_gt(const fs::path& scene, GroundTruth* truth) {
  std::ifstream in(scene / "meta_data.json");
  if (!in) return;
  Eigen::Matrix4d gt_from_world = Eigen::Matrix4d::Identity();
  try {
    const json document = parse_json<json>(in, (scene / "meta_data.json").string());
    if (!document.contains("worldtogt")) return;
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) gt_from_world(r, c) = document["worldtogt"].at(r).at(c);
    }
  } catch (const json::exception& e) {
    throw InputError((scene / "meta_data.json").string(), "worldtogt of 4 x 4 numbers", e.what());
  }
  if (gt_from_world.isIdentity(0)) return;
  const double scale = std::cbrt(std::abs(gt_from_world.topLeftCorner<3, 3>().determinant()));
  if (!(scale > 0) || !gt_from_world.allFinite()) {
    throw InputError((scene / "meta_data.json").string(), "a worldtogt that can be inverted",
                     "determinant 0");
  }
  const Eigen::Matrix4d world_from_gt = gt_from_world.inverse();
  const auto apply = [&](Eigen::Matrix3Xd* points) {
    *points = ((world_from_gt.topLeftCorner<3, 3>() * *points).colwise() +
               Eigen::Vector3d(world_from_gt.topRightCorner<3, 1>()))
                  .eval();
  };
  for (auto& curve : truth->curves) apply(&curve.polyline);
  apply(&truth->samples);
  Eigen::Matrix3Xd center = truth->center;
  apply(&center);
  truth->center = center;
  truth->extent /= scale;
  truth->raw_scale /= scale;
}

}  // namespace

bool has_ground_truth(const std::string& path) {
  std::error_code none;
  return fs::is_directory(path, none) ? !truth_file_of_scene(path).empty() : fs::exists(path, none);
}

GroundTruth find_ground_truth(const std::string& path) {
  std::error_code none;
  const bool folder = fs::is_directory(path, none);
  if (!folder && !fs::exists(path, none)) throw InputError(path, "ground truth", "nothing there");
  const fs::path file = folder ? truth_file_of_scene(path) : fs::path(path);
  if (file.empty()) {
    throw InputError(path, "ground truth (gt/, groundtruth/, *_features_*.yml, gt.json)", "none");
  }
  GroundTruth truth = read_file(file);
  const auto sharp = [](const GroundTruth::Curve& curve) { return curve.sharp; };
  if (!truth.curves.empty() && std::none_of(truth.curves.begin(), truth.curves.end(), sharp)) {
    throw InputError(truth.path, "at least one sharp curve", "none");
  }
  if (folder) undo_world_to_gt(path, &truth);
  return truth;
}

}  // namespace sketchsplat
