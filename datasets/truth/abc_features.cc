// SPDX-License-Identifier: MIT
#include "datasets/truth/abc_features.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "datasets/types/errors.h"
#include "sketches/io/json.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

struct RawCurve {
  std::string type;
  bool sharp = false;
  std::vector<int> vertices;
  YAML::Node node;
};

std::string read_text(const std::string& path, const std::string& what) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, what, "nothing that can be opened");
  return read_whole(&in, path, kMostFileBytes);
}

// The part of the file below the top-level key `curves`. The surfaces are 20 to 50 times as long
// and of no use here; block-style top-level keys are the lines that begin with a letter.
std::string curves_block(const std::string& text) {
  size_t begin = text.compare(0, 7, "curves:") == 0 ? 0 : text.find("\ncurves:");
  if (begin == std::string::npos) return text;
  for (size_t at = text.find('\n', begin + 1); at != std::string::npos && at + 1 < text.size();
       at = text.find('\n', at + 1)) {
    if (std::isalpha(static_cast<unsigned char>(text[at + 1]))) {
      return text.substr(begin, at + 1 - begin);
    }
  }
  return text.substr(begin);
}

std::vector<RawCurve> read_curves(const std::string& path) {
  const std::string text = read_text(path, "an ABC features file");
  std::vector<RawCurve> curves;
  try {
    const YAML::Node list = YAML::Load(curves_block(text))["curves"];
    if (!list.IsSequence()) throw InputError(path, "a list \"curves\"", "none");
    for (const YAML::Node& node : list) {
      RawCurve curve;
      curve.type = node["type"].as<std::string>();
      for (char& c : curve.type) c = char(std::tolower(static_cast<unsigned char>(c)));
      curve.sharp = node["sharp"].as<bool>();
      curve.vertices = node["vert_indices"].as<std::vector<int>>();
      curve.node = node;
      curves.push_back(std::move(curve));
    }
  } catch (const YAML::Exception& e) {
    throw InputError(path, "curves with type, sharp and vert_indices", e.what());
  }
  return curves;
}

std::map<int, Eigen::Vector3d> obj_vertices(const std::string& path) {
  const std::string text = read_text(path, "an OBJ file");
  std::map<int, Eigen::Vector3d> vertices;
  size_t at = 0;
  while (at < text.size()) {
    size_t end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    if (end - at > 2 && text[at] == 'v' && text[at + 1] == ' ') {
      Eigen::Vector3d p;
      const char* c = text.data() + at + 2;
      const char* stop = text.data() + end;
      for (int k = 0; k < 3; ++k) {
        while (c < stop && *c == ' ') ++c;
        const auto read = std::from_chars(c, stop, p[k]);
        if (read.ec != std::errc() || !std::isfinite(p[k])) {
          throw InputError(path, "three numbers after v",
                           text.substr(at, std::min<size_t>(end - at, 60)));
        }
        c = read.ptr;
      }
      vertices.emplace_hint(vertices.end(), int(vertices.size()), p);
    }
    at = end + 1;
  }
  return vertices;
}

Eigen::Vector3d vector_of(const YAML::Node& node) {
  const auto v = node.as<std::vector<double>>();
  if (v.size() != 3) throw YAML::Exception(node.Mark(), "not three numbers");
  return {v[0], v[1], v[2]};
}

// Angles of a circle's vertices. Released files carry them in thousandths of a radian, except the
// last one, which is left as it should be.
std::vector<double> circle_angles(const std::vector<double>& t) {
  const size_t n = t.size();
  double largest = 0;
  for (size_t i = n > 2 ? 1 : 0; i < (n > 2 ? n - 1 : n); ++i) {
    largest = std::max(largest, std::abs(t[i]));
  }
  if (!(largest > 2 * M_PI + 1e-6)) return t;
  std::vector<double> angle(t);
  for (double& a : angle) a /= 1000.0;
  if (n > 1 && std::abs(t[n - 1]) <= 2 * M_PI && std::abs(t[n - 1] - angle[n - 2]) < 1.0) {
    angle[n - 1] = t[n - 1];
  }
  return angle;
}

// Vertices on lines, then on circles; the first curve that gives a vertex wins.
std::map<int, Eigen::Vector3d> vertices_from_parameters(const std::vector<RawCurve>& curves) {
  std::map<int, Eigen::Vector3d> vertices;
  for (const bool lines : {true, false}) {
    for (const RawCurve& curve : curves) {
      if (curve.type != (lines ? "line" : "circle")) continue;
      auto t = curve.node["vert_parameters"].as<std::vector<double>>();
      if (!lines) t = circle_angles(t);
      const Eigen::Vector3d location = vector_of(curve.node["location"]);
      const size_t n = std::min(t.size(), curve.vertices.size());
      if (lines) {
        const Eigen::Vector3d direction = vector_of(curve.node["direction"]);
        for (size_t i = 0; i < n; ++i) {
          vertices.emplace(curve.vertices[i], location + t[i] * direction);
        }
      } else {
        const Eigen::Vector3d x = vector_of(curve.node["x_axis"]);
        const Eigen::Vector3d y = vector_of(curve.node["y_axis"]);
        const double radius = curve.node["radius"].as<double>();
        for (size_t i = 0; i < n; ++i) {
          vertices.emplace(curve.vertices[i],
                           location + radius * (std::cos(t[i]) * x + std::sin(t[i]) * y));
        }
      }
    }
  }
  return vertices;
}

void set_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double longest,
             const std::string& path, AbcModel* model) {
  if (!(longest > 0) || !std::isfinite(longest)) {
    throw InputError(path, "a box with a longest side above 0", std::to_string(longest));
  }
  model->scale = 1.0 / longest;
  model->offset = Eigen::Vector3d::Constant(0.5) - (low + high) / 2 * model->scale;
}

void box_from_stats(const std::string& path, const std::string& id, AbcModel* model) {
  try {
    const auto stats = parse_json<nlohmann::json>(read_text(path, "ABC statistics"), path);
    const auto box = stats.at(id).at("bbox").get<std::vector<double>>();
    if (box.size() < 9) throw InputError(path, "bbox of 9 numbers", std::to_string(box.size()));
    set_box({box[0], box[1], box[2]}, {box[3], box[4], box[5]}, std::max({box[6], box[7], box[8]}),
            path, model);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(path, "bbox of model " + id, e.what());
  }
}

void box_from_vertices(const std::map<int, Eigen::Vector3d>& vertices, const std::string& path,
                       AbcModel* model) {
  if (vertices.empty()) throw InputError(path, "vertices", "none");
  Eigen::Vector3d low = vertices.begin()->second, high = low;
  for (const auto& [index, p] : vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  set_box(low, high, (high - low).maxCoeff(), path, model);
}

}  // namespace

AbcModel read_abc_model(const std::string& features, const std::string& obj,
                        const std::string& stats, const std::string& id) {
  const std::vector<RawCurve> curves = read_curves(features);
  std::map<int, Eigen::Vector3d> vertices;
  try {
    vertices = obj.empty() ? vertices_from_parameters(curves) : obj_vertices(obj);
  } catch (const YAML::Exception& e) {
    throw InputError(features, "parameters of lines and circles (there is no OBJ)", e.what());
  }
  AbcModel model;
  for (const RawCurve& raw : curves) {
    AbcModel::Curve curve{raw.type, raw.sharp, Eigen::Matrix3Xd(3, raw.vertices.size())};
    bool known = true;
    for (size_t i = 0; i < raw.vertices.size() && known; ++i) {
      const auto found = vertices.find(raw.vertices[i]);
      known = found != vertices.end();
      if (known) curve.polyline.col(i) = found->second;
    }
    if (known) {
      model.curves.push_back(std::move(curve));
    } else if (raw.sharp) {
      throw InputError(features, "every vertex of a sharp " + raw.type,
                       obj.empty() ? "no OBJ and no parameters that give it"
                                   : "an index beyond the vertices of " + obj);
    }
  }
  if (!stats.empty()) {
    box_from_stats(stats, id, &model);
  } else if (!obj.empty()) {
    box_from_vertices(vertices, obj, &model);
  } else {
    throw InputError(features, "chunk_*_stats.json or an OBJ for the box of the model", "neither");
  }
  return model;
}

}  // namespace sketchsplat
