// SPDX-License-Identifier: MIT
// import sketchsplat: the headers of include/sketchsplat for Python, arrays by NumPy.
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

#include "sketchsplat/evaluate.h"
#include "sketchsplat/reconstruct.h"
#include "sketchsplat/version.h"

namespace py = pybind11;
using namespace sketchsplat;

namespace {

using Bytes = py::array_t<std::uint8_t, py::array::c_style>;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// "(3, 4)"
std::string shape_text(const py::array& array) { return py::str(array.attr("shape")); }

Options options_of(const std::string& preset, const std::string& detector, int threads,
                   double min_confidence, const py::object& progress, const py::dict& expert) {
  Options options;
  options.preset = preset, options.detector = detector;
  options.threads = threads, options.min_confidence = min_confidence;
  for (const auto& [key, value] : expert) {
    std::string text = py::str(value);
    if (py::isinstance<py::bool_>(value)) text = value.cast<bool>() ? "true" : "false";
    std::string name = py::str(key);
    for (char& c : name)
      if (c == '_') c = '-';
    options.expert[name] = text;
  }
  if (!progress.is_none())
    options.progress = [progress](const StageProgress& p) {
      const py::gil_scoped_acquire acquire;  // from whatever thread
      try {
        const py::object go_on = progress(p.stage, p.done, p.total);
        return go_on.is_none() || go_on.cast<bool>();
      } catch (py::error_already_set& e) {
        e.discard_as_unraisable("progress of sketchsplat.reconstruct");
        return false;
      }
    };
  return options;
}

// Entry i of what is one for all views (`dims` dimensions) or one for each.
Eigen::MatrixXd one_of(const Numbers& all, py::ssize_t i, py::ssize_t dims, const char* name) {
  const bool each = all.ndim() == dims + 1;
  if (!each && all.ndim() != dims)
    throw py::value_error(std::string(name) + ": unexpected shape " + shape_text(all));
  if (each && i >= all.shape(0))
    throw py::value_error(std::string(name) + ": expected one for each view, found shape " +
                          shape_text(all));
  const py::ssize_t rows = all.shape(each ? 1 : 0), cols = dims == 2 ? all.shape(each ? 2 : 1) : 1;
  Eigen::MatrixXd out(rows, cols);
  const double* data = all.data() + (each ? i * rows * cols : 0);
  for (py::ssize_t r = 0; r < rows; ++r)
    for (py::ssize_t c = 0; c < cols; ++c) out(r, c) = data[r * cols + c];
  return out;
}

void set_camera(const Numbers& K, const Numbers& cam_from_world, const Numbers& distortion,
                bool fisheye, py::ssize_t i, InputView* v) {
  const Eigen::MatrixXd k = one_of(K, i, 2, "K");
  const Eigen::MatrixXd pose = one_of(cam_from_world, i, 2, "cam_from_world");
  if (k.rows() != 3 || k.cols() != 3)
    throw py::value_error("K: expected 3 x 3, found shape " + shape_text(K));
  if (cam_from_world.ndim() != 3 || (pose.rows() != 3 && pose.rows() != 4) || pose.cols() != 4)
    throw py::value_error("cam_from_world: expected N x 3 x 4 or N x 4 x 4, found shape " +
                          shape_text(cam_from_world));
  v->intrinsics = k;
  v->rotation = pose.topLeftCorner<3, 3>(), v->translation = pose.topRightCorner<3, 1>();
  if (distortion.size() > 0) {
    const Eigen::VectorXd d = one_of(distortion, i, 1, "distortion");
    v->distortion.assign(d.data(), d.data() + d.size());
  }
  v->fisheye = fisheye;
}

CurveSketch run(const std::vector<InputView>& views, const Options& options) {
  const py::gil_scoped_release release;
  return reconstruct(views, options);
}

CurveSketch from_images(const std::vector<Bytes>& images, const Numbers& K,
                        const Numbers& cam_from_world, const std::vector<Bytes>& masks,
                        const std::vector<std::string>& names, const Numbers& distortion,
                        bool fisheye, const std::string& preset, const std::string& detector,
                        int threads, double min_confidence, const py::object& progress,
                        const py::dict& expert) {
  if (!masks.empty() && masks.size() != images.size())
    throw py::value_error("masks: expected one for each image");
  if (!names.empty() && names.size() != images.size())
    throw py::value_error("names: expected one for each image");
  std::vector<InputView> views(images.size());
  for (size_t i = 0; i < images.size(); ++i) {
    const Bytes& image = images[i];
    if (image.ndim() != 2 && image.ndim() != 3)
      throw py::value_error("images: expected H x W or H x W x C, found shape " +
                            shape_text(image));
    InputView& v = views[i];
    v.height = int(image.shape(0)), v.width = int(image.shape(1));
    v.channels = image.ndim() == 3 ? int(image.shape(2)) : 1;
    v.pixels = image.data();
    if (!masks.empty()) {
      if (masks[i].ndim() != 2 || masks[i].shape(0) != v.height || masks[i].shape(1) != v.width)
        throw py::value_error("masks: expected the shape of the image, found " +
                              shape_text(masks[i]));
      v.mask = masks[i].data();
    }
    if (!names.empty()) v.name = names[i];
    set_camera(K, cam_from_world, distortion, fisheye, py::ssize_t(i), &v);
  }
  return run(views, options_of(preset, detector, threads, min_confidence, progress, expert));
}

CurveSketch from_edges(const std::vector<std::vector<Numbers>>& edges,
                       const std::pair<int, int>& size, const Numbers& K,
                       const Numbers& cam_from_world, const Numbers& distortion, bool fisheye,
                       const std::string& preset, int threads, double min_confidence,
                       const py::object& progress, const py::dict& expert) {
  std::vector<InputView> views(edges.size());
  for (size_t i = 0; i < edges.size(); ++i) {
    InputView& v = views[i];
    v.width = size.first, v.height = size.second;
    for (const Numbers& edge : edges[i]) {
      if (edge.ndim() != 2 || edge.shape(1) != 2)
        throw py::value_error("edges: expected polylines N x 2, found shape " + shape_text(edge));
      v.edges.push_back(one_of(edge, 0, 2, "edges").transpose());
    }
    set_camera(K, cam_from_world, distortion, fisheye, py::ssize_t(i), &v);
  }
  return run(views, options_of(preset, "image", threads, min_confidence, progress, expert));
}

CurveSketch from_folder(const std::string& scene, const std::string& preset,
                        const std::string& detector, int threads, double min_confidence,
                        const py::object& progress, const py::dict& expert) {
  const Options options = options_of(preset, detector, threads, min_confidence, progress, expert);
  const py::gil_scoped_release release;
  return reconstruct(scene, options);
}

void bind_solid(py::module_* m) {
  py::class_<CurveSolid>(*m, "CurveSolid")
      .def_readonly("faces", &CurveSolid::faces, "How many lie on each kind of surface")
      .def_readonly("volume", &CurveSolid::volume)
      .def_readonly("area", &CurveSolid::area)
      .def(
          "write",
          [](const CurveSolid& s, const std::string& path, double scale, const std::string& unit) {
            WriteOptions options;
            options.scale = scale, options.unit = unit;
            s.write(path, options);
          },
          py::arg("path"), py::kw_only(), py::arg("scale") = 1.0, py::arg("unit") = "mm",
          "Writes its exact boundary as .step");
}

void bind_curves(py::module_* m) {
  py::class_<Curve>(*m, "Curve")
      .def_property_readonly("kind", [](const Curve& c) { return name_of(c.kind); })
      .def_readonly("begin", &Curve::begin, "Index into nodes; -1 if the curve is closed")
      .def_readonly("end", &Curve::end, "Index into nodes; -1 if the curve is closed")
      .def_property_readonly("controls",
                             [](const Curve& c) { return Eigen::MatrixXd(c.controls.transpose()); })
      .def_readonly("length", &Curve::length)
      .def_readonly("center", &Curve::center)
      .def_readonly("normal", &Curve::normal)
      .def_readonly("radius", &Curve::radius)
      .def_readonly("major", &Curve::major)
      .def_readonly("minor", &Curve::minor)
      .def_readonly("views", &Curve::views)
      .def_readonly("confidence", &Curve::confidence)
      .def_readonly("inferred", &Curve::inferred)
      .def_readonly("rms_px", &Curve::rms_px)
      .def_readonly("sigma", &Curve::sigma)
      .def_readonly("covariance", &Curve::covariance)
      .def("__repr__", [](const Curve& c) {
        return "<sketchsplat." + std::string(name_of(c.kind)) + " of length " +
               std::to_string(c.length) + ">";
      });
  py::class_<CurveSketch>(*m, "CurveSketch")
      .def_readonly("curves", &CurveSketch::curves)
      .def_readonly("solid", &CurveSketch::solid, "That the curves bound; None if they tell none")
      .def_property_readonly(
          "nodes", [](const CurveSketch& s) { return Eigen::MatrixXd(s.nodes.transpose()); },
          "N x 3")
      .def_readonly("views", &CurveSketch::views)
      .def_readonly("warnings", &CurveSketch::warnings)
      .def_property_readonly("ending",
                             [](const CurveSketch& s) {
                               return s.ending == Ending::kDone        ? "done"
                                      : s.ending == Ending::kCancelled ? "cancelled"
                                                                       : "too little";
                             })
      .def_readonly("message", &CurveSketch::message)
      .def(
          "sample",
          [](const CurveSketch& s, int curve, double spacing) {
            return Eigen::MatrixXd(s.sample(curve, spacing).transpose());
          },
          py::arg("curve"), py::arg("spacing"), "Points of a curve, N x 3, uniform in arc length")
      .def(
          "write",
          [](const CurveSketch& s, const std::string& path, double scale, const std::string& unit,
             bool faces) {
            WriteOptions options;
            options.scale = scale, options.unit = unit, options.faces = faces;
            s.write(path, options);
          },
          py::arg("path"), py::kw_only(), py::arg("scale") = 1.0, py::arg("unit") = "mm",
          py::arg("faces") = false, "Writes .step, .dxf, .obj, .ply or .json")
      .def("__len__", [](const CurveSketch& s) { return s.curves.size(); });
}

py::dict scores(const CurveSketch& sketch, const std::string& truth, const std::string& protocol) {
  const Scores s = evaluate(sketch, truth, protocol);
  py::dict out;
  out["accuracy"] = s.accuracy, out["completeness"] = s.completeness;
  for (const ScoreLevel& level : s.levels) {
    const std::string n = std::to_string(int(level.threshold * 1000 + 0.5));
    out[("P" + n).c_str()] = level.precision, out[("R" + n).c_str()] = level.recall;
    out[("F" + n).c_str()] = level.f;
  }
  return out;
}

}  // namespace

PYBIND11_MODULE(sketchsplat, m) {
  m.doc() = "Calibrated images of a CAD object become its edges: exact 3D curves.";
  m.attr("__version__") = library_version();
  bind_solid(&m);
  bind_curves(&m);
  const py::dict none;
  const Numbers no_numbers(0);
  m.def("reconstruct", &from_images, py::arg("images"), py::arg("K"), py::arg("cam_from_world"),
        py::kw_only(), py::arg("masks") = std::vector<Bytes>(),
        py::arg("names") = std::vector<std::string>(), py::arg("distortion") = no_numbers,
        py::arg("fisheye") = false, py::arg("preset") = "balanced", py::arg("detector") = "image",
        py::arg("threads") = 0, py::arg("min_confidence") = 0.0, py::arg("progress") = py::none(),
        py::arg("expert") = none,
        "images: N arrays H x W [x 3 or 4] of uint8 (RGB, RGBA); K: 3 x 3 or N x 3 x 3, the centre "
        "of\n"
        "the top-left pixel is (0, 0); cam_from_world: N x 3 x 4, OpenCV axes. progress(stage, "
        "done,\n"
        "total) may return False to cancel. expert: options of `sketchsplat reconstruct "
        "--help-all`.");
  m.def("reconstruct_edges", &from_edges, py::arg("edges"), py::arg("size"), py::arg("K"),
        py::arg("cam_from_world"), py::kw_only(), py::arg("distortion") = no_numbers,
        py::arg("fisheye") = false, py::arg("preset") = "balanced", py::arg("threads") = 0,
        py::arg("min_confidence") = 0.0, py::arg("progress") = py::none(), py::arg("expert") = none,
        "edges: for each view a list of polylines N x 2 in pixels; size: (width, height).");
  m.def("reconstruct_folder", &from_folder, py::arg("scene"), py::kw_only(),
        py::arg("preset") = "balanced", py::arg("detector") = "image", py::arg("threads") = 0,
        py::arg("min_confidence") = 0.0, py::arg("progress") = py::none(), py::arg("expert") = none,
        "A scene folder of any format that the program reads.");
  m.def("read", &read_curves, py::arg("path"), "A sketch.json, or the folder that holds one.");
  m.def("evaluate", &scores, py::arg("sketch"), py::arg("truth"),
        py::arg("protocol") = "sketchsplat",
        "Scores against a scene's ground truth: accuracy, completeness, P20, R20, F20, ... F1.");
}
