// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

#include "sketches/curve/closest.h"
#include "sketches/curve/curve.h"
#include "sketches/io/io.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using Eigen::Vector3d;

std::string obj_of(const Sketch& s, double deflection = 1e-4) {
  std::ostringstream out;
  write_obj(out, s, deflection);
  return out.str();
}

// What a plain reader of OBJ sees: vertices, and segments by object.
struct Obj {
  std::vector<Vector3d> v;
  std::vector<std::pair<std::string, std::vector<std::pair<int, int>>>> objects;
  bool all_v_first = true;
};
Obj parse_obj(const std::string& text) {
  Obj out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      Vector3d p;
      words >> p.x() >> p.y() >> p.z();
      EXPECT_TRUE(bool(words)) << line;
      if (!out.objects.empty()) out.all_v_first = false;
      out.v.push_back(p);
    } else if (key == "o") {
      out.objects.emplace_back(line.substr(2), std::vector<std::pair<int, int>>());
    } else if (key == "l") {
      int a, b;
      std::string rest;
      words >> a >> b;
      EXPECT_TRUE(bool(words) && !(words >> rest)) << "two indices, no more: " << line;
      EXPECT_FALSE(out.objects.empty()) << "a segment belongs to an object";
      out.objects.back().second.emplace_back(a - 1, b - 1);
    } else {
      EXPECT_EQ(key, "#") << line;
    }
  }
  return out;
}

TEST(Obj, IsOneObjectAStrokeOverSharedVertices) {
  const Sketch s = all_kinds();
  const Obj obj = parse_obj(obj_of(s));
  EXPECT_TRUE(obj.all_v_first);
  ASSERT_EQ(int(obj.objects.size()), s.size());
  std::vector<bool> used(obj.v.size());
  for (int i = 0; i < s.size(); ++i) {
    const auto& [name, segments] = obj.objects[i];
    EXPECT_EQ(name, std::string(kind_name(s.strokes[i].kind)) + "_" + std::to_string(i));
    ASSERT_FALSE(segments.empty());
    for (size_t k = 0; k < segments.size(); ++k) {
      const auto [a, b] = segments[k];
      ASSERT_TRUE(a >= 0 && b >= 0 && a < int(obj.v.size()) && b < int(obj.v.size()));
      used[a] = used[b] = true;
      EXPECT_EQ(k > 0 ? segments[k - 1].second : a, a) << "segments follow one another";
    }
    if (is_closed(s.strokes[i].kind)) {
      EXPECT_EQ(segments.front().first, segments.back().second);
    } else {  // nodes come first, so a junction is the same vertex in every stroke
      EXPECT_EQ(segments.front().first, s.strokes[i].begin);
      EXPECT_EQ(segments.back().second, s.strokes[i].end);
    }
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "no vertex lies idle";
  for (int n = 0; n < s.nodes.cols(); ++n) EXPECT_EQ(obj.v[n], Vector3d(s.nodes.col(n)));
}

TEST(Obj, KeepsItsChordsWithinTheDeflection) {
  for (double scale : {1e-3, 1.0, 1e3}) {
    const Sketch s = moved(all_kinds(), scale, Random().rotation(), {scale, 0, 0});
    for (double deflection : {1e-2, 1e-3, 1e-5}) {
      const Obj obj = parse_obj(obj_of(s, deflection));
      const double allowed = deflection * largest_extent(s);
      for (int i = 0; i < s.size(); ++i) {
        double length = 0, worst = 0;
        for (const auto& [a, b] : obj.objects[i].second) {
          length += (obj.v[b] - obj.v[a]).norm();
          for (double f : {0.25, 0.5, 0.75})
            worst = std::max(worst,
                             distance_to_stroke(s, i, (1 - f) * obj.v[a] + f * obj.v[b]).distance);
        }
        EXPECT_LE(worst, allowed * 1.01) << kind_name(s.strokes[i].kind);
        EXPECT_LE(length, stroke_length(s, i) * (1 + 1e-12));
        // Sagittae of d over chords of c lose 8/3 (d/c)^2 of the length; 45 deg steps 2.6 %.
        EXPECT_GT(length, stroke_length(s, i) * (deflection == 1e-5 ? 0.999 : 0.9));
      }
    }
  }
}

TEST(Obj, SpendsNoMoreThanItNeeds) {
  const Obj obj = parse_obj(obj_of(all_kinds(), 1e-3));
  EXPECT_EQ(obj.objects[0].second.size(), 1u) << "a line is one segment";
  for (const auto& [name, segments] : obj.objects) EXPECT_LT(segments.size(), 60u) << name;
}

TEST(Obj, IsValidWithoutStrokesAndWithAClosedCubic) {
  const Obj empty = parse_obj(obj_of(Sketch()));
  EXPECT_TRUE(empty.v.empty() && empty.objects.empty());
  Sketch s;
  const int n = s.add_node({0, 0, 0});
  s.add_stroke(StrokeKind::kBezier, n, n, {{1e-9, 0, 0}, {0, 1e-9, 0}});
  s.add_stroke(StrokeKind::kCircle, -1, -1, {{1, 1, 1}, {0, 0, 1}});
  EXPECT_GE(parse_obj(obj_of(s)).objects[0].second.size(), 3u);
}

TEST(Obj, GivesOpenMeshAllItsVertices) {
  const std::string text = obj_of(all_kinds());
  OpenMesh::PolyMesh_ArrayKernelT<> mesh;
  OpenMesh::IO::Options options;
  std::istringstream in(text);
  ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, in, ".obj", options));
  EXPECT_EQ(mesh.n_vertices(), parse_obj(text).v.size());
  EXPECT_EQ(mesh.n_faces(), 0u);
}

TEST(EdgePoints, ReadBackAsSamplesOfTheirStrokes) {
  const Sketch s = all_kinds();
  const double spacing = 0.05;
  std::ostringstream out;
  write_edge_points(out, s, spacing);
  const std::string text = out.str();
  const std::string end = "end_header\n";
  const size_t header = text.find(end) + end.size();
  EXPECT_EQ(text.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
  EXPECT_NE(text.find("property float x\nproperty float y\nproperty float z\n"
                      "property int stroke_index\nend_header\n"),
            std::string::npos);
  const size_t at = text.find("element vertex ");
  const size_t count = std::stoul(text.substr(at + 15));
  ASSERT_EQ(text.size() - header, count * 16);
  std::map<int, int> samples;
  for (size_t i = 0; i < count; ++i) {
    float p[3];
    int32_t stroke;
    std::memcpy(p, text.data() + header + 16 * i, 12);
    std::memcpy(&stroke, text.data() + header + 16 * i + 12, 4);
    ASSERT_TRUE(stroke >= 0 && stroke < s.size());
    ++samples[stroke];
    EXPECT_LT(distance_to_stroke(s, stroke, {p[0], p[1], p[2]}).distance, 2e-7);
  }
  for (int i = 0; i < s.size(); ++i)
    EXPECT_EQ(samples[i], int(std::ceil(stroke_length(s, i) / spacing)) +
                              (is_closed(s.strokes[i].kind) ? 0 : 1));
}

TEST(EdgePoints, ReadByOpenMesh) {
  std::stringstream file;
  write_edge_points(file, all_kinds(), 0.05);
  const std::string text = file.str();
  OpenMesh::PolyMesh_ArrayKernelT<> mesh;
  OpenMesh::IO::Options options = OpenMesh::IO::Options::Binary;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, file, ".ply", options));
  EXPECT_EQ(mesh.n_vertices(), std::stoul(text.substr(text.find("element vertex ") + 15)));
  const auto first = mesh.point(mesh.vertex_handle(0));
  EXPECT_LT((Vector3d(first[0], first[1], first[2]) - Vector3d(0.1, 0.2, 0.3)).norm(), 1e-6);
}

TEST(EdgePoints, ASmoothChainHasOneIndexAndNoJointTwice) {
  std::ostringstream out;
  write_edge_points(out, smooth_chain(), 0.05);
  const std::string text = out.str();
  const size_t body = text.find("end_header\n") + 11;
  std::vector<int> index;
  std::vector<Eigen::Vector3f> points;
  for (size_t at = body; at + 16 <= text.size(); at += 16) {
    float p[3];
    int i;
    std::memcpy(p, text.data() + at, 12), std::memcpy(&i, text.data() + at + 12, 4);
    points.push_back({p[0], p[1], p[2]}), index.push_back(i);
  }
  EXPECT_EQ(*std::max_element(index.begin(), index.end()), 1);
  for (size_t k = 1; k < points.size(); ++k) {
    const bool apart = (points[k] - points[k - 1]).norm() > 1e-4f;
    EXPECT_TRUE(apart || index[k] != index[k - 1]) << k;
  }
}

TEST(Obj, ASmoothChainIsOneObject) {
  std::ostringstream out;
  write_obj(out, smooth_chain());
  const std::string text = out.str();
  EXPECT_THAT(text, testing::HasSubstr("o bezier_0\n"));
  EXPECT_THAT(text, testing::HasSubstr("o line_1\n"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("_2\n")));
}

TEST(EdgePoints, AreValidWithoutStrokes) {
  std::ostringstream out;
  write_edge_points(out, Sketch(), 0.1);
  EXPECT_NE(out.str().find("element vertex 0\n"), std::string::npos);
  EXPECT_EQ(out.str().substr(out.str().size() - 11), "end_header\n");
}

}  // namespace
}  // namespace sketchsplat
