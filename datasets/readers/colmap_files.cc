// SPDX-License-Identifier: MIT
// COLMAP's cameras, images and points3D as text and as binary files: the same records, of which
// TextFile and BinaryFile read the fields (COLMAP's doc/format.rst).
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "datasets/readers/colmap_model.h"
#include "datasets/readers/frame.h"
#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

constexpr std::uint32_t kNoFeature = UINT32_MAX;
constexpr std::uint64_t kMostPixelsOfASide = 1 << 20;

/// Lines of fields that are separated by blanks; empty lines and comments are no records.
class TextFile {
 public:
  TextFile(const std::string& path, const std::string&, std::uint64_t) : path_(path), file_(path) {
    if (!file_) throw InputError(path, "a text file of COLMAP", "nothing to read");
    check_length(&file_, path);
  }

  bool next() {
    while (next_line()) {
      skip_blanks();
      if (at_ < line_.size() && line_[at_] != '#') return true;
    }
    return false;
  }
  double number() {
    double value;
    if (!find_number(&value)) complain("a number", word());
    return value;
  }
  std::uint32_t id() {
    const double value = number();
    if (!(value >= 0 && value <= 4294967295.0)) complain("a whole number", std::to_string(value));
    return std::uint32_t(value);
  }
  int side() {
    const double value = number();
    if (!(value >= 1 && value <= double(kMostPixelsOfASide)))
      complain("a size of pictures", std::to_string(value));
    return int(value);
  }
  /// Null, and its name, if there is no such model.
  const ColmapCameraModel* model(std::string* name) {
    *name = word();
    return find_camera_model(*name);
  }
  std::string name() {
    skip_blanks();
    if (at_ == line_.size()) complain("the name of an image", "");
    return line_.substr(at_);
  }
  /// X Y POINT3D_ID, over and over, on a line of their own, as far as these are numbers: cameras do
  /// not depend on them.
  std::vector<Eigen::Vector2d> features() {
    std::vector<Eigen::Vector2d> features;
    Eigen::Vector2d at;
    double point;
    next_line();
    while (find_number(&at[0]) && find_number(&at[1]) && find_number(&point))
      features.push_back(at);
    return features;
  }
  void skip_point_id() { number(); }
  void skip_colour_and_error() {
    for (int i = 0; i < 4; ++i) number();
  }
  std::vector<ColmapPoint::Element> track() {
    std::vector<ColmapPoint::Element> track;
    for (skip_blanks(); at_ < line_.size(); skip_blanks()) {
      const std::uint32_t image = id();
      const double feature = number();
      const bool known = feature >= 0 && feature < kNoFeature;
      track.push_back({image, known ? std::uint32_t(feature) : kNoFeature});
    }
    return track;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t'; }
  void skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
  }
  bool next_line() {
    at_ = 0;
    ++number_;
    line_.clear();
    if (!std::getline(file_, line_)) return false;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    return true;
  }
  std::string word() {
    skip_blanks();
    const size_t begin = at_;
    while (at_ < line_.size() && !is_blank(line_[at_])) ++at_;
    return line_.substr(begin, at_ - begin);
  }
  /// False, and nothing read, if no number comes next.
  bool find_number(double* value) {
    skip_blanks();
    const char* const begin = line_.c_str() + at_;
    char* end = nullptr;
    *value = std::strtod(begin, &end);
    if (end == begin || !(is_blank(*end) || *end == '\0')) return false;
    at_ += size_t(end - begin);
    return true;
  }
  [[noreturn]] void complain(const std::string& expected, const std::string& found) const {
    throw InputError(path_, expected + " in line " + std::to_string(number_),
                     found.empty() ? "its end" : "\"" + found.substr(0, 40) + "\"");
  }

  std::string path_, line_;
  std::ifstream file_;
  size_t at_ = 0;
  int number_ = 0;  // of the line
};

/// A count, and so many records of little-endian numbers, `least_bytes` and more each; never reads,
/// and never makes anybody allocate, more than the file holds.
class BinaryFile {
 public:
  BinaryFile(const std::string& path, const std::string& what, std::uint64_t least_bytes)
      : path_(path), what_(what), file_(path, std::ios::binary) {
    if (!file_ || std::filesystem::is_directory(path))
      throw InputError(path, what, "nothing to read");
    check_length(&file_, path);
    left_ = std::filesystem::file_size(path);
    records_ = count(least_bytes);
  }

  std::uint64_t records() const { return records_; }
  bool next() { return records_ > 0 && records_-- > 0; }
  double number() { return read<double>(); }
  std::uint32_t id() { return read<std::uint32_t>(); }
  int side() {
    const auto value = read<std::uint64_t>();
    if (value < 1 || value > kMostPixelsOfASide)
      throw InputError(path_, "a size of pictures", std::to_string(value));
    return int(value);
  }
  const ColmapCameraModel* model(std::string*) {
    const auto id = read<std::int32_t>();
    const ColmapCameraModel* model = find_camera_model(id);
    if (!model)
      throw InputError(path_,
                       "a camera model that is known (colmap image_undistorter makes pinholes)",
                       "number " + std::to_string(id));
    return model;
  }
  std::string name() {
    std::string text;
    for (char c; (c = read<char>());) text += c;
    return text;
  }
  std::vector<Eigen::Vector2d> features() {
    const auto numbers = read<double>(3 * count(2 * 8 + 8));
    std::vector<Eigen::Vector2d> features;
    for (size_t i = 0; i < numbers.size(); i += 3)  // the third is the point's id
      features.emplace_back(numbers[i], numbers[i + 1]);
    return features;
  }
  void skip_point_id() { skip(8); }
  void skip_colour_and_error() { skip(3 + 8); }
  std::vector<ColmapPoint::Element> track() {
    const auto numbers = read<std::uint32_t>(2 * count(8));  // image, feature, image, ...
    std::vector<ColmapPoint::Element> track;
    for (size_t i = 0; i < numbers.size(); i += 2) track.push_back({numbers[i], numbers[i + 1]});
    return track;
  }

 private:
  template <typename T>
  std::vector<T> read(size_t count) {
    std::vector<T> values(count);
    take(count * sizeof(T));
    if (!file_.read(reinterpret_cast<char*>(values.data()), std::streamsize(count * sizeof(T))))
      end();
    return values;
  }
  template <typename T>
  T read() {
    T value;
    take(sizeof value);
    if (!file_.read(reinterpret_cast<char*>(&value), sizeof value)) end();
    return value;
  }
  void skip(std::uint64_t bytes) {
    take(bytes);
    file_.ignore(std::streamsize(bytes));
  }
  void take(std::uint64_t bytes) {
    if (bytes > left_) end();
    left_ -= bytes;
  }
  std::uint64_t count(std::uint64_t least_bytes) {
    const auto count = read<std::uint64_t>();
    if (count > left_ / least_bytes)
      throw InputError(
          path_, what_,
          "a count of " + std::to_string(count) + " with " + std::to_string(left_) + " bytes left");
    return count;
  }
  [[noreturn]] void end() const { throw InputError(path_, what_, "the end of the file"); }

  std::string path_, what_;
  std::ifstream file_;
  std::uint64_t left_ = 0, records_ = 0;
};

template <class File>
Eigen::Vector3d read_vector(File* file) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = file->number();
  return v;
}

// CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]
template <class File>
std::map<std::uint32_t, ColmapCamera> read_cameras(File file) {
  std::map<std::uint32_t, ColmapCamera> cameras;
  while (file.next()) {
    ColmapCamera& camera = cameras[file.id()];
    const ColmapCameraModel* model = file.model(&camera.unknown);
    const int width = file.side(), height = file.side();
    if (!model) continue;
    std::vector<double> parameters;
    while (int(parameters.size()) < model->parameters) parameters.push_back(file.number());
    camera = make_colmap_camera(*model, {width, height}, parameters);
  }
  return cameras;
}

// IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME POINTS2D[]
template <class File>
std::vector<ColmapImage> read_images(File file, const std::string& path) {
  std::vector<ColmapImage> images;
  while (file.next()) {
    images.emplace_back();
    check_frame_count(path, images.size());
    ColmapImage& image = images.back();
    image.id = file.id();
    Eigen::Vector4d q;
    for (int i = 0; i < 4; ++i) q[i] = file.number();
    image.cam_from_world = make_colmap_pose(q, read_vector(&file));
    image.camera = file.id();
    image.name = file.name();
    image.features = file.features();
  }
  return images;
}

// POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX
template <class File>
std::vector<ColmapPoint> read_points(File file) {
  std::vector<ColmapPoint> points;
  while (file.next()) {
    points.emplace_back();
    file.skip_point_id();
    points.back().position = read_vector(&file);
    file.skip_colour_and_error();
    points.back().track = file.track();
  }
  return points;
}

constexpr char kCameras[] = "whole cameras of COLMAP", kImages[] = "whole images of COLMAP",
               kPoints[] = "whole points of COLMAP";
constexpr std::uint64_t kLeastCamera = 4 + 4 + 2 * 8 + 3 * 8, kLeastImage = 4 + 7 * 8 + 4 + 1 + 8,
                        kLeastPoint = 8 + 3 * 8 + 3 + 8 + 8;

std::string file_of(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

bool is_file(const std::string& folder, const std::string& name) {
  std::error_code none;
  return std::filesystem::is_regular_file(file_of(folder, name), none);
}

bool is_whole(const std::string& folder, const std::string& ending) {
  return is_file(folder, "cameras" + ending) && is_file(folder, "images" + ending);
}

template <class File>
void read_cameras_and_images(const std::string& folder, const std::string& ending,
                             ColmapModel* model) {
  model->images_path = file_of(folder, "images" + ending);
  model->cameras = read_cameras(File(file_of(folder, "cameras" + ending), kCameras, kLeastCamera));
  model->images = read_images(File(model->images_path, kImages, kLeastImage), model->images_path);
}

}  // namespace

bool has_colmap_model(const std::string& folder) {
  return is_whole(folder, ".bin") || is_whole(folder, ".txt");
}

std::uint64_t count_colmap_images(const std::string& folder) {
  if (is_whole(folder, ".bin"))
    return BinaryFile(file_of(folder, "images.bin"), kImages, kLeastImage).records();
  const std::string path = file_of(folder, "images.txt");
  return read_images(TextFile(path, kImages, kLeastImage), path).size();
}

ColmapModel read_colmap_model(const std::string& folder) {
  ColmapModel model;
  if (is_whole(folder, ".bin"))
    read_cameras_and_images<BinaryFile>(folder, ".bin", &model);
  else
    read_cameras_and_images<TextFile>(folder, ".txt", &model);
  if (is_file(folder, "points3D.bin"))
    model.points = read_points(BinaryFile(file_of(folder, "points3D.bin"), kPoints, kLeastPoint));
  else if (is_file(folder, "points3D.txt"))
    model.points = read_points(TextFile(file_of(folder, "points3D.txt"), kPoints, kLeastPoint));
  std::stable_sort(model.images.begin(), model.images.end(),
                   [](const ColmapImage& a, const ColmapImage& b) { return a.id < b.id; });
  return model;
}

}  // namespace sketchsplat
