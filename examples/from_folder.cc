// SPDX-License-Identifier: MIT
// from_folder SCENE FILE.step: the edges of a scene folder, for a CAD program.
#include <sketchsplat/evaluate.h>
#include <sketchsplat/reconstruct.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  sketchsplat::Options options;
  options.preset = "fast";
  options.expert["rounds"] = "2";  // anything that sketchsplat reconstruct --help-all lists
  options.progress = [](const sketchsplat::StageProgress& p) {
    if (p.done == 0) std::cerr << p.stage << "\n";
    return true;  // false: enough
  };
  const sketchsplat::CurveSketch sketch = sketchsplat::reconstruct(argv[1], options);
  for (const sketchsplat::Curve& curve : sketch.curves)
    std::cout << name_of(curve.kind) << " of length " << curve.length << "\n";
  if (sketch.solid) std::cout << "solid of volume " << sketch.solid->volume << "\n";
  sketchsplat::WriteOptions cad;
  cad.scale = 100;  // millimetres per unit of the scene
  sketch.write(argv[2], cad);
  std::cout << "F5 " << sketchsplat::evaluate(sketch, argv[1]).levels[2].f << "\n";
  return sketch.ending == sketchsplat::Ending::kDone ? 0 : 1;
} catch (const std::exception& e) {
  std::cerr << e.what() << "\n";
  return 1;
}
