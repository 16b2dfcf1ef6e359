// SPDX-License-Identifier: MIT
#include <ostream>

#include "sketches/curve/curve_chain.h"
#include "sketches/io/io.h"
#include "sketches/io/little_endian.h"

namespace sketchsplat {

void write_edge_points(std::ostream& out, const Sketch& sketch, double spacing) {
  std::string bytes;
  int count = 0;
  const std::vector<CurveChain> chains = curve_chains(sketch);
  for (size_t c = 0; c < chains.size(); ++c) {
    const Eigen::Matrix3Xd points = sample_chain(sketch, chains[c], spacing);
    // The last point of a closed curve is its first.
    const int n =
        int(points.cols()) - (is_closed(sketch.strokes[chains[c].strokes[0]].kind) ? 1 : 0);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < 3; ++k) append(float(points(k, i)), &bytes);
      append(uint32_t(c), &bytes);
    }
    count += n;
  }
  out << "ply\nformat binary_little_endian 1.0\ncomment sketchsplat: samples of edges\n"
      << "element vertex " << count << "\n"
      << "property float x\nproperty float y\nproperty float z\nproperty int stroke_index\n"
      << "end_header\n";
  out.write(bytes.data(), std::streamsize(bytes.size()));
}

}  // namespace sketchsplat
