// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "datasets/readers/colmap_files.h"
#include "datasets/readers/frame.h"
#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

/// Little-endian numbers one after another; never reads, and never makes anybody allocate, more
/// than the file holds.
class BinaryFile {
 public:
  BinaryFile(const std::string& path, const std::string& what)
      : path_(path), what_(what), file_(path, std::ios::binary | std::ios::ate) {
    if (!file_ || std::filesystem::is_directory(path))
      throw InputError(path, what, "nothing to read");
    file_.seekg(0);
    check_length(&file_, path);
    file_.seekg(0, std::ios::end);
    left_ = std::uint64_t(file_.tellg());
    file_.seekg(0);
  }

  template <typename T>
  T read() {
    T value;
    take(sizeof value);
    if (!file_.read(reinterpret_cast<char*>(&value), sizeof value)) end();
    return value;
  }
  template <typename T>
  std::vector<T> read(size_t count) {
    std::vector<T> values(count);
    take(count * sizeof(T));
    if (!file_.read(reinterpret_cast<char*>(values.data()), std::streamsize(count * sizeof(T))))
      end();
    return values;
  }
  std::string read_text() {
    std::string text;
    for (char c; (c = read<char>());) text += c;
    return text;
  }
  void skip(std::uint64_t bytes) {
    take(bytes);
    file_.seekg(std::streamoff(bytes), std::ios::cur);
  }
  /// A count of things of at least so many bytes each.
  std::uint64_t read_count(std::uint64_t least_bytes) {
    const auto count = read<std::uint64_t>();
    if (count > left_ / least_bytes)
      throw InputError(
          path_, what_,
          "a count of " + std::to_string(count) + " with " + std::to_string(left_) + " bytes left");
    return count;
  }
  [[noreturn]] void complain(const std::string& expected, const std::string& found) const {
    throw InputError(path_, expected, found);
  }

 private:
  void take(std::uint64_t bytes) {
    if (bytes > left_) end();
    left_ -= bytes;
  }
  [[noreturn]] void end() const { throw InputError(path_, what_, "the end of the file"); }

  std::string path_, what_;
  std::ifstream file_;
  std::uint64_t left_ = 0;
};

Eigen::Vector3d read_vector(BinaryFile* file) {
  const std::vector<double> v = file->read<double>(3);
  return {v[0], v[1], v[2]};
}

constexpr char kImages[] = "whole images of COLMAP";
constexpr std::uint64_t kLeastImage = 4 + 7 * 8 + 4 + 1 + 8;
constexpr std::uint64_t kPoint2D = 2 * 8 + 8;

}  // namespace

std::map<std::uint32_t, ColmapCamera> read_cameras_binary(const std::string& path) {
  BinaryFile file(path, "whole cameras of COLMAP");
  std::map<std::uint32_t, ColmapCamera> cameras;
  for (auto n = file.read_count(4 + 4 + 2 * 8 + 3 * 8); n > 0; --n) {
    const auto id = file.read<std::uint32_t>();
    const auto model_id = file.read<std::int32_t>();
    const auto width = file.read<std::uint64_t>(), height = file.read<std::uint64_t>();
    const ColmapCameraModel* model = find_camera_model(model_id);
    if (!model)
      file.complain("a camera model that is known (colmap image_undistorter makes pinholes)",
                    "number " + std::to_string(model_id));
    constexpr std::uint64_t kMost = 1 << 20;
    if (width < 1 || height < 1 || width > kMost || height > kMost)
      file.complain("a size of pictures", std::to_string(width) + " x " + std::to_string(height));
    cameras[id] = make_colmap_camera(*model, {int(width), int(height)},
                                     file.read<double>(size_t(model->parameters)));
  }
  return cameras;
}

std::vector<ColmapImage> read_images_binary(const std::string& path) {
  BinaryFile file(path, kImages);
  const std::uint64_t count = file.read_count(kLeastImage);
  check_frame_count(path, count);
  std::vector<ColmapImage> images(count);
  for (ColmapImage& image : images) {
    image.id = file.read<std::uint32_t>();
    const std::vector<double> q = file.read<double>(4);
    const Eigen::Vector3d t = read_vector(&file);
    image.cam_from_world = make_colmap_pose({q[0], q[1], q[2], q[3]}, t);
    image.camera = file.read<std::uint32_t>();
    image.name = file.read_text();
    const auto features = file.read_count(kPoint2D);
    image.features.reserve(features);
    const std::vector<double> numbers = file.read<double>(3 * features);
    for (size_t i = 0; i < numbers.size(); i += 3)  // the third is the point's id
      image.features.emplace_back(numbers[i], numbers[i + 1]);
  }
  return images;
}

std::uint64_t count_images_binary(const std::string& path) {
  return BinaryFile(path, kImages).read_count(kLeastImage);
}

std::vector<ColmapPoint> read_points_binary(const std::string& path) {
  BinaryFile file(path, "whole points of COLMAP");
  std::vector<ColmapPoint> points(file.read_count(8 + 3 * 8 + 3 + 8 + 8));
  for (ColmapPoint& point : points) {
    file.skip(8);  // its id
    point.position = read_vector(&file);
    file.skip(3 + 8);  // colour, error
    const auto length = file.read_count(8);
    const auto track = file.read<std::uint32_t>(2 * length);  // image, index in it, image, ...
    for (size_t i = 0; i < track.size(); i += 2) point.track.push_back({track[i], track[i + 1]});
  }
  return points;
}

}  // namespace sketchsplat
