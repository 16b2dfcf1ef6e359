// SPDX-License-Identifier: MIT
#include <cstring>

#include "edges/surfels/fit/surfel_field.h"

namespace sketchsplat {

std::string surfel_ply(const SurfelField& field) {
  constexpr double kY00 = 0.28209479177387814;  // colour = 1/2 + Y00 f_dc
  const SurfelCloud cloud = field.cloud();
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(cloud.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                           "scale_0", "scale_1", "rot_0", "rot_1", "rot_2", "rot_3"})
    out += std::string("property float ") + name + "\n";
  out += "end_header\n";
  for (int i = 0; i < cloud.size(); ++i) {
    Eigen::Matrix<float, 16, 1> row;
    row << cloud.center.col(i).cast<float>(),
        surfel_normal(cloud.rotation.col(i)).cast<float>(),
        ((cloud.color.col(i).array() - 0.5) / kY00).matrix().cast<float>(), float(cloud.opacity[i]),
        cloud.log_scale.col(i).cast<float>(), cloud.rotation.col(i).normalized().cast<float>();
    char bytes[sizeof(float) * 16];
    std::memcpy(bytes, row.data(), sizeof bytes);
    out.append(bytes, sizeof bytes);
  }
  return out;
}

}  // namespace sketchsplat
