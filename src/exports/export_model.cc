// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_model.h"

namespace hullslam {

std::vector<PlacedObject> PlaceObjects(const Scene& scene, ObjectShape shape) {
  std::vector<PlacedObject> placed;
  for (const SceneObject& object : scene.objects) {
    if (shape == ObjectShape::kBoxes && object.box) {
      placed.push_back({&object, object.box->world_from_box, object.box->half_extents});
    } else {
      placed.push_back({&object, object.ellipsoid.world_from_object, object.ellipsoid.half_axes});
    }
  }
  return placed;
}

TriangleMesh MeshOf(ObjectShape shape) {
  return shape == ObjectShape::kBoxes ? UnitCube() : UnitSphere();
}

}  // namespace hullslam
