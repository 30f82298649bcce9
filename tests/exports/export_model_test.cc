// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_model.h"

#include <gtest/gtest.h>

#include "support/made_export.h"

namespace hullslam {
namespace {

TEST(ExportModel, EllipsoidsHaveTheirHalfAxes) {
  const ExportModel model = MadeExportModel();
  const std::vector<PlacedObject> placed = PlaceObjects(model.scene, ObjectShape::kEllipsoids);
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_EQ(placed[1].object, &model.scene.objects[1]);
  EXPECT_EQ(placed[1].half_extents, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(placed[1].world_from_shape.translation, Eigen::Vector3d(0.1 * 7, 0.0, 2.0));
}

TEST(ExportModel, BoxesAreUprightIfTheSceneHasThem) {
  const ExportModel model = MadeExportModel();
  const std::vector<PlacedObject> placed = PlaceObjects(model.scene, ObjectShape::kBoxes);
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_EQ(placed[0].half_extents, Eigen::Vector3d(0.5, 0.25, 0.125));
  EXPECT_EQ(placed[0].world_from_shape.translation, Eigen::Vector3d(0.3, 0.1, 2.0));
  EXPECT_EQ(placed[1].half_extents, Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(ExportModel, MeshesAreThoseOfTheShape) {
  EXPECT_EQ(MeshOf(ObjectShape::kBoxes).corners.size(), 8U);
  EXPECT_GT(MeshOf(ObjectShape::kEllipsoids).corners.size(), 100U);
}

}  // namespace
}  // namespace hullslam
