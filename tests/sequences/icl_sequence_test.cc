// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/icl_sequence.h"

#include <gtest/gtest.h>

#include <string>

#include "hullslam/results/trajectory_file.h"
#include "support/expect_error.h"
#include "support/made_room.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class IclSequenceTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 16;

  IclSequence Open(const IclSequenceOptions& options = {}) {
    return OpenIclSequence(folder_.path(), room_.camera(), DepthOptions(), options);
  }
  // The ground truth of the folder cannot be used, and nobody asked for it.
  void ExpectWarning(const std::vector<std::string>& parts) {
    const ImageSequence images = Open().images;
    EXPECT_FALSE(images.converted_groundtruth.has_value());
    ASSERT_EQ(images.warnings.size(), 1U);
    for (const std::string& part : parts) {
      EXPECT_NE(images.warnings[0].find(part), std::string::npos) << images.warnings[0];
    }
  }
  void ExpectError(const std::vector<std::string>& parts, const IclSequenceOptions& options = {}) {
    ExpectInputError([&] { Open(options); }, parts);
  }
  void ExpectTruePoses(const IclSequence& sequence, int first) {
    ASSERT_TRUE(sequence.images.converted_groundtruth.has_value());
    const Trajectory& poses = *sequence.images.converted_groundtruth;
    ASSERT_EQ(poses.size(), static_cast<size_t>(kFrames - first));
    for (int i = first; i < kFrames; ++i) {
      EXPECT_EQ(poses[i - first].timestamp, i / 30.0);
      EXPECT_TRUE(
          poses[i - first].world_from_cam.ToMatrix().isApprox(MadeRoom::Pose(i).ToMatrix(), 1e-6));
    }
  }

  TemporaryFolder folder_;
  MadeRoom room_{4};
};

TEST_F(IclSequenceTest, BothAxesGiveTheTruePoses) {
  for (const bool is_up : {true, false}) {
    room_.WriteIclTum(folder_.path(), kFrames, is_up);
    const IclSequence sequence = Open();
    ASSERT_EQ(sequence.images.frames.size(), 16U);
    EXPECT_EQ(sequence.images.frames[2].timestamp, 2.0 / 30.0);
    EXPECT_EQ(sequence.images.frames[2].image, folder_.path() / "rgb/2.png");
    EXPECT_EQ(sequence.images.frames[2].depth, folder_.path() / "depth/2.png");
    ExpectTruePoses(sequence, 1);
    const std::string word = is_up ? "with y up, mirrored (" : "with y down (";
    EXPECT_NE(sequence.groundtruth_note.find(word), std::string::npos) << sequence.groundtruth_note;
    EXPECT_FALSE(sequence.images.groundtruth.has_value());
  }
}

// A point that one frame measured, moved to another frame by the converted poses, has the depth
// that the other frame measured.
TEST_F(IclSequenceTest, ConvertedPosesExplainThePixels) {
  room_.WriteIclTum(folder_.path(), kFrames, true);
  const IclSequence sequence = Open();
  const Trajectory& poses = *sequence.images.converted_groundtruth;
  const ImageInput from = sequence.images.load(sequence.images.frames[1], room_.camera());
  const ImageInput to = sequence.images.load(sequence.images.frames[15], room_.camera());
  const Eigen::Vector2d pixel(70.0, 50.0);
  const double depth = SampleDepth(from.depth, pixel.cast<float>(), 5000.0);
  const Eigen::Vector3d moved = Inverse(poses[14].world_from_cam) *
                                (poses[0].world_from_cam * room_.camera().Unproject(pixel, depth));
  const Eigen::Vector2f seen = room_.camera().Project(moved).cast<float>();
  EXPECT_GT((seen.cast<double>() - pixel).norm(), 3.0);
  EXPECT_NEAR(SampleDepth(to.depth, seen, 5000.0), moved.z(), 0.02);
}

TEST_F(IclSequenceTest, AnAxisThatTheUserGivesIsNotMeasured) {
  room_.WriteIclTum(folder_.path(), kFrames, true);
  const IclSequence down = Open({.groundtruth_y = CameraYAxis::kDown});
  EXPECT_TRUE(down.images.converted_groundtruth->front().world_from_cam.ToMatrix().isApprox(
      MadeRoom::PoseWithYUp(1).ToMatrix(), 1e-6));
  ExpectTruePoses(Open({.groundtruth_y = CameraYAxis::kUp}), 1);
}

TEST_F(IclSequenceTest, AnUnclearAxisIsAskedFor) {
  room_.WriteIclTum(folder_.path(), kFrames, true);
  std::string wrong;
  for (int i = 0; i < kFrames; ++i) {
    wrong += std::to_string(i) + (i % 2 == 0 ? " 0 0 0 0 0 0 1\n" : " 0 1 0 0 0 0.7 0.7\n");
  }
  folder_.Write("made.gt.freiburg", wrong);
  ExpectWarning({"made.gt.freiburg", "of the depth agrees", "--groundtruth-y up or down"});
  ExpectError({"of the depth agrees"}, {.groundtruth = folder_.path() / "made.gt.freiburg"});
  folder_.Write("made.gt.freiburg", "1000 0 0 0 0 0 0 1\n");
  ExpectWarning({"made.gt.freiburg", "no two depth images", "--groundtruth-y up or down"});
}

TEST_F(IclSequenceTest, AMotionThatTheMirrorDoesNotChangeNeedsNoAnswer) {
  room_.WriteIclTum(folder_.path(), kFrames, true);
  for (int i = 1; i < kFrames; ++i) {
    std::filesystem::copy_file(folder_.path() / "depth/0.png",
                               folder_.path() / ("depth/" + std::to_string(i) + ".png"),
                               std::filesystem::copy_options::overwrite_existing);
  }
  folder_.Write("made.gt.freiburg", "1 0 1 0 0 0 0 1\n15 0 1 0 0 0 0 1\n");
  EXPECT_EQ(Open().images.converted_groundtruth->front().world_from_cam.translation.y(), -1.0);
}

TEST_F(IclSequenceTest, FoldersOfAnotherKindAreRefused) {
  ExpectError({"associations.txt", "No such file"});
  folder_.Write("scene_00_0000.png", "");
  ExpectError({"package for POV-Ray", "TUM RGB-D compatible PNGs"});
  folder_.Write("associations.txt", "0 depth/0.png 0 rgb/0.png\n");
  ExpectError({"rgb/0.png: the image is missing"});
  ExpectInputError([&] { OpenIclSequence("/no/such", room_.camera(), DepthOptions()); },
                   {"/no/such", "no such folder"});
}

TEST_F(IclSequenceTest, BrokenAssociationsAreReported) {
  const auto expect = [&](const std::string& line, const std::vector<std::string>& parts) {
    folder_.Write("associations.txt", "3 depth/3.png 3 rgb/3.png\n" + line + '\n');
    ExpectError(parts);
  };
  expect("4 depth/4.png 4", {"associations.txt:2: ", "3 column(s), expected 4: index depth index"});
  expect("2 depth/4.png 2 rgb/4.png", {"associations.txt:2: ", "does not come after"});
  expect("4 depth/4.png 5 rgb/5.png", {"associations.txt:2: ", "'4' and '5' differ"});
  expect("4 rgb/4.png 4 depth/4.png", {"associations.txt:2: ", "depth image first"});
  expect("1305031102.175304 a.png 1305031102.175304 b.png",
         {"associations.txt:2: ", "'1305031102.175304'", "index of a frame", "TUM"});
  expect("x depth/4.png 4 rgb/4.png", {"associations.txt:2: ", "'x'"});
  expect("4 depth/4.png -4 rgb/4.png", {"associations.txt:2: ", "'-4'"});
  folder_.Write("associations.txt", "");
  ExpectError({"associations.txt", "has no images"});
}

TEST_F(IclSequenceTest, OneOfSeveralGroundTruthsIsAskedFor) {
  room_.WriteIclTum(folder_.path(), kFrames, true);
  folder_.Write("groundtruth.txt", "");
  ExpectWarning({"groundtruth.txt and made.gt.freiburg", "--groundtruth FILE"});
  ExpectTruePoses(Open({.groundtruth = folder_.path() / "made.gt.freiburg"}), 1);
  ExpectError({"none.txt"}, {.groundtruth = folder_.path() / "none.txt"});
}

TEST_F(IclSequenceTest, SelectsFramesAndLeavesOutDepth) {
  room_.WriteIclTum(folder_.path(), kFrames, true);
  const IclSequence some = Open({.selection = {.first = 2, .last = 14, .stride = 6}});
  ASSERT_EQ(some.images.frames.size(), 3U);
  EXPECT_EQ(some.images.frames[1].number, 8U);
  EXPECT_EQ(some.images.available, 16U);
  const IclSequence mono = Open({.use_depth = false});
  EXPECT_TRUE(mono.images.frames[1].depth.empty());
  ExpectTruePoses(mono, 1);
  std::filesystem::remove(folder_.path() / "made.gt.freiburg");
  EXPECT_EQ(Open().groundtruth_note, "");
}

}  // namespace
}  // namespace hullslam
