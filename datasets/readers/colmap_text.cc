// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "datasets/readers/colmap_files.h"
#include "datasets/readers/frame.h"
#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

/// The lines of a file; fields are separated by blanks.
class TextFile {
 public:
  explicit TextFile(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw InputError(path, "a text file of COLMAP", "nothing to read");
    check_length(&file_, path);
  }

  /// The next line, whatever is on it; false at the end of the file.
  bool next_line() {
    at_ = 0;
    ++number_;
    if (!std::getline(file_, line_)) return false;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    return true;
  }
  /// The next line that is neither empty nor a comment.
  bool next_record() {
    while (next_line()) {
      skip_blanks();
      if (at_ < line_.size() && line_[at_] != '#') return true;
    }
    return false;
  }

  bool at_end() {
    skip_blanks();
    return at_ == line_.size();
  }
  std::string read_word() {
    skip_blanks();
    const size_t begin = at_;
    while (at_ < line_.size() && !is_blank(line_[at_])) ++at_;
    return line_.substr(begin, at_ - begin);
  }
  std::string read_rest() {
    skip_blanks();
    return line_.substr(at_);
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
  double read_number() {
    double value;
    if (!find_number(&value)) complain("a number", read_word());
    return value;
  }
  std::uint32_t read_id() {
    const double value = read_number();
    if (!(value >= 0 && value <= 4294967295.0)) complain("a whole number", std::to_string(value));
    return std::uint32_t(value);
  }
  int read_size() {
    const double value = read_number();
    if (!(value >= 1 && value <= 1 << 20)) complain("a size of pictures", std::to_string(value));
    return int(value);
  }
  [[noreturn]] void complain(const std::string& expected, const std::string& found) const {
    throw InputError(path_, expected + " in line " + std::to_string(number_),
                     found.empty() ? "its end" : "\"" + found.substr(0, 40) + "\"");
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t'; }
  void skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
  }

  std::string path_, line_;
  std::ifstream file_;
  size_t at_ = 0;
  int number_ = 0;
};

Eigen::Vector3d read_vector(TextFile* file) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = file->read_number();
  return v;
}

constexpr std::uint32_t kNoFeature = UINT32_MAX;

// X Y POINT3D_ID, over and over, as far as these are numbers: cameras do not depend on them.
std::vector<Eigen::Vector2d> read_features(TextFile* file) {
  std::vector<Eigen::Vector2d> features;
  Eigen::Vector2d at;
  double point;
  while (file->find_number(&at[0]) && file->find_number(&at[1]) && file->find_number(&point))
    features.push_back(at);
  return features;
}

}  // namespace

// CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]
std::map<std::uint32_t, ColmapCamera> read_cameras_text(const std::string& path) {
  TextFile file(path);
  std::map<std::uint32_t, ColmapCamera> cameras;
  while (file.next_record()) {
    const std::uint32_t id = file.read_id();
    const std::string name = file.read_word();
    const int width = file.read_size(), height = file.read_size();
    const ColmapCameraModel* model = find_camera_model(name);
    if (!model) {
      cameras[id].unknown = name;
      continue;
    }
    std::vector<double> parameters;
    while (int(parameters.size()) < model->parameters) parameters.push_back(file.read_number());
    cameras[id] = make_colmap_camera(*model, {width, height}, parameters);
  }
  return cameras;
}

// IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of points, which may be empty
std::vector<ColmapImage> read_images_text(const std::string& path) {
  TextFile file(path);
  std::vector<ColmapImage> images;
  while (file.next_record()) {
    ColmapImage image;
    image.id = file.read_id();
    Eigen::Vector4d q;
    for (int i = 0; i < 4; ++i) q[i] = file.read_number();
    image.cam_from_world = make_colmap_pose(q, read_vector(&file));
    image.camera = file.read_id();
    image.name = file.read_rest();
    if (image.name.empty()) file.complain("the name of an image", "");
    images.push_back(image);
    check_frame_count(path, images.size());
    if (file.next_line()) images.back().features = read_features(&file);
  }
  return images;
}

// POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX
std::vector<ColmapPoint> read_points_text(const std::string& path) {
  TextFile file(path);
  std::vector<ColmapPoint> points;
  while (file.next_record()) {
    ColmapPoint point;
    file.read_number();
    point.position = read_vector(&file);
    for (int i = 0; i < 4; ++i) file.read_number();  // colour, error
    while (!file.at_end()) {
      const std::uint32_t image = file.read_id();
      const double feature = file.read_number();
      const bool known = feature >= 0 && feature < kNoFeature;
      point.track.push_back({image, known ? std::uint32_t(feature) : kNoFeature});
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace sketchsplat
