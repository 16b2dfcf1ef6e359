// SPDX-License-Identifier: MIT
#include "datasets/io/ply.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "datasets/types/errors.h"
#include "sketches/io/whole_file.h"

namespace sketchsplat {
namespace {

struct Property {
  std::string type, name;
};

struct Header {
  bool ascii = false;
  long count = -1;  // of vertices
  std::vector<Property> properties;
};

template <typename T>
double number_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return double(value);
}

// Size in bytes of a scalar PLY type, and its value; 0 if there is no such type.
int scalar(const std::string& type, const char* bytes, double* value) {
  const auto as = [&](auto zero) {
    if (bytes != nullptr) *value = number_at<decltype(zero)>(bytes);
    return int(sizeof(zero));
  };
  if (type == "float" || type == "float32") return as(float(0));
  if (type == "double" || type == "float64") return as(double(0));
  if (type == "char" || type == "int8") return as(int8_t(0));
  if (type == "uchar" || type == "uint8") return as(uint8_t(0));
  if (type == "short" || type == "int16") return as(int16_t(0));
  if (type == "ushort" || type == "uint16") return as(uint16_t(0));
  if (type == "int" || type == "int32") return as(int32_t(0));
  if (type == "uint" || type == "uint32") return as(uint32_t(0));
  return 0;
}

Header read_header(std::istream& in, const std::string& path) {
  Header header;
  std::string line, element;
  bool first_element = true;
  if (!std::getline(in, line) || line.substr(0, 3) != "ply") {
    throw InputError(path, "a PLY file", "no line \"ply\" at its beginning");
  }
  for (int n = 0; n < 1000 && std::getline(in, line); ++n) {
    std::istringstream words(line);
    std::string key, a, b;
    words >> key >> a >> b;
    if (key == "format") {
      header.ascii = a == "ascii";
      if (!header.ascii && a != "binary_little_endian") {
        throw InputError(path, "PLY in ascii or binary_little_endian", "format " + a);
      }
    } else if (key == "element") {
      element = a;
      if (a == "vertex") {
        if (!first_element) throw InputError(path, "vertices first", "another element before");
        std::istringstream(b) >> header.count;
      }
      first_element = false;
    } else if (key == "property" && element == "vertex") {
      if (scalar(a, nullptr, nullptr) == 0) {
        throw InputError(path, "scalar vertex properties", "a property of type " + a);
      }
      header.properties.push_back({a, b});
    } else if (key == "end_header") {
      if (header.count < 0) throw InputError(path, "element vertex N", "a header without it");
      return header;
    }
  }
  throw InputError(path, "a PLY header", "no end_header");
}

bool is_stroke(const std::string& name) {
  return name == "id" || name.find("stroke") != std::string::npos ||
         name.find("index") != std::string::npos;
}

// Nearest that an int can hold; 0 for what is no number.
int whole_number(double value) {
  constexpr double kMost = std::numeric_limits<int>::max();
  return std::isnan(value) ? 0 : int(std::clamp(value, -kMost, kMost));
}

// Values of one vertex in the order of the properties.
bool read_vertex(std::istream& in, const Header& header, std::vector<char>* bytes,
                 std::vector<double>* values) {
  if (header.ascii) {
    for (double& v : *values) in >> v;
    return bool(in);
  }
  if (!in.read(bytes->data(), std::streamsize(bytes->size()))) return false;
  const char* at = bytes->data();
  for (size_t k = 0; k < values->size(); ++k) {
    at += scalar(header.properties[k].type, at, &(*values)[k]);
  }
  return true;
}

}  // namespace

PlyPoints read_ply_points(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, "a PLY file", "nothing that can be opened");
  check_length(&in, path);
  const Header header = read_header(in, path);
  int xyz[3] = {-1, -1, -1}, stroke = -1;
  int stride = 0;
  for (int k = 0; k < int(header.properties.size()); ++k) {
    const Property& p = header.properties[k];
    stride += scalar(p.type, nullptr, nullptr);
    if (p.name == "x" || p.name == "y" || p.name == "z") xyz[p.name[0] - 'x'] = k;
    if (stroke < 0 && is_stroke(p.name)) stroke = k;
  }
  if (xyz[0] < 0 || xyz[1] < 0 || xyz[2] < 0) {
    throw InputError(path, "vertex properties x, y and z", "a header without one of them");
  }
  // Grown while reading: the count of a broken header must not decide how much is allocated.
  std::vector<double> coordinates, values(header.properties.size());
  std::vector<char> bytes(stride);
  PlyPoints points;
  for (long i = 0; i < header.count; ++i) {
    if (!read_vertex(in, header, &bytes, &values)) {
      throw InputError(path, std::to_string(header.count) + " vertices",
                       "the end of the file after " + std::to_string(i));
    }
    for (int k : xyz) {
      if (!std::isfinite(values[k])) {
        throw InputError(path, "finite coordinates",
                         "another number at vertex " + std::to_string(i));
      }
      coordinates.push_back(values[k]);
    }
    if (stroke >= 0) points.stroke.push_back(whole_number(values[stroke]));
  }
  points.position = Eigen::Map<Eigen::Matrix3Xd>(coordinates.data(), 3, header.count);
  return points;
}

}  // namespace sketchsplat
