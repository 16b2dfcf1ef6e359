// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "datasets/readers/scene.h"

namespace sketchsplat::test {

/// A model of COLMAP, to be written as its versions write it.
struct ColmapFiles {
  struct Camera {
    std::uint32_t id;
    std::string model;
    int model_id;
    int width, height;
    std::vector<double> parameters;
  };
  struct Image {
    std::uint32_t id;
    std::vector<double> q, t;  ///< w x y z; x y z
    std::uint32_t camera;
    std::string name;
    std::vector<std::pair<double, double>> points = {};
  };
  struct Point {
    std::uint64_t id;
    std::vector<double> position;
    std::vector<std::uint32_t> images;
  };
  std::vector<Camera> cameras;
  std::vector<Image> images;
  std::vector<Point> points;
};

inline std::string numbers(const std::vector<double>& values) {
  std::ostringstream out;
  out.precision(17);
  for (const double v : values) out << ' ' << v;
  return out.str();
}

inline void write_file(const std::string& path, const std::string& bytes) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string cameras_text(const ColmapFiles& m) {
  std::ostringstream out;
  out << "# Camera list with one line of data per camera:\n"
      << "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  for (const auto& c : m.cameras)
    out << c.id << ' ' << c.model << ' ' << c.width << ' ' << c.height << numbers(c.parameters)
        << '\n';
  return out.str();
}

inline std::string images_text(const ColmapFiles& m) {
  std::ostringstream out;
  out << "# Image list with two lines of data per image:\n";
  for (const auto& i : m.images) {
    out << i.id << numbers(i.q) << numbers(i.t) << ' ' << i.camera << ' ' << i.name << '\n';
    for (size_t k = 0; k < i.points.size(); ++k)
      out << (k ? " " : "") << i.points[k].first << ' ' << i.points[k].second << " -1";
    out << '\n';
  }
  return out.str();
}

inline std::string points_text(const ColmapFiles& m) {
  std::ostringstream out;
  out << "# 3D point list\n";
  for (const auto& p : m.points) {
    out << p.id << numbers(p.position) << " 128 64 0 0.5";
    for (const std::uint32_t image : p.images) out << ' ' << image << " 0";
    out << '\n';
  }
  return out.str();
}

template <typename T>
void put(T value, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline std::string cameras_binary(const ColmapFiles& m) {
  std::string out;
  put(std::uint64_t(m.cameras.size()), &out);
  for (const auto& c : m.cameras) {
    put(c.id, &out);
    put(std::int32_t(c.model_id), &out);
    put(std::uint64_t(c.width), &out);
    put(std::uint64_t(c.height), &out);
    for (const double p : c.parameters) put(p, &out);
  }
  return out;
}

inline std::string images_binary(const ColmapFiles& m) {
  std::string out;
  put(std::uint64_t(m.images.size()), &out);
  for (const auto& i : m.images) {
    put(i.id, &out);
    for (const double v : i.q) put(v, &out);
    for (const double v : i.t) put(v, &out);
    put(i.camera, &out);
    out += i.name + '\0';
    put(std::uint64_t(i.points.size()), &out);
    for (const auto& [x, y] : i.points) {
      put(x, &out);
      put(y, &out);
      put(std::int64_t(-1), &out);
    }
  }
  return out;
}

inline std::string points_binary(const ColmapFiles& m) {
  std::string out;
  put(std::uint64_t(m.points.size()), &out);
  for (const auto& p : m.points) {
    put(p.id, &out);
    for (const double v : p.position) put(v, &out);
    out += std::string("\x80\x40\0", 3);
    put(0.5, &out);
    put(std::uint64_t(p.images.size()), &out);
    for (const std::uint32_t image : p.images) {
      put(image, &out);
      put(std::uint32_t(0), &out);
    }
  }
  return out;
}

inline void write_colmap_text(const ColmapFiles& m, const std::string& folder) {
  write_file(folder + "/cameras.txt", cameras_text(m));
  write_file(folder + "/images.txt", images_text(m));
  write_file(folder + "/points3D.txt", points_text(m));
}

inline void write_colmap_binary(const ColmapFiles& m, const std::string& folder) {
  write_file(folder + "/cameras.bin", cameras_binary(m));
  write_file(folder + "/images.bin", images_binary(m));
  write_file(folder + "/points3D.bin", points_binary(m));
}

/// The views of a scene as a model, a camera each; names are those of their images' files. `terms`
/// are k1 k2 p1 p2 of a lens that all have; without them cameras are PINHOLE.
inline ColmapFiles colmap_of(const Scene& scene, const std::vector<double>& terms = {}) {
  ColmapFiles m;
  for (const View& v : scene.views) {
    const std::uint32_t id = std::uint32_t(m.images.size() + 1);
    const Camera& c = v.camera;
    std::vector<double> parameters = {c.fx, c.fy, c.cx + 0.5, c.cy + 0.5};
    parameters.insert(parameters.end(), terms.begin(), terms.end());
    m.cameras.push_back({id, terms.empty() ? "PINHOLE" : "OPENCV", terms.empty() ? 1 : 4, c.width,
                         c.height, parameters});
    const Eigen::Quaterniond q(v.cam_from_world.rotation);
    const Eigen::Vector3d& t = v.cam_from_world.translation;
    m.images.push_back({id,
                        {q.w(), q.x(), q.y(), q.z()},
                        {t.x(), t.y(), t.z()},
                        id,
                        std::filesystem::path(v.image_path).filename().string()});
  }
  return m;
}

}  // namespace sketchsplat::test
