// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/readers/scene.h"
#include "pipelines/cameras/camera_unknowns.h"

namespace sketchsplat {

/// A quadratic in the values x of CameraUnknowns, in nats up to a constant: x'Ix / 2 + g'x.
struct CameraQuadratic {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

/// What the points of structure from motion say of the cameras that it found: the squared distances
/// of the points' images from their pixels, with all points free to move (Schur's complement),
/// linear about the cameras as they are. Every sight counts with Tukey's biweight, and with the
/// robust scatter of all as its standard deviation. `points`: sights index the unknowns' views;
/// those without a pixel tell nothing.
CameraQuadratic point_prior(const CameraUnknowns& cameras, const std::vector<ScenePoint>& points);

/// [px] Robust standard deviation, in one direction, of what the images of points are off their
/// pixels by; 0 without any.
double points_off_px(const std::vector<View>& views, const std::vector<ScenePoint>& points);

/// The points of a scene as another list of its views, of the same names and files, shows them;
/// none of those of which fewer than two of these views hold a pixel.
std::vector<ScenePoint> points_among(const std::vector<View>& views, const Scene& scene);

/// Points in pictures of 1 / factor the size.
std::vector<ScenePoint> shrunk(std::vector<ScenePoint> points, int factor);

}  // namespace sketchsplat
