// SPDX-License-Identifier: MIT
#include "datasets/synthetic/write/write_abc.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "datasets/truth/abc_features.h"
#include "datasets/truth/ground_truth.h"

namespace sketchsplat {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class Abc : public testing::Test {
 protected:
  ~Abc() override { fs::remove_all(folder_); }

  SyntheticScene write(const std::string& part, double extent = 1) {
    SynthesizeOptions options;
    options.part = part;
    options.extent = extent;
    options.deflection = 1e-3;
    options.rig.views = 1;
    options.rig.resolution = 16;
    const SyntheticScene scene = synthesize(options);
    for (const auto& [name, text] : abc_files(scene)) {
      fs::create_directories((folder_ / name).parent_path());
      std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    return scene;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "write_abc_test";
  std::string features_ = (folder_ / "feat/model_features_000.yml").string();
};

TEST_F(Abc, ReaderFindsTheSceneInIt) {
  // Lines, circles, ellipses, arcs of ellipses and free curves; the world's extent must not matter.
  for (const char* part : {"box-hole", "box-fillet", "ellipse-plate", "spline-plate", "boss-plate"})
    for (double extent : {1.0, 40.0}) {
      const SyntheticScene scene = write(part, extent);
      const GroundTruth read = find_ground_truth(folder_.string());
      EXPECT_EQ(read.format, "abc");
      ASSERT_GE(read.curves.size(), scene.truth.curves.size()) << part;
      for (size_t i = 0; i < read.curves.size(); ++i) {
        const bool sharp = i < scene.truth.curves.size();
        EXPECT_EQ(read.curves[i].sharp, sharp) << part;
        if (!sharp) continue;
        const TruthCurve& truth = scene.truth.curves[i];
        std::string type = truth.type;
        for (char& c : type) c = char(std::tolower(c));
        EXPECT_EQ(read.curves[i].type, type) << part;
        EXPECT_EQ(read.curves[i].closed, truth.closed) << part;
        ASSERT_EQ(read.curves[i].polyline.cols(), truth.points.cols()) << part;
        EXPECT_LT((read.curves[i].polyline - truth.points / extent).cwiseAbs().maxCoeff(), 2e-9)
            << part;
      }
    }
}

TEST_F(Abc, SmoothSeamsAreThereAndNotSharp) {
  const SyntheticScene scene = write("box-fillet");
  const AbcModel model =
      read_abc_model(features_, (folder_ / "obj/model_trimesh_000.obj").string(), "", "model");
  int smooth = 0;
  for (const AbcModel::Curve& curve : model.curves) smooth += !curve.sharp;
  EXPECT_EQ(smooth, 8);  // two beside each of the four fillets
  EXPECT_EQ(model.curves.size(), scene.truth.curves.size() + 8);
}

TEST_F(Abc, ParametersOfLinesAndCirclesGiveTheirPoints) {
  const SyntheticScene scene = write("box-hole");
  const AbcModel model =
      read_abc_model(features_, "", (folder_ / "chunk_0000_stats.json").string(), "model");
  for (size_t i = 0; i < scene.truth.curves.size(); ++i) {
    const Eigen::Matrix3Xd p = (model.curves[i].polyline * model.scale).colwise() + model.offset;
    EXPECT_LT((p - scene.truth.curves[i].points).cwiseAbs().maxCoeff(), 1e-9);
  }
}

Vector3d vector_of(const YAML::Node& node) {
  const auto v = node.as<std::vector<double>>();
  return {v.at(0), v.at(1), v.at(2)};
}

// Point of a B-spline by de Boor's algorithm.
Vector3d de_boor(const YAML::Node& curve, double t) {
  const auto knots = curve["knots"].as<std::vector<double>>();
  const int degree = curve["degree"].as<int>(), n = int(curve["poles"].size());
  int k = degree;
  while (k + 1 < n && knots[k + 1] <= t) ++k;
  std::vector<Vector3d> d;
  for (int j = 0; j <= degree; ++j) d.push_back(vector_of(curve["poles"][k - degree + j]));
  for (int r = 1; r <= degree; ++r)
    for (int j = degree; j >= r; --j) {
      const double low = knots[k - degree + j], w = (t - low) / (knots[k + 1 + j - r] - low);
      d[j] = (1 - w) * d[j - 1] + w * d[j];
    }
  return d[degree];
}

TEST_F(Abc, ParametersOfEllipsesAndSplinesGiveTheirPoints) {
  for (const char* part : {"ellipse-plate", "spline-plate"}) {
    const SyntheticScene scene = write(part);
    const AbcModel model =
        read_abc_model(features_, (folder_ / "obj/model_trimesh_000.obj").string(), "", "model");
    const YAML::Node curves = YAML::LoadFile(features_)["curves"];
    int tried = 0;
    for (size_t i = 0; i < curves.size(); ++i) {
      const YAML::Node& c = curves[i];
      const std::string type = c["type"].as<std::string>();
      if (type != "Ellipse" && type != "BSpline") continue;
      ++tried;
      const auto t = c["vert_parameters"].as<std::vector<double>>();
      ASSERT_EQ(int(t.size()), model.curves[i].polyline.cols());
      for (size_t j = 0; j < t.size(); ++j) {
        const Vector3d at =
            type == "BSpline"
                ? de_boor(c, t[j])
                : vector_of(c["location"]) +
                      c["x_radius"].as<double>() * std::cos(t[j]) * vector_of(c["x_axis"]) +
                      c["y_radius"].as<double>() * std::sin(t[j]) * vector_of(c["y_axis"]);
        EXPECT_LT((at - model.curves[i].polyline.col(j)).norm() * model.scale, 1.1e-5) << type;
        EXPECT_TRUE(j == 0 || t[j] != t[j - 1]) << type << " " << t[j];
      }
    }
    EXPECT_GE(tried, 2) << part;
  }
}

TEST_F(Abc, MeshesHaveIt) {
  const std::string path = testing::TempDir() + "/write_abc_cube.obj";
  std::ofstream(path) << "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
                         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const SyntheticScene scene = write(path);
  const GroundTruth read = find_ground_truth(folder_.string());
  ASSERT_EQ(read.curves.size(), 12u);
  for (size_t i = 0; i < 12; ++i)
    EXPECT_LT((read.curves[i].polyline - scene.truth.curves[i].points).norm(), 1e-9);
  fs::remove(path);
}

}  // namespace
}  // namespace sketchsplat
