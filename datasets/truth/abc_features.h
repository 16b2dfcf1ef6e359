// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sketchsplat {

/// Curves of an ABC model in the units of its files.
struct AbcModel {
  struct Curve {
    std::string type;  ///< lower case
    bool sharp = false;
    Eigen::Matrix3Xd polyline;  ///< 3 x N
  };
  std::vector<Curve> curves;
  double scale =
      1;  ///< unit cube = raw * scale + offset: longest side 1, centre at (0.5, 0.5, 0.5)
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// Reads the curves of an ABC features file. `obj` may be empty: then vertices are rebuilt from the
/// parameters of lines and circles. `stats` may be empty: then the box is the one of the OBJ.
/// `id` is the model's key in `stats`.
/// Throws InputError (broken files, indices beyond the vertices, a sharp curve that nothing gives).
AbcModel read_abc_model(const std::string& features, const std::string& obj,
                        const std::string& stats, const std::string& id);

}  // namespace sketchsplat
