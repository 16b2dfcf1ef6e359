// SPDX-License-Identifier: MIT
#include "eval/metrics/prediction.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/io/ply.h"
#include "datasets/types/errors.h"
#include "eval/metrics/parameters.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/io/io.h"
#include "sketches/io/json.h"
#include "sketches/io/whole_file.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace sketchsplat {
namespace {

constexpr double kLargest = 1e100;  // squares and cubes of it overflow
constexpr char kPlaces[] = "coordinates below 1e100";

// All numbers of nested lists, in order: files differ in how they group coordinates.
void flatten(const json& value, const std::string& path, std::vector<double>* out) {
  if (value.is_array()) {
    for (const json& item : value) flatten(item, path, out);
  } else if (value.is_number()) {
    out->push_back(value.get<double>());
    if (!(std::abs(out->back()) < kLargest)) throw InputError(path, kPlaces, json_text(value));
  } else {
    throw InputError(path, "finite coordinates", json_text(value));
  }
}

template <int N>
std::vector<Eigen::Matrix<double, 3, N>> groups_of(const json& document,
                                                   std::initializer_list<const char*> keys,
                                                   const std::string& path) {
  std::vector<double> numbers;
  for (const char* key : keys) {
    if (!document.contains(key)) continue;
    flatten(document[key], path, &numbers);
    if (numbers.size() % (3 * N) != 0) {
      throw InputError(path, std::to_string(3 * N) + " numbers for each of \"" + key + "\"",
                       std::to_string(numbers.size()) + " in all");
    }
    break;
  }
  std::vector<Eigen::Matrix<double, 3, N>> groups;
  for (size_t i = 0; i < numbers.size(); i += 3 * N) {
    groups.push_back(Eigen::Map<Eigen::Matrix<double, 3, N>>(numbers.data() + i));
  }
  return groups;
}

std::vector<Eigen::Matrix3Xd> strokes_of(const PlyPoints& points) {
  std::map<int, std::vector<Eigen::Index>> members;
  for (size_t i = 0; i < points.stroke.size(); ++i) {
    members[points.stroke[i]].push_back(Eigen::Index(i));
  }
  std::vector<Eigen::Matrix3Xd> strokes;
  for (const auto& [stroke, columns] : members) {
    Eigen::Matrix3Xd samples(3, columns.size());
    for (size_t i = 0; i < columns.size(); ++i) samples.col(i) = points.position.col(columns[i]);
    strokes.push_back(std::move(samples));
  }
  return strokes;
}

Prediction read_points(const std::string& path) {
  const PlyPoints points = read_ply_points(path);
  Prediction prediction;
  prediction.points_only = true;
  prediction.points = points.position;
  prediction.strokes = strokes_of(points);
  return prediction;
}

// Pieces that a stroke is cut into where nothing else tells: it is asked how much of it lies near a
// curve, and of the curve near it, to 5 thousandths of the object. A thousand serve up to 5
// objects.
constexpr double kPieces = 1000;

// Degrees of freedom of a curve of n cubics that go on smoothly from one another: a joint ties its
// place and its tangent.
int chain_freedom(const std::string& kind, size_t n) {
  const int each = degrees_of_freedom(kind);
  return each + int(n - 1) * (each - 5);
}

void add_curve(const Sketch& sketch, const CurveChain& chain, int index, Prediction* prediction) {
  double length = 0;
  for (int s : chain.strokes) {
    length += stroke_length(sketch, s);
    if (sketch.strokes[s].kind == StrokeKind::kLine) {
      const ControlPoints c = control_points(sketch, s);
      prediction->lines.emplace_back();
      prediction->lines.back() << c.p[0], c.p[1];
    } else {
      for (const auto& cubic : to_cubics(sketch, s)) prediction->curves.push_back(cubic);
    }
  }
  prediction->strokes.push_back(sample_chain(sketch, chain, length / kPieces));
  const std::string kind = kind_name(sketch.strokes[chain.strokes[0]].kind);
  prediction->facts.push_back(
      {std::to_string(index), kind, chain_freedom(kind, chain.strokes.size())});
}

// NEF's files hold cubics (or, of its first stage, lines) in cells of a 256^3 grid over
// [-1.2, 1.2]^3, x and y exchanged.
bool is_nef(const json& document) {
  return document.contains("scene_name") && document.contains("curves_ctl_pts") &&
         !document.contains("lines_end_pts");
}

template <typename Points>
void nef_to_world(std::vector<Points>* curves) {
  for (Points& c : *curves) {
    c = (c.array() / 256 * 2.4 - 1.2).matrix().eval();
    c.row(0).swap(c.row(1));
  }
}

void read_nef(const json& document, const std::string& path, Prediction* prediction) {
  const json& curves = document["curves_ctl_pts"];
  const bool lines = curves.is_array() && !curves.empty() && curves[0].size() == 2;
  if (lines) {
    prediction->lines = groups_of<2>(document, {"curves_ctl_pts"}, path);
  } else {
    prediction->curves = groups_of<4>(document, {"curves_ctl_pts"}, path);
  }
  nef_to_world(&prediction->lines);
  nef_to_world(&prediction->curves);
}

Prediction read_json(const std::string& path) {
  std::ifstream in(path);
  Prediction prediction;
  try {
    const json document = parse_json<json>(in, path);
    if (!document.is_object()) throw InputError(path, "a JSON object", "another value");
    if (document.contains("strokes")) {
      in.clear();
      in.seekg(0);
      prediction = prediction_of(read_sketch_json(in, path));
    } else if (document.contains("points")) {
      prediction.points_only = true;
      const auto points = groups_of<1>(document, {"points"}, path);
      prediction.points.resize(3, points.size());
      for (size_t i = 0; i < points.size(); ++i) prediction.points.col(i) = points[i];
    } else if (is_nef(document)) {
      read_nef(document, path, &prediction);
    } else if (document.contains("lines_end_pts") || document.contains("curves_ctl_pts") ||
               document.contains("lines") || document.contains("curves")) {
      prediction.lines = groups_of<2>(document, {"lines", "lines_end_pts"}, path);
      prediction.curves = groups_of<4>(document, {"curves", "curves_ctl_pts"}, path);
    } else {
      throw InputError(path, "lines_end_pts and curves_ctl_pts, points or strokes", "none of them");
    }
  } catch (const json::exception& e) {
    throw InputError(path, "predicted edges as JSON", e.what());
  }
  return prediction;
}

// Vertex of an OBJ index: from 1, or from the end if negative.
int vertex_of(const std::string& word, int count, const std::string& path) {
  int index = 0;
  std::istringstream(word) >> index;
  const int at = index > 0 ? index - 1 : count + index;
  if (index == 0 || at < 0 || at >= count) {
    throw InputError(path, "an index of a vertex above it", word);
  }
  return at;
}

// Points along segments, given as 6 numbers each, kPieces of them in all or somewhat more.
Eigen::Matrix3Xd samples_along(const std::vector<double>& numbers) {
  using Segments = Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic>>;
  const Segments segments(numbers.data(), 6, Eigen::Index(numbers.size() / 6));
  const auto offset = [&](Eigen::Index k) -> Eigen::Vector3d {
    return segments.col(k).tail<3>() - segments.col(k).head<3>();
  };
  double length = 0;
  for (Eigen::Index k = 0; k < segments.cols(); ++k) length += offset(k).norm();
  std::vector<double> out;
  for (Eigen::Index k = 0; k < segments.cols(); ++k) {
    const int pieces =
        length > 0 ? std::max(1, int(std::ceil(kPieces * offset(k).norm() / length))) : 1;
    for (int i = 0; i <= pieces; ++i) {
      const Eigen::Vector3d p = segments.col(k).head<3>() + offset(k) * (double(i) / pieces);
      out.insert(out.end(), p.data(), p.data() + 3);
    }
  }
  return Eigen::Map<Eigen::Matrix3Xd>(out.data(), 3, Eigen::Index(out.size() / 3));
}

Prediction read_obj(const std::string& path) {
  std::ifstream in(path);
  check_length(&in, path);
  Prediction prediction;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<double>> strokes;
  std::vector<std::string> names;
  std::string name;
  bool grouped = false, begins = true;
  for (std::string text; std::getline(in, text);) {
    std::istringstream line(text);
    std::string key, word;
    line >> key;
    if (key == "v") {
      Eigen::Vector3d p;
      if (!(line >> p[0] >> p[1] >> p[2])) throw InputError(path, "three numbers after v", text);
      if (!(p.cwiseAbs().maxCoeff() < kLargest)) throw InputError(path, kPlaces, text);
      vertices.push_back(p);
    } else if (key == "o") {
      grouped = begins = true;
      std::getline(line >> std::ws, name);
    } else if (key == "l") {
      if (begins || !grouped) {
        strokes.emplace_back();
        names.push_back(name.empty() ? std::to_string(names.size()) : name);
      }
      begins = false;
      for (int last = -1; line >> word;) {
        const int at = vertex_of(word, int(vertices.size()), path);
        if (last >= 0) {
          for (int v : {last, at}) {
            strokes.back().insert(strokes.back().end(), vertices[v].data(), vertices[v].data() + 3);
          }
          prediction.lines.emplace_back();
          prediction.lines.back() << vertices[last], vertices[at];
        }
        last = at;
      }
    }
  }
  for (size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i].empty()) continue;
    prediction.strokes.push_back(samples_along(strokes[i]));
    const int segments = int(strokes[i].size() / 6);
    prediction.facts.push_back({names[i], segments == 1 ? "line" : "polyline",
                                degrees_of_freedom_of_polyline(segments + 1)});
  }
  return prediction;
}

// Empty if the folder holds none.
std::string file_of(const std::string& folder) {
  for (const char* name : {"parametric_edges.json", "fitting/parametric_edges.json",
                           "gaussians_all.ply", "edge_points.ply", "sketch.json", "sketch.obj"}) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file)) return file.string();
  }
  return "";
}

// parametric_edges.json cuts arcs into cubics; the files beside it tell what belongs together.
void read_strokes_beside(const fs::path& folder, Prediction* prediction) {
  const fs::path sketch = folder / "sketch.json", points = folder / "edge_points.ply";
  if (fs::is_regular_file(sketch)) {
    Prediction whole = read_json(sketch.string());
    prediction->strokes = std::move(whole.strokes);
    prediction->facts = std::move(whole.facts);
  } else if (fs::is_regular_file(points)) {
    prediction->strokes = strokes_of(read_ply_points(points.string()));
  }
}

}  // namespace

Prediction prediction_of(const Sketch& sketch) {
  Prediction prediction;
  const std::vector<CurveChain> chains = curve_chains(sketch);
  for (size_t c = 0; c < chains.size(); ++c) add_curve(sketch, chains[c], int(c), &prediction);
  return prediction;
}

bool has_prediction(const std::string& path) {
  std::error_code none;
  return fs::is_directory(path, none) ? !file_of(path).empty() : fs::exists(path, none);
}

Prediction read_prediction(const std::string& path) {
  std::error_code none;
  if (!fs::exists(path, none)) throw InputError(path, "predicted edges", "nothing there");
  const std::string file = fs::is_directory(path, none) ? file_of(path) : path;
  if (file.empty()) {
    throw InputError(path, "parametric_edges.json, edge_points.ply, sketch.json or sketch.obj",
                     "none of them");
  }
  const std::string extension = fs::path(file).extension().string();
  Prediction prediction;
  if (extension == ".json") {
    prediction = read_json(file);
    if (prediction.strokes.empty() && file != path) read_strokes_beside(path, &prediction);
  } else if (extension == ".ply") {
    prediction = read_points(file);
  } else if (extension == ".obj") {
    prediction = read_obj(file);
  } else {
    throw InputError(file, "predicted edges as .json, .ply or .obj",
                     extension.empty() ? "a name without an ending" : extension);
  }
  prediction.path = file;
  return prediction;
}

}  // namespace sketchsplat
