// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <vector>

#include "sketches/curve/conic.h"
#include "sketches/curve/curve_chain.h"
#include "sketches/graph/face.h"
#include "sketches/graph/sketch.h"

namespace sketchsplat::step {

// What the writers of STEP share (ISO 10303-21 text, entities of ISO 10303-42); no public header.

std::string real(double x);                     ///< always with a point, exponent E
std::string quoted(const std::string& text);    ///< UTF-8 as a string literal
std::string reference(int id);                  ///< "#12"
std::string list(const std::vector<int>& ids);  ///< "(#1,#2)"

/// Writes numbered entities; every method returns the number of the one that stands for the whole.
/// Lengths and points are in world units and multiplied by `scale`.
class StepFile {
 public:
  StepFile(std::ostream& out, double scale) : out_(out), scale_(scale) {}

  int add(const std::string& entity);
  int point(const Eigen::Vector3d& p);
  int direction(const Eigen::Vector3d& d);
  int vertex(const Eigen::Vector3d& p);
  int placement(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                const Eigen::Vector3d& x);
  int line(const Eigen::Vector3d& begin, const Eigen::Vector3d& end);
  int circle(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, const Eigen::Vector3d& x,
             double radius);
  int ellipse(const Eigen::Vector3d& centre, const EllipseAxes& axes);
  int spline(const Spline& spline);

 private:
  std::ostream& out_;
  double scale_;
  int last_ = 0;
};

/// A unit vector square to a unit normal, along the world's axes as far as it can be.
Eigen::Vector3d plain_direction(const Eigen::Vector3d& normal);

/// One OPEN_SHELL for each set of faces that share strokes, in one SHELL_BASED_SURFACE_MODEL;
/// `edges`: EDGE_CURVE of every stroke. Appends the entities of the faces.
int write_surface_model(StepFile* file, const std::vector<PlanarFace>& faces,
                        const std::vector<int>& edges, const std::string& name,
                        std::vector<int>* face_ids);

}  // namespace sketchsplat::step
