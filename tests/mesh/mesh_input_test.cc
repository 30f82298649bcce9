// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh_input.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/settings/settings.h"
#include "support/expect_error.h"
#include "support/plane_sequence.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class OpenMesh : public ::testing::Test {
 protected:
  // Writes a run of the sequence. `alignment` is that of its summary.
  std::filesystem::path WriteRun(const std::string& sequence, const std::string& alignment) {
    folder_.Write("run/summary.json",
                  R"({"trajectory": {"alignment": ")" + alignment +
                      R"("}, "map": {"keyframes": 1, "landmarks": 1}, "provenance": {"program": )"
                      R"("rgbd_tum", "dataset": "tum", "sequence": ")" +
                      sequence + "\"}}");
    const Trajectory truth = ReadTrajectory(plane_.path() / "groundtruth.txt");
    folder_.Write("run/trajectory.txt", FormatTrajectory(truth));
    folder_.Write("run/keyframes.txt", FormatTrajectory({truth[0], truth[2]}));
    return folder_.path() / "run";
  }

  PlaneSequence plane_{4};
  TemporaryFolder folder_;
};

TEST_F(OpenMesh, ReadsWhatTheRunHasWritten) {
  const std::filesystem::path run = WriteRun(plane_.path(), "se3");
  ExpectInputError([&] { OpenMeshInput({.input = run}); }, {"settings.yaml", "--settings FILE"});
  EXPECT_EQ(
      OpenMeshInput({.input = run, .settings = plane_.path() / "camera.yaml"}).options.camera.fx,
      500.0);
  folder_.Write("run/settings.yaml", FormatSettings(ReadSettings(plane_.path() / "camera.yaml")));
  const MeshInput input = OpenMeshInput({.input = run});
  EXPECT_EQ(input.poses.size(), 4U);
  EXPECT_EQ(input.keyframes.size(), 2U);
  EXPECT_EQ(input.sequence.frames.size(), 4U);
  EXPECT_EQ(HashSettings(input.options), HashSettings(ReadSettings(plane_.path() / "camera.yaml")));
  EXPECT_EQ(OpenMeshInput({.input = run, .overrides = {"DepthMapFactor=1000"}})
                .options.depth.units_per_metre,
            1000.0);
}

TEST_F(OpenMesh, ExplainsWhatIsMissing) {
  ExpectInputError([&] { OpenMeshInput({.input = folder_.path() / "none"}); },
                   {"none", "does not exist"});
  ExpectInputError([&] { OpenMeshInput({.input = folder_.path()}); }, {"summary.json"});
  const std::filesystem::path file = folder_.Write("not.map", "text");
  ExpectInputError([&] { OpenMeshInput({.input = file}); }, {"not.map", "--sequence PATH"});
  ExpectInputError([&] { OpenMeshInput({.input = file, .sequence = plane_.path()}); }, {"not.map"});
  const std::filesystem::path run = WriteRun("/gone", "sim3");
  folder_.Write("run/settings.yaml", FormatSettings(ReadSettings(plane_.path() / "camera.yaml")));
  ExpectInputError([&] { OpenMeshInput({.input = run}); }, {"monocular", "stereo"});
  WriteRun("/gone", "se3");
  ExpectInputError([&] { OpenMeshInput({.input = run}); }, {"'/gone'", "--sequence PATH"});
  EXPECT_EQ(OpenMeshInput({.input = run, .sequence = plane_.path()}).poses.size(), 4U);
  std::filesystem::remove_all(plane_.path() / "depth");
  std::filesystem::remove(plane_.path() / "depth.txt");
  EXPECT_THROW(OpenMeshInput({.input = run, .sequence = plane_.path()}), InputError);
}

}  // namespace
}  // namespace hullslam
