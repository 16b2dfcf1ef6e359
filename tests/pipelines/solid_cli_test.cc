// SPDX-License-Identifier: MIT
// The part of a synthetic scene as a STEP file, and solids compared with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/pipelines/program.h"

namespace sketchsplat {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Solids : public Program {
 protected:
  // A scene of a built-in part, and a result that is its truth but for the solid.
  void make(const std::string& part, const std::string& name, const std::string& extent = "1") {
    const std::string scene = in_folder("scenes/" + name), result = in_folder("results/" + name);
    fs::create_directories(result);
    ASSERT_EQ(run("synthesize " + part + " --views 2 --resolution 16 --extent " + extent +
                  " --quiet --out '" + scene + "'")
                  .status,
              0);
    fs::copy_file(scene + "/groundtruth/sketch.json", result + "/sketch.json");
  }
  std::string part_of(const std::string& name) const {
    return in_folder("scenes/" + name + "/groundtruth/part.step");
  }
  std::string pair(const std::string& name) const {
    return " --pred '" + in_folder("results" + name) + "' --gt '" + in_folder("scenes" + name) +
           "'";
  }
  json compared(const std::string& arguments) const {
    const Outcome o = run("evaluate" + arguments + " --json");
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out);
  }
};

TEST_F(Solids, ThePartOfASceneIsItself) {
  make("box-hole", "a", "40");
  EXPECT_FALSE(compared(pair("/a")).contains("solid")) << "the result has none";
  fs::copy_file(part_of("a"), in_folder("results/a/solid.step"));
  const json solid = compared(pair("/a"))["solid"];
  EXPECT_EQ(solid["valid"], true);
  EXPECT_NEAR(double(solid["iou"]), 1, 1e-6);
  EXPECT_EQ(solid["face_f"], 1);
  EXPECT_EQ(solid["faces"], 7);
  EXPECT_LT(double(solid["largest_distance"]), 0.004);
  EXPECT_LT(double(solid["volume"]), 40.0 * 40 * 40) << "world units are millimetres";
  EXPECT_GT(double(solid["volume"]), 40 * 10 * 10);
  EXPECT_THAT(run("evaluate" + pair("/a")).out, HasSubstr("solid: IoU 1.000000, 7 faces of 7: P"));
}

TEST_F(Solids, AnotherPartIsNot) {
  make("box-hole", "a");
  make("box", "b");
  const json solid = compared(pair("/a") + " --solid '" + part_of("b") + "'")["solid"];
  EXPECT_LT(double(solid["iou"]), 0.99);
  EXPECT_EQ(solid["faces"], 6);
  EXPECT_EQ(solid["true_faces"], 7);
}

TEST_F(Solids, ManyScenesHaveAColumnEach) {
  make("box-hole", "a");
  make("box", "b");
  fs::copy_file(part_of("a"), in_folder("results/a/solid.step"));
  const Outcome o = run("evaluate" + pair("") + " --out '" + in_folder("numbers") + "'");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(text_of_file(in_folder("numbers/evaluation.csv")), HasSubstr("solid.iou"));
  const json all = json::parse(text_of_file(in_folder("numbers/evaluation.json")));
  EXPECT_NEAR(double(all["mean"]["solid.iou"]), 1, 1e-6) << "of those that have one";
}

TEST_F(Solids, FilesThatAreNotThereAreBadInput) {
  make("box", "a");
  const Outcome none = run("evaluate" + pair("/a") + " --solid nowhere.step");
  EXPECT_EQ(none.status, kBadInput);
  EXPECT_THAT(none.err, HasSubstr("nowhere.step"));
  EXPECT_EQ(run("evaluate" + pair("") + " --solid '" + part_of("a") + "'").status, kWrongUsage);
  std::ofstream(in_folder("results/a/solid.step")) << "no STEP file";
  const Outcome broken = run("evaluate" + pair("/a"));
  EXPECT_EQ(broken.status, 0) << "edges are compared all the same";
  EXPECT_THAT(broken.err, HasSubstr("solid.step"));
  EXPECT_THAT(broken.out, Not(HasSubstr("solid")));
}

// From images to a solid that is compared with the part, and what is left of it afterwards.
class SolidsOfImages : public Solids {
 protected:
  void SetUp() override {
    Solids::SetUp();
    ASSERT_EQ(run("synthesize box-hole --views 16 --resolution 240 --outputs none --quiet --out '" +
                  in_folder("scene") + "'")
                  .status,
              0);
  }
  int reconstruct(const std::string& name, const std::string& options) const {
    return run("reconstruct '" + in_folder("scene") + "' --overlays 0 --quiet --out '" +
               in_folder(name) + "' " + options)
        .status;
  }
  json report(const std::string& name) const {
    return json::parse(text_of_file(in_folder(name + "/report.json")))["solid"];
  }
};

TEST_F(SolidsOfImages, AreThePartForAnyNumberOfThreads) {
  ASSERT_EQ(reconstruct("one", "--solid require --threads 1"), 0);
  ASSERT_EQ(reconstruct("three", "--threads 3"), 0);
  for (const char* file : {"solid.step", "solid.json", "surfaces.csv", "dimensions.csv"})
    EXPECT_TRUE(text_of_file(in_folder("one/") + file) == text_of_file(in_folder("three/") + file))
        << file;
  const json told = report("one");
  EXPECT_EQ(told["written"], true);
  EXPECT_EQ(told["faces"]["plane"], 6);
  EXPECT_EQ(told["faces"]["cylinder"], 1);
  EXPECT_EQ(told["mask_rays_contradicted"], 0);
  const json solid =
      compared(" --pred '" + in_folder("one") + "' --gt '" + in_folder("scene") + "'")["solid"];
  EXPECT_EQ(solid["valid"], true);
  EXPECT_GT(double(solid["iou"]), 0.99);
  EXPECT_EQ(solid["face_f"], 1);
  EXPECT_NEAR(double(solid["volume"]), double(told["volume"]), 1e-6);
}

// Eight small pictures leave edges out that the faces of the others imply.
TEST_F(Solids, TheirEdgesCompleteTheSketch) {
  const std::string scene = in_folder("scene");
  ASSERT_EQ(run("synthesize l-bracket --views 8 --resolution 200 --outputs none --quiet --out '" +
                scene + "'")
                .status,
            0);
  const auto result = [&](const std::string& name, const std::string& options) {
    const std::string out = in_folder(name);
    EXPECT_EQ(run("reconstruct '" + scene + "' --overlays 0 --quiet --out '" + out + "'" + options)
                  .status,
              0);
    int inferred = 0;
    const json sketch = json::parse(text_of_file(out + "/sketch.json"));
    for (const json& stroke : sketch["strokes"])
      inferred += stroke.value("inferred", false) && stroke["support_views"] == 0;
    const json numbers = compared(" --pred '" + out + "' --gt '" + scene + "'");
    return std::pair(inferred, double(numbers["structure"]["f"]));
  };
  const auto [none, f_seen] = result("off", " --solid off");
  const auto [left_out, f_left] = result("seen", " --without inferred");
  const auto [some, f_all] = result("all", "");
  EXPECT_EQ(none, 0);
  EXPECT_EQ(left_out, 0);
  EXPECT_GT(some, 0);
  EXPECT_NEAR(f_left, f_seen, 1e-9);
  EXPECT_GT(f_all, f_seen + 5);
}

TEST_F(SolidsOfImages, HaveTablesInTheUnit) {
  ASSERT_EQ(reconstruct("result", "--scale 40 --unit cm"), 0);
  const json told = report("result");
  ASSERT_EQ(told["surfaces"].size(), 7u);
  EXPECT_EQ(told["unit"], "cm");
  std::map<std::string, std::vector<json>> of_kind;
  for (const json& d : told["dimensions"]) of_kind[d["kind"]].push_back(d);
  ASSERT_EQ(of_kind["diameter"].size(), 1u);
  EXPECT_EQ(of_kind["plane distance"].size(), 3u);
  EXPECT_EQ(of_kind["axis to plane"].size(), 2u);
  const double radius = told["surfaces"][6]["radius"];
  EXPECT_NEAR(double(of_kind["diameter"][0]["value"]), 2 * radius, 1e-6);
  for (const json& d : told["dimensions"]) {
    EXPECT_GT(double(d["sigma"]), 0) << d;
    EXPECT_LT(double(d["sigma"]), 0.01 * 40) << d;
    EXPECT_EQ(d["unit"], "cm");
  }
  const std::string surfaces = text_of_file(in_folder("result/surfaces.csv"));
  EXPECT_EQ(count_lines(surfaces), 8);
  EXPECT_THAT(surfaces, HasSubstr("\ncylinder_6,6,cylinder,cm,"));
  EXPECT_EQ(count_lines(text_of_file(in_folder("result/dimensions.csv"))), 7);
  ASSERT_EQ(reconstruct("result", "--solid off"), 0);
  for (const char* file : {"surfaces.csv", "dimensions.csv", "solid.json", "solid.step"})
    EXPECT_FALSE(fs::exists(in_folder("result/") + file)) << file;
}

TEST_F(SolidsOfImages, AreExportedAgainAtAnotherScale) {
  ASSERT_EQ(reconstruct("scene", "--scale 40"), 0);  // of the same name: so is the product
  const auto exported = [&](const std::string& to, const std::string& options) {
    const Outcome o =
        run("export '" + in_folder("scene") + "' --solid '" + in_folder(to) + "' " + options);
    EXPECT_EQ(o.status, 0) << o.err;
    return text_of_file(in_folder(to));
  };
  fs::create_directories(in_folder("again"));
  EXPECT_TRUE(exported("again/scene.step", "") == text_of_file(in_folder("scene/solid.step")));
  EXPECT_THAT(exported("other.step", "--scale 2 --unit inch"), HasSubstr("INCH"));
  exported("again/world.step", "--scale 1 --unit mm");
  const json same = compared(" --pred '" + in_folder("scene") + "' --gt '" + in_folder("scene") +
                             "' --solid '" + in_folder("again/world.step") + "'")["solid"];
  EXPECT_GT(double(same["iou"]), 0.99) << "the truth is in world units";
  fs::remove(in_folder("scene/solid.json"));
  const Outcome none =
      run("export '" + in_folder("scene") + "' --solid '" + in_folder("x.step") + "'");
  EXPECT_EQ(none.status, kBadInput);
  EXPECT_EQ(count_lines(none.err), 1);
}

TEST_F(Solids, ThatAreRequiredAndNotFoundAreTooLittleAfterAllElseIsWritten) {
  const std::string scene = in_folder("scene"), result = in_folder("result");
  const std::string part = "freeform-pad --views 16 --resolution 240 --outputs none";
  ASSERT_EQ(run("synthesize " + part + " --quiet --out '" + scene + "'").status, 0);
  const Outcome o = run("reconstruct '" + scene + "' --overlays 0 --quiet --solid require --out '" +
                        result + "'");
  EXPECT_EQ(o.status, kTooLittle) << o.err;
  EXPECT_THAT(o.err, HasSubstr("solid"));
  EXPECT_TRUE(fs::exists(result + "/sketch.step"));
  EXPECT_FALSE(fs::exists(result + "/solid.step"));
  EXPECT_NE(json::parse(text_of_file(result + "/report.json"))["solid"]["why"], "");
}

TEST_F(Solids, AMeshHasNoPart) {
  std::ofstream mesh(in_folder("block.obj"));
  for (int k = 0; k < 8; ++k)
    mesh << "v " << (k & 1) << " " << (k >> 1 & 1) << " " << (k >> 2) << "\n";
  mesh << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  mesh.close();
  make("'" + in_folder("block.obj") + "'", "a");
  EXPECT_FALSE(fs::exists(part_of("a")));
}

}  // namespace
}  // namespace sketchsplat
