// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_input.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hullslam/map_files/map_file.h"
#include "results/ply_file.h"
#include "support/expect_error.h"
#include "support/made_export.h"
#include "support/synthetic_world.h"
#include "support/temporary_folder.h"

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

constexpr const char* kPoses =
    "1.0 0 0 0 0 0 0 1\n"
    "2.0 1 0 0 0 0 0 1\n";

// The folder of a run with two keyframes and three landmarks, and a map with other numbers.
class ExportInputTest : public ::testing::Test {
 protected:
  ExportInputTest() {
    folder_.Write("run/trajectory.txt", std::string("0.5 0 0 0 0 0 0 1\n") + kPoses);
    folder_.Write("run/keyframes.txt", kPoses);
    folder_.Write("run/map.ply",
                  FormatMapPly(std::vector<Eigen::Vector3d>(3, Eigen::Vector3d(1.0, 2.0, 3.0)),
                               std::vector<Eigen::Vector3d>(2, Eigen::Vector3d::Zero())));
    WriteSummary(2, 3, "");
    source_.input = folder_.path() / "run";
  }
  void WriteSummary(size_t keyframes, size_t landmarks, const std::string& map) const {
    folder_.Write("run/summary.json",
                  "{\"trajectory\": {\"alignment\": \"se3\"}, \"map\": {\"keyframes\": " +
                      std::to_string(keyframes) + ", \"landmarks\": " + std::to_string(landmarks) +
                      "}, \"provenance\": {\"program\": \"rgbd_tum\", \"sequence\": \"desk\", "
                      "\"masks\": null, \"map\": " +
                      (map.empty() ? "null" : "\"" + map + "\"") + "}}");
  }
  // Writes a map of the synthetic world beside the run, and returns it.
  Map WriteMapBeside(const std::string& name) const {
    const SyntheticWorld world;
    Map map = MakeSyntheticMap(world, {0, 10, 20}).map;
    WriteMap(folder_.path() / name, map, {.camera = world.sensor().camera});
    return map;
  }

  TemporaryFolder folder_;
  ExportSource source_;
};

TEST_F(ExportInputTest, PosesNeedNoMap) {
  const ExportInput input = ReadExportInput(source_, ExportNeed::kPoses);
  EXPECT_EQ(input.model.trajectory.size(), 3U);
  EXPECT_TRUE(input.notes.empty());
}

TEST_F(ExportInputTest, WithoutAMapThePointsAreThoseOfTheRun) {
  const ExportInput input = ReadExportInput(source_, ExportNeed::kScene);
  ASSERT_EQ(input.model.points.size(), 3U) << "without the centres of the keyframes";
  EXPECT_EQ(input.model.points[0].position, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(input.model.keyframes.size(), 2U);
  EXPECT_FALSE(input.map);
  EXPECT_EQ(input.notes.size(), 1U);
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kMap); },
                   {"has not saved its map", "--save-map", "--map"});
}

TEST_F(ExportInputTest, TheMapIsFoundBesideTheRun) {
  const Map map = WriteMapBeside("desk.map");
  WriteSummary(map.keyframes().size(), map.landmarks().size(), "desk.map");
  const ExportInput input = ReadExportInput(source_, ExportNeed::kMap);
  ASSERT_TRUE(input.map);
  EXPECT_EQ(input.map->map.keyframes().size(), 3U);
  EXPECT_EQ(input.model.points.size(), input.map->located.positions.size());
  EXPECT_EQ(input.model.keyframes.size(), 3U);
  WriteSummary(map.keyframes().size(), map.landmarks().size(), "other.map");
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kMap); },
                   {"'other.map' is not found"});
  source_.map = folder_.path() / "desk.map";
  EXPECT_TRUE(ReadExportInput(source_, ExportNeed::kMap).map);
}

TEST_F(ExportInputTest, AnotherMapIsRefused) {
  WriteMapBeside("desk.map");
  WriteSummary(2, 3, "desk.map");
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kMap); },
                   {"desk.map", "3 keyframes", "the run had 2 and 3"});
}

TEST_F(ExportInputTest, ImagesNeedTheSequence) {
  const Map map = WriteMapBeside("desk.map");
  WriteSummary(map.keyframes().size(), map.landmarks().size(), "desk.map");
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kImages); },
                   {"'desk'", "--sequence"});
  const ExportInput input = ReadExportInput(source_, ExportNeed::kScene);
  EXPECT_FALSE(input.sequence);
  EXPECT_EQ(input.notes.size(), 1U);
}

TEST_F(ExportInputTest, AMapAloneIsEnoughWithoutImages) {
  const Map map = WriteMapBeside("desk.map");
  source_.input = folder_.path() / "desk.map";
  const ExportInput input = ReadExportInput(source_, ExportNeed::kPoses);
  EXPECT_EQ(input.model.trajectory.size(), 3U);
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kImages); }, {"desk.map", "images"});
  source_.sequence = folder_.path();
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kPoses); }, {"--sequence"});
}

TEST_F(ExportInputTest, BrokenFilesAreNamed) {
  folder_.Write("run/summary.json", "{\"trajectory\": 3}");
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kPoses); },
                   {"summary.json", "trajectory is 3"});
  folder_.Write("run/summary.json", "{");
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kPoses); }, {"summary.json"});
  source_.input = folder_.path() / "nothing";
  ExpectInputError([&] { ReadExportInput(source_, ExportNeed::kPoses); },
                   {"nothing", "does not exist"});
}

}  // namespace

}  // namespace hullslam
