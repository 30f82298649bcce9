// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "report/object_results.h"

namespace hullslam {

// A binary little-endian PLY with points `float x y z, uchar red green blue`, in metres in the
// world frame: first the landmarks in grey, then the centres of the keyframes in orange.
std::string FormatMapPly(std::span<const Eigen::Vector3d> landmarks,
                         std::span<const Eigen::Vector3d> keyframes);

// A binary little-endian PLY with the ellipsoids of the mapped objects as triangles. The vertices
// have the same properties as above; the faces are `uchar 3, int a b c`, with corners in
// anticlockwise order seen from outside. The colour shows the class; a class has the same colour in
// every run.
std::string FormatObjectsPly(std::span<const ObjectResult> objects);

}  // namespace hullslam
