// SPDX-License-Identifier: MIT
// Real scenes: the box around the mask of every view against the box around the projected ground
// truth. The object was scaled so that its longest side is 1 and its centre (0.5, 0.5, 0.5).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/readers/scene.h"
#include "datasets/types/errors.h"
#include "tests/datasets/temp_folder.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  return fs::path(SKETCHSPLAT_SOURCE_DIR) / ".." / "shared" / "data" / "abc-nef";
}

/// The only file in the folder whose name ends so.
fs::path file_ending(const fs::path& folder, const std::string& end) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > end.size() && name.substr(name.size() - end.size()) == end)
      return entry.path();
  }
  return {};
}

std::vector<Eigen::Vector3d> vertices_of_obj(const fs::path& path) {
  std::ifstream in(path);
  std::vector<Eigen::Vector3d> points;
  for (std::string line; std::getline(in, line);) {
    if (line.compare(0, 2, "v ") != 0) continue;
    Eigen::Vector3d p;
    std::istringstream(line.substr(2)) >> p.x() >> p.y() >> p.z();
    points.push_back(p);
  }
  return points;
}

/// Binary PLY, of the object as it was rendered, whose vertices are three doubles and three bytes.
std::vector<Eigen::Vector3d> vertices_of_ply(const fs::path& path) {
  const std::string bytes = bytes_of(path.string()), end = "end_header\n";
  std::vector<Eigen::Vector3d> points;
  for (size_t at = bytes.find(end) + end.size(); at + 27 <= bytes.size(); at += 27) {
    points.emplace_back();
    std::memcpy(points.back().data(), bytes.data() + at, 24);
  }
  return points;
}

std::vector<Eigen::Vector3d> normalised(std::vector<Eigen::Vector3d> points,
                                        const std::string& model) {
  std::ifstream in(data_folder() / "chunk_0000_stats.json");
  const std::vector<double> box = nlohmann::json::parse(in)[model]["bbox"];
  const Eigen::Vector3d min(box[0], box[1], box[2]), max(box[3], box[4], box[5]);
  for (Eigen::Vector3d& p : points) {
    p = (p - 0.5 * (min + max)) / (max - min).maxCoeff() + Eigen::Vector3d(0.5, 0.5, 0.5);
  }
  return points;
}

/// Mean over all views that can be read of (middle of the mask) - (middle of the projection) [px].
Eigen::Vector2d mean_offset(const Scene& scene, const std::vector<Eigen::Vector3d>& points,
                            std::vector<std::string>* broken) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const View& view : scene.views) {
    Picture picture;
    try {
      picture = read_picture(view);
    } catch (const InputError&) {
      broken->push_back(view.name);
      continue;
    }
    Eigen::AlignedBox2d seen, projected;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        if (picture.alpha.at(x, y) >= 0.5f) seen.extend(Eigen::Vector2d(x, y));
      }
    }
    double depth = 0;
    for (const Eigen::Vector3d& p : points) projected.extend(view.project(p, &depth));
    EXPECT_LT((seen.min() - projected.min()).cwiseAbs().maxCoeff(), 2) << view.name;
    EXPECT_LT((seen.max() - projected.max()).cwiseAbs().maxCoeff(), 2) << view.name;
    sum += seen.center() - projected.center();
  }
  return sum / double(scene.views.size() - broken->size());
}

void expect_centred(const Eigen::Vector2d& offset) {
  std::printf("mean offset (%.4f, %.4f) px\n", offset.x(), offset.y());
  EXPECT_LT(std::abs(offset.x()), 0.1);
  EXPECT_LT(std::abs(offset.y()), 0.1);
}

TEST(Silhouette, OfANefSceneIsThatOfItsMesh) {
  const fs::path folder = data_folder() / "00000952";
  if (!fs::exists(folder)) GTEST_SKIP() << "the scene abc-nef/00000952 is not here";
  const Scene scene = open_scene(folder.string());
  EXPECT_EQ(scene.format, "nerf");
  ASSERT_EQ(scene.views.size(), 50u);
  std::vector<std::string> broken;
  const auto points = vertices_of_obj(file_ending(folder / "gt", ".obj"));
  expect_centred(mean_offset(scene, normalised(points, "00000952"), &broken));
  EXPECT_TRUE(broken.empty());
  EXPECT_NE(edge_map_path(scene, scene.views[0], "PiDiNet"), "");
}

TEST(Silhouette, OfAnAbcNefSceneIsThatOfItsEdgesAndTheTruncatedFrameIsFound) {
  const fs::path folder = data_folder() / "00004926";
  if (!fs::exists(folder)) GTEST_SKIP() << "the scene abc-nef/00004926 is not here";
  const Scene scene = open_scene(folder.string());
  EXPECT_EQ(scene.format, "abc-nef");
  ASSERT_EQ(scene.views.size(), 50u);
  std::vector<std::string> broken;
  const auto points = vertices_of_ply(file_ending(folder / "gt", ".ply"));
  expect_centred(mean_offset(scene, points, &broken));
  EXPECT_EQ(broken, std::vector<std::string>{"21_colors.png"});
  EXPECT_NE(edge_map_path(scene, scene.views[0], "dexined"), "");
  EXPECT_NE(edge_map_path(scene, scene.views[0], "PiDiNet"), "");
}

}  // namespace
}  // namespace sketchsplat
