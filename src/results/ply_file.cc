// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_file.h"

#include "results/ply_points.h"
#include "results/ply_writer.h"

namespace hullslam {

std::string FormatMapPly(std::span<const Eigen::Vector3d> landmarks,
                         std::span<const Eigen::Vector3d> keyframes) {
  constexpr Colour kGrey = {128, 128, 128};
  PlyWriter file;
  for (const Eigen::Vector3d& landmark : landmarks) {
    file.AddPoint(landmark, kGrey);
  }
  for (const Eigen::Vector3d& center : keyframes) {
    file.AddPoint(center, kKeyframeColour);
  }
  return file.PointFile();
}

std::string FormatObjectsPly(std::span<const ObjectResult> objects) {
  const TriangleMesh sphere = UnitSphere();
  PlyWriter file;
  for (const ObjectResult& object : objects) {
    if (object.state == ObjectState::kMapped) {
      file.AddMesh(sphere, object.ellipsoid.world_from_object, object.ellipsoid.half_axes,
                   ColourOfClass(object.label));
    }
  }
  return file.MeshFile();
}

}  // namespace hullslam
