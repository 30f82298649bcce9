// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>

#include "hullslam/report/object_report.h"

namespace hullslam {

// A binary little-endian PLY of points `float x y z, uchar red green blue` in metres of the world:
// landmarks in grey, then the centres of the keyframes in orange.
std::string FormatPly(std::span<const Eigen::Vector3d> landmarks,
                      std::span<const Eigen::Vector3d> keyframes);

// Writes FormatPly() by WriteFileAtomically().
void WritePly(const std::filesystem::path& path, std::span<const Eigen::Vector3d> landmarks,
              std::span<const Eigen::Vector3d> keyframes);

// A binary little-endian PLY of the mapped objects' ellipsoids as triangles: vertices as above and
// faces `uchar 3, int a b c`, whose corners go anticlockwise seen from outside. The colour tells
// the class; the same class has the same colour in every run.
std::string FormatObjectsPly(std::span<const ReportedObject> objects);

}  // namespace hullslam
