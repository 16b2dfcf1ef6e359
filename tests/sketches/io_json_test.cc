// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "datasets/types/errors.h"
#include "sketches/curve/curve.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/io/io.h"
#include "tests/sketches/five_kinds.h"

namespace sketchsplat {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string text_of(const Sketch& s, const std::string& extra = "") {
  std::ostringstream out;
  write_sketch_json(out, s, extra);
  return out.str();
}

Sketch read(const std::string& text) {
  std::istringstream in(text);
  return read_sketch_json(in, "a/sketch.json");
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing";
}

// The sketch as JSON with one change made to it.
template <typename Change>
std::string changed(Change change) {
  nlohmann::json j = nlohmann::json::parse(text_of(five_kinds()));
  change(j);
  return j.dump();
}

bool same_bits(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  if (a.cols() != b.cols()) return false;
  return a.size() == 0 || std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

void expect_same(const Sketch& a, const Sketch& b) {
  EXPECT_TRUE(same_bits(a.nodes, b.nodes));
  EXPECT_TRUE(same_bits(a.handles, b.handles));
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.evidence.size(), b.evidence.size());
  for (int i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.strokes[i].kind, b.strokes[i].kind);
    EXPECT_EQ(a.strokes[i].begin, b.strokes[i].begin);
    EXPECT_EQ(a.strokes[i].end, b.strokes[i].end);
    EXPECT_EQ(a.strokes[i].handle, b.strokes[i].handle);
    EXPECT_EQ(a.evidence[i].opacity, b.evidence[i].opacity);
    EXPECT_EQ(a.evidence[i].support_views, b.evidence[i].support_views);
    EXPECT_EQ(a.evidence[i].rms_px, b.evidence[i].rms_px);
    EXPECT_EQ(a.evidence[i].sigma, b.evidence[i].sigma);
  }
}

TEST(SketchJson, ReadsBackBitForBit) {
  expect_same(read(text_of(all_kinds())), all_kinds());
  expect_same(read(text_of(Sketch())), Sketch());
  Random random;
  for (double scale : {1e-100, 1e-3, 1e3, 1e98}) {
    const Sketch s = moved(all_kinds(), scale, random.rotation(), {0, 0, 0});
    expect_same(read(text_of(s)), s);
  }
  Sketch s = five_kinds();
  s.nodes.col(0) << -0.0, std::numeric_limits<double>::denorm_min(), 0.1 + 0.2;
  expect_same(read(text_of(s)), s);
}

TEST(SketchJson, SaysWhatReadersNeed) {
  const nlohmann::json j = nlohmann::json::parse(text_of(five_kinds(), R"({"version":"1.2"})"));
  EXPECT_EQ(j["format_version"], 1);
  EXPECT_EQ(j["version"], "1.2");
  const auto& arc = j["strokes"][1];
  const auto vec = [](const nlohmann::json& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  const Sketch s = five_kinds();
  for (double t : {0.0, 0.4, 1.0}) {
    Eigen::Vector3d p, d;
    evaluate_stroke(s, 1, t, &p, &d);
    const Eigen::Vector3d spoke = p - vec(arc["centre"]);
    EXPECT_NEAR(spoke.norm(), double(arc["radius"]), 1e-14);
    EXPECT_NEAR(spoke.dot(vec(arc["normal"])), 0, 1e-14);
    EXPECT_GT(spoke.cross(d).dot(vec(arc["normal"])), 0) << "counter-clockwise";
  }
  EXPECT_NEAR(double(arc["angle"]) * double(arc["radius"]), stroke_length(s, 1), 1e-12);
  EXPECT_NEAR(double(j["strokes"][4]["radius"]), s.handles.col(4).norm(), 1e-15);
  EXPECT_EQ(j["strokes"][5].count("major"), 1u);
}

TEST(SketchJson, LeavesTheCentreOfAStraightArcOut) {
  Sketch s;
  const int a = s.add_node({0, 0, 0}), b = s.add_node({1, 0, 0});
  s.add_stroke(StrokeKind::kArc, a, b, {{0.5, 0, 0}});
  EXPECT_EQ(text_of(s).find("null"), std::string::npos);
  expect_same(read(text_of(s)), s);
}

TEST(SketchJson, KeepsJunctionsWhenHandlesAreOutOfOrder) {
  Sketch s = five_kinds();
  std::swap(s.strokes[1], s.strokes[2]);
  const Sketch back = read(text_of(s));
  for (int i = 0; i < s.size(); ++i)
    for (int k = 0; k < control_points(s, i).count; ++k)
      EXPECT_EQ(control_points(back, i).p[k], control_points(s, i).p[k]);
}

TEST(SketchJson, ASmoothChainIsOneCurveWhoseJointsAreNoNodes) {
  const Sketch s = smooth_chain();
  std::ostringstream out;
  write_sketch_json(out, s);
  const auto j = nlohmann::json::parse(out.str());
  ASSERT_EQ(j["strokes"].size(), 2u);
  EXPECT_EQ(j["strokes"][0]["kind"], "bezier");
  EXPECT_EQ(j["strokes"][0]["handles"].size(), 8u);
  EXPECT_EQ(j["nodes"].size(), 3u);
  std::istringstream in(out.str());
  const Sketch back = read_sketch_json(in, "sketch.json");
  EXPECT_EQ(back.size(), 4);
  const std::vector<CurveChain> chains = curve_chains(back);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_EQ(chain_points(back, chains[0]), chain_points(s, curve_chains(s)[0]));
  std::ostringstream again;
  write_sketch_json(again, back);
  EXPECT_EQ(again.str(), out.str());
}

TEST(SketchJson, AddsExtraMembersButNotOverItsOwn) {
  const Sketch s = five_kinds();
  expect_same(read(text_of(s, R"({"nodes": 3, "options": {"rounds": 4}})")), s);
  EXPECT_THROW(text_of(s, "[1]"), InputError);
  EXPECT_THROW(text_of(s, "{"), InputError);
}

TEST(SketchJson, RefusesWhatIsNoJson) {
  const std::string good = text_of(five_kinds());
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("solid cube"), good.substr(0, good.size() / 2),
        good + "}", std::string("\xff\xfe\0\0", 4), std::string("{\"format_version\": NaN}")})
    EXPECT_THAT(complaint(text), StartsWith("a/sketch.json: expected a sketch as JSON, found "));
  EXPECT_THAT(complaint("[]"), HasSubstr("an object with the key \"format_version\", found []"));
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  EXPECT_THAT(complaint(deep), HasSubstr("in one another, found 200000"));
  EXPECT_THAT(complaint(changed([&](auto& j) { j["nodes"] = "[[["; })), HasSubstr("nodes"));
}

TEST(SketchJson, RefusesAnotherVersion) {
  for (const char* version : {"0", "2", "1.5", "\"1\"", "null"})
    EXPECT_THAT(
        complaint(changed([&](auto& j) { j["format_version"] = nlohmann::json::parse(version); })),
        HasSubstr(std::string("expected format_version 1, found ") + version));
  EXPECT_THAT(complaint("{}"), HasSubstr("the key \"format_version\", found none"));
}

TEST(SketchJson, NamesTheStrokeThatIsBroken) {
  const auto because = [](auto change) { return complaint(changed(change)); };
  EXPECT_THAT(because([](auto& j) { j["strokes"][1]["nodes"][1] = 4; }),
              HasSubstr("expected an index below 4 in strokes[1].nodes[1], found 4"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][1]["nodes"][1] = -1; }), HasSubstr("found -1"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][1]["nodes"][1] = 1e30; }), HasSubstr("1e+30"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][1]["nodes"][1] = 1.5; }), HasSubstr("found 1.5"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][0]["nodes"] = {1}; }),
              HasSubstr("two nodes in strokes[0].nodes, found [1]"));
  EXPECT_THAT(because([](auto& j) {
                j["strokes"][4]["nodes"] = {1, 2};
              }),
              HasSubstr("no nodes in strokes[4].nodes, found [1,2]"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][2]["handles"].erase(0); }),
              HasSubstr("2 handles, or 3 n - 1 for n cubics in strokes[2].handles, found [["));
  EXPECT_THAT(because([](auto& j) { j["strokes"][2]["kind"] = "spline"; }),
              HasSubstr("in strokes[2].kind, found \"spline\""));
  EXPECT_THAT(because([](auto& j) { j["strokes"][2].erase("kind"); }),
              HasSubstr("\"kind\" in strokes[2]"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][2] = 7; }),
              HasSubstr("an object with the key \"kind\" in strokes[2]"));
  EXPECT_THAT(because([](auto& j) { j["strokes"] = nullptr; }),
              HasSubstr("an array in strokes, found null"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][3]["opacity"] = "high"; }),
              HasSubstr("a number in strokes[3].opacity"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][3]["opacity"] = 2.0; }),
              HasSubstr("stroke 3: has an opacity outside"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][3]["support_views"] = -2; }), HasSubstr("-2"));
}

TEST(SketchJson, RefusesNumbersThatAreNone) {
  const auto because = [](auto change) { return complaint(changed(change)); };
  EXPECT_THAT(because([](auto& j) { j["nodes"][2][1] = nullptr; }),  // what NaN is written as
              HasSubstr("three numbers in nodes[2], found [1.2,null,0.35]"));
  EXPECT_THAT(because([](auto& j) { j["nodes"][2] = {1, 2}; }), HasSubstr("three numbers"));
  EXPECT_THAT(because([](auto& j) { j["strokes"][1]["handles"][0][0] = "x"; }),
              HasSubstr("three numbers in strokes[1].handles[0]"));
  std::string text = text_of(five_kinds());
  text.replace(text.find("[0.1,"), 5, "[1e999,");
  EXPECT_THAT(complaint(text), HasSubstr("a sketch as JSON"));
}

TEST(SketchJson, RefusesBrokenInvariants) {
  const std::string text = changed([](auto& j) {
    j["nodes"].push_back({9, 9, 9});
    j["nodes"].push_back({8, 9, 9});
  });
  EXPECT_THAT(complaint(text), AllOf(HasSubstr("expected a sound sketch, found node 4 belongs"),
                                     HasSubstr("(and 1 more)")));
}

Eigen::Vector3d cubic_at(const Eigen::Matrix<double, 3, 4>& c, double t) {
  const double s = 1 - t;
  return c * Eigen::Vector4d(s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t);
}

TEST(ToCubics, StayWithinTheToleranceOfEveryKind) {
  Sketch s = five_kinds();
  for (double angle : {1e-6, 0.5, 3.0, 6.2}) {
    const auto on = [&](double a) { return Eigen::Vector3d(std::cos(a), std::sin(a), 1); };
    const int a = s.add_node(on(0)), b = s.add_node(on(angle));
    s.add_stroke(StrokeKind::kArc, a, b, {on(angle / 2)});
  }
  for (double tolerance : {1e-2, 1e-5, 1e-8})
    for (int i = 0; i < s.size(); ++i) {
      const auto pieces = to_cubics(s, i, tolerance);
      const double size = is_closed(s.strokes[i].kind)
                              ? s.handles.col(s.strokes[i].handle + 1).norm()
                              : stroke_length(s, i);
      const Eigen::Matrix3Xd dense = sample_stroke(s, i, stroke_length(s, i) / 4000);
      double worst = 0;
      for (size_t k = 0; k < pieces.size(); ++k) {
        const Eigen::Vector3d before = k > 0 ? pieces[k - 1].col(3) : pieces[k].col(0);
        EXPECT_EQ(Eigen::Vector3d(pieces[k].col(0)), before) << "pieces meet";
        for (double t = 0; t <= 1; t += 1.0 / 16) {
          // Distance to the chords of the dense samples: 1e-7 of the curve finer than the curve.
          const Eigen::Vector3d p = cubic_at(pieces[k], t);
          double best = 1e9;
          for (int m = 1; m < dense.cols(); ++m) {
            const Eigen::Vector3d e = dense.col(m) - dense.col(m - 1), w = p - dense.col(m - 1);
            const double f = std::clamp(w.dot(e) / e.squaredNorm(), 0.0, 1.0);
            best = std::min(best, (w - f * e).norm());
          }
          worst = std::max(worst, best);
        }
      }
      EXPECT_LT(worst, size * (tolerance + 1e-6)) << kind_name(s.strokes[i].kind) << " " << i;
    }
}

TEST(ToCubics, StartAndEndAtTheNodesToTheLastBit) {
  const Sketch s = five_kinds();
  for (int i = 0; i < 4; ++i) {
    const auto pieces = to_cubics(s, i);
    EXPECT_EQ(Eigen::Vector3d(pieces.front().col(0)), s.nodes.col(s.strokes[i].begin));
    EXPECT_EQ(Eigen::Vector3d(pieces.back().col(3)), s.nodes.col(s.strokes[i].end));
  }
  for (int i : {4, 5})
    EXPECT_EQ(to_cubics(s, i).front().col(0), to_cubics(s, i).back().col(3)) << "closes";
}

TEST(ParametricEdges, HoldLinesByTheirEndsAndTheRestAsCubics) {
  std::ostringstream out;
  const Sketch s = five_kinds();
  write_parametric_edges(out, s);
  const nlohmann::json j = nlohmann::json::parse(out.str());
  ASSERT_EQ(j["lines_end_pts"].size(), 2u);
  EXPECT_EQ(j["lines_end_pts"][0], nlohmann::json({0.1, 0.2, 0.3, 1.0, 0.1, 0.4}));
  size_t pieces = 0;
  for (int i : {1, 2, 4, 5}) pieces += to_cubics(s, i).size();
  ASSERT_EQ(j["curves_ctl_pts"].size(), pieces);
  for (const auto& curve : j["curves_ctl_pts"]) {
    ASSERT_EQ(curve.size(), 4u);
    for (const auto& p : curve) ASSERT_EQ(p.size(), 3u);
  }
  std::ostringstream empty;
  write_parametric_edges(empty, Sketch());
  EXPECT_EQ(nlohmann::json::parse(empty.str()),
            nlohmann::json::parse(R"({"curves_ctl_pts": [], "lines_end_pts": []})"));
}

}  // namespace
}  // namespace sketchsplat
