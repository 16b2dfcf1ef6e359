// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat {

/// What the part of a photograph is made of.
enum class Finish {
  kPainted,   ///< one colour, a coat that mirrors the lamps a little
  kMetal,     ///< satin metal that mirrors the room
  kPrinted,   ///< plastic in layers, whose lines run around the part
  kSpeckled,  ///< spots through and through, as of stone
};

/// Which axis of the part looks up.
enum class Up { kZ, kMinusZ, kY, kMinusY, kX, kMinusX };

/// Photographs of a part on a table in a room, beside what RenderOptions says.
struct PhotoOptions {
  Finish surface = Finish::kPainted;
  Up up = Up::kZ;
  double distortion = 1;     ///< strength of the lens: 0 is a pinhole, 1 usual, [0, 3]
  bool state_lens = true;    ///< the model in sparse/0 has the lens; else it is a pinhole's
  bool masks = true;         ///< masks are written
  int tag = -1;              ///< id of an AprilTag 36h11 on the table, [-1, 586]; -1: none
  double tag_size = 0;       ///< of its black square [world units]; 0: a quarter of the extent
  double pose_error_px = 0;  ///< RMS shift of the part's edges by the cameras of sparse/0, [0, 50]
};

}  // namespace sketchsplat
