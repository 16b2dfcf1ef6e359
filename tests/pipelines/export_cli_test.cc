// SPDX-License-Identifier: MIT
// `export` as its users meet it: what its options leave out, scale and fill.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "sketches/io/io.h"
#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using testing::HasSubstr;
using testing::Not;

// A unit square, and a line apart from it.
Sketch square_and_line() {
  Sketch s;
  for (const auto& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                        Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(0, 1, 0)})
    s.add_node(p);
  for (int i = 0; i < 4; ++i) s.add_stroke(StrokeKind::kLine, i, (i + 1) % 4, {});
  const int a = s.add_node({0.25, 0.5, 3}), b = s.add_node({0.75, 0.5, 3});
  s.add_stroke(StrokeKind::kLine, a, b, {});
  return s;
}

class Export : public Program {
 protected:
  std::string written(const Sketch& sketch,
                      const std::string& extra = R"({"views": ["a", "b"]})") const {
    const std::string path = in_folder("sketch.json");
    std::ofstream out(path);
    write_sketch_json(out, sketch, extra);
    return path;
  }
  std::string exported(const Sketch& sketch, const std::string& name,
                       const std::string& options = "") const {
    const std::string path = in_folder(name);
    const Outcome o = run("export " + written(sketch) + " --out " + path + " " + options);
    EXPECT_EQ(o.status, 0) << o.err;
    return text_of_file(path);
  }
  int refused(const std::string& name, const std::string& options) const {
    const Outcome o =
        run("export " + written(square_and_line()) + " --out " + in_folder(name) + " " + options);
    EXPECT_EQ(count_lines(o.err), 1) << o.err;
    EXPECT_FALSE(fs::exists(folder_ / name));
    return o.status;
  }
};

TEST_F(Export, MinConfidenceLeavesOutStrokesAndTheNodesThatNobodyUsesThen) {
  Sketch s = square_and_line();
  for (int i = 0; i < 4; ++i) s.evidence[i].confidence = 0.9;
  s.evidence[1].confidence = 0.5;
  s.evidence[4].confidence = 0.49;
  const Outcome o = run("export " + written(s) + " --format sketch --min-confidence 0.5 --out " +
                        in_folder("few.json"));
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out, "4 curves, 1 less probable ones left out\n");
  std::ifstream in(folder_ / "few.json");
  const Sketch few = read_sketch_json(in, "few.json");
  EXPECT_EQ(few.size(), 4);
  EXPECT_EQ(few.nodes.cols(), 4);
  EXPECT_EQ(few.evidence[1].confidence, 0.5);
  const auto json = nlohmann::json::parse(text_of_file(folder_ / "few.json"));
  EXPECT_EQ(json["views"], (std::vector<std::string>{"a", "b"})) << "the rest of the file stays";
}

TEST_F(Export, StrokesOfUnknownConfidenceStayAndTheUserIsTold) {
  const Outcome o = run("export " + written(square_and_line()) + " --min-confidence 0.9 --out " +
                        in_folder("all.obj"));
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.err, HasSubstr("has no confidences"));
  EXPECT_THAT(text_of_file(folder_ / "all.obj"), HasSubstr("l 5 6"));
  EXPECT_EQ(exported(square_and_line(), "plain.obj"), text_of_file(folder_ / "all.obj"));
}

TEST_F(Export, ScaleMultipliesTheCoordinates) {
  const std::string obj = exported(square_and_line(), "a.obj", "--scale 40");
  EXPECT_THAT(obj, HasSubstr("v 40 0 0\n"));
  EXPECT_THAT(obj, HasSubstr("v 10 20 120\n"));
  EXPECT_THAT(exported(square_and_line(), "a.step", "--scale 40"), HasSubstr("(10.,20.,120.)"));
  EXPECT_EQ(refused("refused.ply", "--scale 2"), kWrongUsage);
  EXPECT_EQ(refused("refused.step", "--scale 0"), kWrongUsage);
}

TEST_F(Export, UnitIsWrittenIntoTheFileAndLeavesTheNumbers) {
  const std::string inch = exported(square_and_line(), "a.step", "--unit inch");
  EXPECT_THAT(inch, HasSubstr("'INCH'"));
  EXPECT_THAT(inch, HasSubstr("(0.25,0.5,3.)"));
  EXPECT_THAT(exported(square_and_line(), "b.step", "--unit mm"), Not(HasSubstr("'INCH'")));
  EXPECT_THAT(exported(square_and_line(), "a.dxf", "--unit m"), HasSubstr("$INSUNITS\n70\n6\n"));
  EXPECT_EQ(refused("refused.step", "--unit furlong"), kWrongUsage);
}

TEST_F(Export, FacesFillClosedPlanarLoopsInStepAlone) {
  const std::string filled = exported(square_and_line(), "a.step", "--faces");
  const size_t face = filled.find("ADVANCED_FACE(");
  ASSERT_NE(face, std::string::npos);
  EXPECT_EQ(filled.find("ADVANCED_FACE(", face + 1), std::string::npos);
  EXPECT_THAT(exported(square_and_line(), "b.step"), Not(HasSubstr("ADVANCED_FACE")));
  EXPECT_EQ(refused("refused.dxf", "--faces"), kWrongUsage);
}

}  // namespace
}  // namespace sketchsplat
