// SPDX-License-Identifier: MIT
// Bad scenes: images, sketches, truths and parts.
#include "tests/pipelines/bad_scenes.h"

namespace sketchsplat::test {

namespace fs = std::filesystem;

std::vector<BadScene> bad_images() {
  const auto image = [](const std::string& name, const Damage& damage, int status,
                        const std::string& line) {
    return BadScene{"Image" + name, "abc-nef", kDetect, damage, status, line};
  };
  const auto mask = [](const std::string& name, const Damage& damage, const std::string& line) {
    return BadScene{"Mask" + name, "nerfstudio", kMasks, damage, 0, line};
  };
  const auto exr = [](const std::string& name, const Damage& damage, const std::string& line) {
    return BadScene{"Exr" + name, "abc-nef", kGeometry, maps(damage), 0, line};
  };
  const auto as_jpeg = [](const Damage& then) {
    return both(both(gone("color/0.png"), swap(kMeta, "0.png", "0.jpg")),
                jpeg("color/0.jpg", then));
  };
  const Damage as_tiff = both(gone("color/0.png"), swap(kMeta, "0.png", "0.tif"));
  return {
      image("Empty", put("color/0.png", ""), 0, "0.png: expected an image, found an empty file"),
      image("IsText", put("color/0.png", "hello"), 0, "0.png: expected an image, found"),
      image("CutOff", cut("color/0.png", 0.6), 0,
            "0.png: expected a whole PNG image, found a broken one"),
      image("HeaderAlone", cut("color/0.png", 0.1), 0,
            "0.png: expected a whole PNG image, found a broken one"),
      image("AnotherSize", swap(kMeta, "\"width\": 32", "\"width\": 33"), 3,
            "an image of 33 x 24 px, found 32 x 24"),
      image("ClaimsABillionPixels", png_claims("color/0.png", 32000, 32000), 0,
            "0.png: expected a whole PNG image, found a broken one \\(more pixels than the file "
            "can hold"),
      image("ClaimsNoPixels", png_claims("color/0.png", 0, 24), 0,
            "0.png: expected a whole PNG image, found a broken one"),
      image("OfTenGigabytes", blow_up("color/0.png"), 0,
            "0.png: expected an image of at most 1200 MB, found 10000 MB"),
      image("JpegCutOff", as_jpeg(cut("color/0.jpg", 0.6)), 0,
            "0.jpg: expected a whole JPEG image, found a broken one \\(no end\\)"),
      image("JpegClaimsFourBillionPixels", as_jpeg(jpeg_claims("color/0.jpg", 65500)), 0,
            "0.jpg: expected a whole JPEG image, found a broken one"),
      image("JpegOfTenGigabytes", as_jpeg(blow_up("color/0.jpg")), 0,
            "0.jpg: expected an image of at most 1200 MB, found 10000 MB"),
      image("TiffClaimsABillionPixels", both(as_tiff, put("color/0.tif", tiff(32000, 32000))), 0,
            "0.tif: expected an image, found "),
      image("TiffClaimsTallStrips", both(as_tiff, put("color/0.tif", tiff(32, 24, 2'000'000'000))),
            0, "0.tif: expected .*, in strips of 2000000000 rows"),
      image("TiffCutOff", both(as_tiff, put("color/0.tif", tiff(32, 24).substr(0, 60))), 0,
            "0.tif: expected an image, found "),
      mask(
          "Black",
          [](const std::string& folder) {
            write_png(folder + "/masks/0.png", Image<float>(32, 24, 0.0f));
          },
          "masks/0.png: expected a mask that is white where the object is, found nothing white"),
      mask(
          "OfAnotherSize",
          [](const std::string& folder) {
            write_png(folder + "/masks/0.png", Image<float>(16, 24, 1.0f));
          },
          "masks/0.png: expected a mask of 32 x 24 px, found 16 x 24"),
      mask("CutOff", cut("masks/0.png", 0.6),
           "masks/0.png: expected a whole PNG image, found a broken one"),
      {"NoMasks", "nerfstudio", kMasks, gone("masks"), 3,
       "masks: expected a folder of masks, found nothing"},
      exr("CutOff", cut("depth/0.exr", 0.6), "depth/0.exr: expected an OpenEXR image, found"),
      exr("IsText", put("depth/0.exr", "hello"), "depth/0.exr: expected an OpenEXR image, found"),
      exr("Gone", gone("depth/0.exr"), "depth: expected a map of 0.png \\(.exr\\), found none"),
      exr("ClaimsABillionPixels", exr_claims("depth/0.exr", 31999),
          "depth/0.exr: expected an OpenEXR image, found"),
      exr(
          "OfAnotherSize",
          [](const std::string& folder) {
            write_exr(folder + "/depth/0.exr", {{"R", Image<float>(8, 8, 1.0f)}}, false);
          },
          "depth/0.exr: expected a map of 32 x 24 px, found 8 x 8"),
  };
}

std::vector<BadScene> bad_edges() {
  const auto row = [](const char* command, const std::string& file) {
    return [=](const std::string& name, const Damage& damage, const std::string& line) {
      return BadScene{name, "edges", command, damage, 3, file + ": expected " + line};
    };
  };
  const auto sketch = row(kSketch, "sketch.json"), emap = row(kEmap, "emap.json"),
             nef = row(kNef, "nef.json");
  const auto ply = row(kPly, "points.ply"), obj = row(kObj, "lines.obj"),
             truth = row(kEmap, "gt.json");
  const auto abc = row(kAbc, "a_features_0.yml");
  const std::string yml = "abc/a_features_0.yml";
  return {
      sketch("SketchEmpty", put("sketch.json", ""), "a sketch as JSON, found"),
      sketch("SketchWithoutVersion", swap("sketch.json", "format_version", "version"),
             "the key \"format_version\", found none"),
      sketch("SketchOfTheFuture", swap("sketch.json", ": 1,", ": 2,"), "format_version 1, found 2"),
      sketch("SketchNodesAreText", swap("sketch.json", "[[0,0,0],[1,0,0],[1,1,0]]", "\"three\""),
             "an array in nodes, found \"three\""),
      sketch("SketchNodeOfTwo", swap("sketch.json", "[1,1,0]", "[1,1]"),
             "three numbers in nodes\\[2\\], found \\[1,1\\]"),
      sketch("SketchKindUnknown", swap("sketch.json", "\"arc\"", "\"helix\""),
             "line, arc, .* in strokes\\[1\\].kind, found \"helix\""),
      sketch("SketchNodeTooLarge", swap("sketch.json", "[0,1]", "[0,9]"),
             "an index below 3 in strokes\\[0\\].nodes\\[1\\], found 9"),
      sketch("SketchNodeNegative", swap("sketch.json", "[0,1]", "[0,-1]"),
             "an index below 3 in strokes\\[0\\].nodes\\[1\\], found -1"),
      sketch("SketchHandleMissing", swap("sketch.json", "[[1.2,0.5,0]]", "[]"),
             "1 handles in strokes\\[1\\].handles, found \\[\\]"),
      sketch("SketchHandleOverflows", swap("sketch.json", "1.2", "1e999"),
             "a sketch as JSON, found"),
      sketch("SketchLineToItself", swap("sketch.json", "[0,1]", "[1,1]"), "a sound sketch, found"),
      sketch("SketchDeeplyNested", put("sketch.json", std::string(100000, '[')),
             "JSON with at most 100 arrays"),
      sketch("SketchTooLarge",
             swap("sketch.json", "[[0,0,0]", "[" + repeated("[0,0,0],", 50000) + "[0,0,0]"),
             "at most 50000 nodes, found 50003"),
      sketch("SketchOfTenGigabytes", blow_up("sketch.json"),
             "a file of at most 250 MB, found 10000 MB"),
      emap("EmapFiveNumbers", swap("emap.json", "[0,0,0,1,0,0]", "[0,0,0,1,0]"),
           "6 numbers for each of \"lines_end_pts\", found 5 in all"),
      emap("EmapText", swap("emap.json", "0.5", "\"half\""), "finite coordinates, found \"half\""),
      emap("EmapHuge", swap("emap.json", "0.5", "1e308"), "coordinates below 1e100, found 1e.308"),
      emap("EmapMuchLargerThanTheTruth", swap("emap.json", "0.5", "1e7"),
           "edges of at most 10000 times the size of the true object in all, found"),
      emap("EmapArray", put("emap.json", "[]"), "a JSON object, found another value"),
      emap("EmapNothing", put("emap.json", "{}"),
           "lines_end_pts and curves_ctl_pts, points or strokes, found none of them"),
      emap("EmapEmpty", put("emap.json", ""), "predicted edges as JSON, found"),
      emap("EmapDeeplyNested", put("emap.json", "{\"lines\":" + std::string(100000, '[')),
           "JSON with at most 100 arrays"),
      nef("NefElevenNumbers", swap("nef.json", "[160,160,128]", "[160,160]"),
          "12 numbers for each of \"curves_ctl_pts\", found 11 in all"),
      nef("NefNumber", put("nef.json", "{\"scene_name\": 1, \"curves_ctl_pts\": 3}"),
          "12 numbers for each of"),
      ply("PlyEmpty", put("points.ply", ""), "a PLY file, found no line \"ply\""),
      ply("PlyBigEndian", swap("points.ply", "ascii", "binary_big_endian"),
          "PLY in ascii or binary_little_endian, found format binary_big_endian"),
      ply("PlyWithoutEnd", swap("points.ply", "end_header", "end"),
          "a PLY header, found no end_header"),
      ply("PlyWithoutX", swap("points.ply", "float x", "float u"),
          "vertex properties x, y and z, found a header without one of them"),
      ply("PlyLists", swap("points.ply", "property float x", "property list uchar int x"),
          "scalar vertex properties, found a property of type list"),
      ply("PlyCutOff", swap("points.ply", "vertex 3", "vertex 4"),
          "4 vertices, found the end of the file after 3"),
      ply("PlyOfTrillions", swap("points.ply", "vertex 3", "vertex 4000000000000"),
          "4000000000000 vertices, found the end of the file after 3"),
      ply("PlyNegative", swap("points.ply", "vertex 3", "vertex -3"),
          "element vertex N, found a header without it"),
      ply("PlyBinaryCutOff", swap("points.ply", "ascii", "binary_little_endian"),
          "3 vertices, found the end of the file after"),
      ply("PlyOfTenGigabytes", blow_up("points.ply"), "a file of at most 1000 MB, found 10000 MB"),
      obj("ObjWord", swap("lines.obj", "v 1 0 0", "v 1 a 0"),
          "three numbers after v, found v 1 a 0"),
      obj("ObjIndexZero", swap("lines.obj", "l 1 2", "l 0 2"),
          "an index of a vertex above it, found 0"),
      obj("ObjIndexTooLarge", swap("lines.obj", "l 1 2", "l 1 9"),
          "an index of a vertex above it, found 9"),
      obj("ObjHuge", swap("lines.obj", "v 1 0 0", "v 1e300 0 0"),
          "coordinates below 1e100, found v 1e300 0 0"),
      obj("ObjOfTenGigabytes", blow_up("lines.obj"), "a file of at most 1000 MB, found 10000 MB"),
      truth("TruthEmpty", put("gt.json", ""), "curves with type and points, found"),
      truth("TruthWithoutCurves", put("gt.json", "[]"), "curves, found none"),
      truth("TruthOfOnePoint", swap("gt.json", "[[0,0,0],[1,0,0]]", "[[0,0,0]]"),
            "curves of two points and more, found 1"),
      truth("TruthPointOfTwo", swap("gt.json", "[1,1,0]", "[1,1]"),
            "points of 3 numbers, found \\[1,1\\]"),
      truth("TruthHuge", swap("gt.json", "[1,1,0]", "[1e200,1,0]"),
            "coordinates below 1e100, found"),
      truth("TruthViewsMissing", swap("gt.json", "[3,2]", "[3]"),
            "2 visible_views, one a point, found 1"),
      truth("TruthNoSharp", swap_all("gt.json", "\"type\": ", "\"sharp\": false, \"type\": "),
            "at least one sharp curve, found none"),
      truth("TruthWithoutLength", put("gt.json", "[{\"points\": [[1,1,1],[1,1,1]]}]"),
            "edges with a length, found none"),
      abc("FeaturesEmpty", put(yml, ""), "(a list \"curves\", found none|curves with type)"),
      abc("FeaturesBroken", put(yml, "curves: [\n"),
          "curves with type, sharp and vert_indices, found"),
      abc("FeaturesDeeplyNested", put(yml, "curves: " + std::string(100000, '[')),
          "curves with type, sharp and vert_indices, found"),
      abc("FeaturesWithoutType", swap(yml, "type: Line", "kind: Line"),
          "curves with type, sharp and vert_indices, found"),
      abc("FeaturesIndexTooLarge", swap(yml, "[0, 1]", "[0, 77]"),
          "every vertex of a sharp line, found an index beyond the vertices"),
      {"FeaturesObjBroken", "edges", kAbc, put("abc/a_trimesh.obj", "v 0 zero 0\n"), 3,
       "a_trimesh.obj: expected three numbers after v, found v 0 zero 0"},
      {"FeaturesObjTooLarge", "edges", kAbc,
       put("abc/a_trimesh.obj", "v 0 0 0\nv 1e9 0 0\nv 1 1 0\n"), 3,
       "sharp curves of at most 100000 units in all, found"},
      {"FeaturesObjFlat", "edges", kAbc, put("abc/a_trimesh.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\n"), 3,
       "a box with a longest side above 0, found"},
      {"StepEmpty", "edges", kStep, put("part.step", ""), 3,
       "part.step: expected a STEP file, found too few bytes"},
      {"StepIsText", "edges", kStep, put("part.step", "solid of revolution"), 3,
       "part.step: expected a STEP file \\(ISO-10303-21\\), found another kind"},
      {"StepCutOff", "edges", kStep, cut("part.step", 0.6), 3,
       "part.step: expected (a STEP file|a shape with faces), found"},
      {"StepWithoutSolid", "edges", kStep, swap("part.step", "1.)", "2.)"), 3,
       "part.step: expected a shape with faces, found none"},
      {"StepRefersToNothing", "edges", kStep, swap("part.step", "#4,1.", "#99,1."), 3,
       "part.step: expected"},
      {"StepOfTenGigabytes", "edges", kStep, blow_up("part.step"), 3,
       "part.step: expected a file of at most 1000 MB, found 10000 MB"},
  };
}

}  // namespace sketchsplat::test
