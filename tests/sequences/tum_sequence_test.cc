// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/tum_sequence.h"

#include <gtest/gtest.h>

#include <string>

#include "hullslam/util/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

class TumSequenceTest : public ::testing::Test {
 protected:
  TumSequenceTest() {
    for (const char* const name : {"a.png", "b.png", "c.png", "d.png"}) {
      folder_.Write(std::string("rgb/") + name, "");
      folder_.Write(std::string("depth/") + name, "");
    }
    WriteRgb("1.00 rgb/a.png\n1.03 rgb/b.png\n1.06 rgb/c.png\n1.09 rgb/d.png\n");
    WriteDepth("0.99 depth/a.png\n1.05 depth/b.png\n1.095 depth/c.png\n");
  }

  void WriteRgb(const std::string& lines) { folder_.Write("rgb.txt", "# head\r\n" + lines); }
  void WriteDepth(const std::string& lines) { folder_.Write("depth.txt", lines); }
  ImageSequence Open(const TumSequenceOptions& options = {}) {
    return OpenTumSequence(folder_.path(), options);
  }
  void ExpectError(const std::vector<std::string>& parts, const TumSequenceOptions& options = {}) {
    ExpectInputError([&] { Open(options); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(TumSequenceTest, PairsImagesAndCountsUnpairedOnes) {
  const ImageSequence sequence = Open();
  ASSERT_EQ(sequence.frames.size(), 3U);
  EXPECT_EQ(sequence.unpaired,
            1U);  // 1.03: its nearest depth image is paired with 1.06, which is closer
  EXPECT_EQ(sequence.frames[1].timestamp, 1.06);
  EXPECT_EQ(sequence.frames[1].image, folder_.path() / "rgb/c.png");
  EXPECT_EQ(sequence.frames[1].depth, folder_.path() / "depth/b.png");
  EXPECT_NEAR(sequence.frames[1].depth_delay, -0.01, 1e-9);
  EXPECT_FALSE(sequence.groundtruth.has_value());
  folder_.Write("groundtruth.txt", "");
  EXPECT_EQ(Open().groundtruth, folder_.path() / "groundtruth.txt");
}

TEST_F(TumSequenceTest, NamesMayHaveTheSeparatorsOfWindows) {
  WriteRgb("1.0 rgb\\a.png\n");
  EXPECT_EQ(Open({.use_depth = false}).frames.at(0).image, folder_.path() / "rgb/a.png");
}

// Recorders repeat rows, and copies of data sets lack images. One such row does not end a run.
TEST_F(TumSequenceTest, SingleRowsThatCannotBeUsedAreLeftOutWithOneWarning) {
  std::string rows;
  for (int i = 0; i < 30; ++i) {
    rows += std::to_string(i) + " rgb/" + (i == 7 ? "gone" : "a") + ".png\n";
    rows += i == 20 ? "20 rgb/b.png\n19.5 rgb/b.png\n" : "";
  }
  WriteRgb(rows);
  const ImageSequence sequence = Open({.use_depth = false});
  ASSERT_EQ(sequence.frames.size(), 29U);
  EXPECT_EQ(sequence.available, 30U);
  EXPECT_EQ(sequence.frames[7].number, 8U);
  ASSERT_EQ(sequence.warnings.size(), 2U);
  EXPECT_NE(sequence.warnings[0].find("rgb.txt:23: time stamp 20.000000 does not come after"),
            std::string::npos)
      << sequence.warnings[0];
  EXPECT_NE(sequence.warnings[0].find("; 2 of the 32 images"), std::string::npos);
  EXPECT_NE(sequence.warnings[1].find("gone.png: the image is missing; 1 of the 30 frames"),
            std::string::npos)
      << sequence.warnings[1];
}

TEST_F(TumSequenceTest, WithoutImagesReturnsStampsAndExistingDepthImages) {
  std::filesystem::remove(folder_.path() / "rgb/c.png");
  std::filesystem::remove(folder_.path() / "depth/b.png");
  ExpectError({"the image is missing"});
  const ImageSequence some = Open({.need_images = false});
  ASSERT_EQ(some.frames.size(), 3U);
  EXPECT_EQ(some.frames[0].depth, folder_.path() / "depth/a.png");
  EXPECT_TRUE(some.frames[1].depth.empty());
  std::filesystem::remove(folder_.path() / "depth.txt");
  const ImageSequence none = Open({.need_images = false});
  ASSERT_EQ(none.frames.size(), 4U);
  EXPECT_TRUE(none.frames[0].depth.empty());
  EXPECT_EQ(none.frames[3].timestamp, 1.09);
}

TEST_F(TumSequenceTest, WithoutDepthAllImagesAreFrames) {
  std::filesystem::remove(folder_.path() / "depth.txt");
  const ImageSequence all = Open({.use_depth = false});
  ASSERT_EQ(all.frames.size(), 4U);
  EXPECT_EQ(all.unpaired, 0U);
  EXPECT_EQ(all.frames[1].image, folder_.path() / "rgb/b.png");
  EXPECT_TRUE(all.frames[1].depth.empty());
  const auto path = folder_.Write("assoc.txt", "1.0 rgb/a.png 7.5 depth/none.png\n");
  const ImageSequence listed = Open({.associations = path, .use_depth = false});
  ASSERT_EQ(listed.frames.size(), 1U);
  EXPECT_TRUE(listed.frames[0].depth.empty());
  std::filesystem::remove(folder_.path() / "rgb/d.png");
  ExpectError({"rgb/d.png: the image is missing"}, {.use_depth = false});
}

TEST_F(TumSequenceTest, LongLinesAndNamesAreRefused) {
  WriteRgb("1.00 " + std::string(2'000, 'a') + "\n");
  ExpectError({"rgb.txt:2: ", "the name of the file has 2000 bytes"});
  WriteRgb("1.00 " + std::string(2'000'000, 'a') + "\n");
  ExpectError({"rgb.txt:2: ", "a line of 2000005 bytes"});
  WriteRgb("1e300 rgb/a.png\n");
  ExpectError({"rgb.txt:2: ", "timestamp is '1e300'", "in seconds"});
}

TEST_F(TumSequenceTest, SelectsFrames) {
  const auto stamps = [&](const FrameSelection& selection) {
    std::vector<double> result;
    for (const FramePaths& frame : Open({.associations = {}, .selection = selection}).frames) {
      result.push_back(frame.timestamp);
    }
    return result;
  };
  EXPECT_EQ(stamps({}), (std::vector<double>{1.00, 1.06, 1.09}));
  EXPECT_EQ(stamps({.first = 1}), (std::vector<double>{1.06, 1.09}));
  EXPECT_EQ(stamps({.last = 1}), (std::vector<double>{1.00, 1.06}));
  EXPECT_EQ(stamps({.stride = 2}), (std::vector<double>{1.00, 1.09}));
  EXPECT_EQ(stamps({.stride = 5}), (std::vector<double>{1.00}));
  const auto expect = [&](const FrameSelection& selection, const std::vector<std::string>& parts) {
    ExpectError(parts, {.associations = {}, .selection = selection});
  };
  expect({.first = 3}, {"--first is '3'", "less than the 3 frames"});
  expect({.first = 2, .last = 1}, {"--first is '2'", "--last, '1'"});
  expect({.stride = 0}, {"--stride is '0'"});
}

TEST_F(TumSequenceTest, AnAssociationFileReplacesPairingByTime) {
  const auto path = folder_.Write(
      "assoc.txt", "# head\n1.0 rgb/a.png 7.5 depth/d.png\n1.5 rgb/b.png 1.51 depth/b.png\n");
  const ImageSequence sequence = Open({.associations = path, .selection = {}});
  ASSERT_EQ(sequence.frames.size(), 2U);
  EXPECT_EQ(sequence.frames[0].depth_delay, 0.0) << "stamps that far apart are of something else";
  EXPECT_NEAR(sequence.frames[1].depth_delay, 0.01, 1e-9);
  EXPECT_EQ(sequence.frames[0].depth, folder_.path() / "depth/d.png");
  EXPECT_EQ(sequence.unpaired, 0U);
}

TEST_F(TumSequenceTest, BrokenAssociationsAreReported) {
  const auto expect = [&](const std::string& lines, const std::vector<std::string>& parts) {
    ExpectError(parts, {.associations = folder_.Write("assoc.txt", lines), .selection = {}});
  };
  const std::string good = "1.0 rgb/a.png 1.0 depth/a.png\n";
  expect(good + "1.5 rgb/b.png 1.5\n", {"assoc.txt:2: ", "3 column(s), expected 4"});
  expect(good + "0.9 rgb/b.png 0.9 depth/b.png\n", {"assoc.txt:2: ", "does not come after"});
  expect(good + "1.5 rgb/b.png x depth/b.png\n", {"assoc.txt:2: ", "timestamp of depth is 'x'"});
  expect(good + "1.5 rgb/x.png 1.5 depth/b.png\n", {"rgb/x.png: the image is missing"});
  expect("", {"assoc.txt", "has no images"});
  ExpectError({"none.txt", "No such file"},
              {.associations = folder_.path() / "none.txt", .selection = {}});
}

TEST_F(TumSequenceTest, BrokenListsAreReported) {
  const auto expect = [&](const std::string& line, const std::vector<std::string>& parts) {
    WriteRgb("1.00 rgb/a.png\n" + line + "\n");
    ExpectError(parts);
  };
  expect("0.50 rgb/b.png", {"rgb.txt:3: ", "0.500000 does not come after"});
  expect("nan rgb/b.png", {"rgb.txt:3: ", "timestamp is 'nan'"});
  expect("stamp rgb/b.png", {"rgb.txt:3: ", "timestamp is 'stamp'"});
  expect("1.01", {"rgb.txt:3: ", "1 column(s), expected 2"});
  expect("1.05 rgb/x.png", {"rgb/x.png: the image is missing"});
  WriteRgb("");
  ExpectError({"rgb.txt", "has no images"});
}

TEST_F(TumSequenceTest, WithoutPairsTheSmallestGapIsReported) {
  WriteDepth("0.95 depth/a.png\n1.75 depth/b.png\n");
  ExpectError({"within 0.02 s", "smallest gap is 0.050000 s"});
}

TEST_F(TumSequenceTest, MissingFilesAreReportedByName) {
  std::filesystem::remove(folder_.path() / "depth" / "b.png");
  ExpectError({"depth/b.png: the image is missing"});
  // Images of frames that are not selected need not exist.
  EXPECT_EQ(Open({.associations = {}, .selection = {.last = 0}}).frames.size(), 1U);
  std::filesystem::remove(folder_.path() / "depth.txt");
  ExpectError({"has no depth.txt", "without depth: mono_tum"});
  ExpectInputError([] { OpenTumSequence("/no/such"); }, {"/no/such", "no such folder"});
}

TEST(TumSequenceData, RealSequencesAreRead) {
  const auto folder = FindTestData("fr1_xyz");
  if (!folder) {
    GTEST_SKIP() << "fr1_xyz is not on this machine; set HULLSLAM_DATA";
  }
  const ImageSequence sequence = OpenTumSequence(*folder);
  EXPECT_EQ(sequence.frames.size() + sequence.unpaired, 798U);
  const ImageSequence given =
      OpenTumSequence(*folder, {.associations = *folder / "associations.txt", .selection = {}});
  EXPECT_EQ(given.frames.size(), 792U);
  EXPECT_EQ(sequence.frames.size(), given.frames.size());
  EXPECT_EQ(sequence.load(sequence.frames[0], PinholeCamera()).depth.cols, 640);
}

// ---- folders without lists

class UnlistedSequenceTest : public ::testing::Test {
 protected:
  void Add(const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      folder_.Write(file, "");
    }
  }
  ImageSequence Open(const TumSequenceOptions& options = {}) {
    return OpenTumSequence(folder_.path(), options);
  }
  void ExpectError(const std::vector<std::string>& parts, const TumSequenceOptions& options = {}) {
    ExpectInputError([&] { Open(options); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(UnlistedSequenceTest, NumbersOfFramesArePairedAndBecomeStamps) {
  Add({"rgb/frame-2.color.jpg", "rgb/frame-10.color.jpg", "rgb/frame-11.color.jpg",
       "depth/frame-10.depth.png", "depth/frame-000002.depth.png", "depth/frame-12.depth.png"});
  const ImageSequence sequence = Open({.frames_per_second = 60.0});
  ASSERT_EQ(sequence.frames.size(), 2U);
  EXPECT_EQ(sequence.unpaired, 1U);
  EXPECT_EQ(sequence.frames[0].image, folder_.path() / "rgb/frame-2.color.jpg");
  EXPECT_EQ(sequence.frames[0].depth, folder_.path() / "depth/frame-000002.depth.png");
  EXPECT_EQ(sequence.frames[1].depth, folder_.path() / "depth/frame-10.depth.png");
  EXPECT_DOUBLE_EQ(sequence.frames[1].timestamp - sequence.frames[0].timestamp, 8.0 / 60.0);
  EXPECT_NE(sequence.stamps_note.find("numbers of frames, 60 per second"), std::string::npos);
  const ImageSequence monocular = Open({.use_depth = false});
  EXPECT_EQ(monocular.frames.size(), 3U);
  EXPECT_TRUE(monocular.frames[0].depth.empty());
}

TEST_F(UnlistedSequenceTest, StampsInNamesArePairedByTime) {
  Add({"rgb/1305031102.175304.png", "rgb/1305031102.211214.png", "depth/1305031102.160407.png",
       "depth/1305031102.226738.png"});
  const ImageSequence sequence = Open();
  ASSERT_EQ(sequence.frames.size(), 2U);
  EXPECT_DOUBLE_EQ(sequence.frames[0].timestamp, 1305031102.175304);
  EXPECT_EQ(sequence.frames[1].depth, folder_.path() / "depth/1305031102.226738.png");
  EXPECT_NE(sequence.stamps_note.find("time stamps"), std::string::npos);
}

TEST_F(UnlistedSequenceTest, TheUnitOfAClockFollowsFromItsDigits) {
  Add({"rgb/1403636579763555584.png", "rgb/1403636579813555456.png"});
  EXPECT_NEAR(Open({.use_depth = false}).frames[1].timestamp, 1403636579.813555456, 1e-6);
}

TEST_F(UnlistedSequenceTest, AListIsPreferred) {
  Add({"rgb/1.png", "rgb/2.png", "depth/1.png", "depth/2.png"});
  folder_.Write("rgb.txt", "5.0 rgb/1.png\n");
  EXPECT_EQ(Open({.use_depth = false}).frames.size(), 1U);
  ExpectError({"has no depth.txt", "without depth: mono_tum"});
}

TEST_F(UnlistedSequenceTest, FoldersOf7ScenesAreKnownByTheirNames) {
  Add({"frame-000000.color.png", "frame-000000.depth.png", "frame-000000.pose.txt",
       "frame-000001.color.png", "frame-000001.depth.png"});
  const ImageSequence sequence = Open();
  ASSERT_EQ(sequence.frames.size(), 2U);
  EXPECT_EQ(sequence.frames[1].image.filename(), "frame-000001.color.png");
  EXPECT_EQ(sequence.frames[1].depth.filename(), "frame-000001.depth.png");
  EXPECT_NE(sequence.stamps_note.find("a folder of 7-Scenes"), std::string::npos);
  EXPECT_EQ(Open({.use_depth = false}).frames.size(), 2U);
}

TEST_F(UnlistedSequenceTest, FoldersOfReplicaAreKnownByTheirNames) {
  Add({"results/frame000000.jpg", "results/depth000000.png", "results/frame000001.jpg",
       "results/depth000001.png", "traj.txt"});
  const ImageSequence sequence = Open();
  ASSERT_EQ(sequence.frames.size(), 2U);
  EXPECT_EQ(sequence.frames[1].image.filename(), "frame000001.jpg");
  EXPECT_EQ(sequence.frames[1].depth.filename(), "depth000001.png");
  EXPECT_EQ(sequence.frames[1].timestamp, 1.0 / 30.0);
}

TEST_F(UnlistedSequenceTest, OtherNamesAreRefused) {
  Add({"rgb/1.png"});
  ExpectError({"has no depth.txt and no folder depth", "without depth: mono_tum"});
  Add({"rgb/2.5.png"});
  ExpectError({"2.5.png", "of another kind than that of 1.png"});
  std::filesystem::remove(folder_.path() / "rgb/2.5.png");
  Add({"rgb/cup.png"});
  ExpectError({"cup.png", "neither the number of a frame nor a time stamp"});
}

TEST_F(UnlistedSequenceTest, NumbersThatCannotBeFramesAreRefused) {
  Add({"rgb/1-000000.png", "rgb/2-000033369.png"});
  ExpectError({"3.337e+04 apart", "expected a list"}, {.use_depth = false});
}

TEST_F(UnlistedSequenceTest, NumbersThatOccurTwiceAreRefused) {
  Add({"rgb/a1.png", "rgb/b1.png"});
  ExpectError({"b1.png", "that of a1.png"}, {.use_depth = false});
}

TEST_F(UnlistedSequenceTest, FramesWithoutACommonNumberAreRefused) {
  Add({"rgb/1.png", "depth/2.png"});
  ExpectError({"no image of rgb has the number of one of depth"});
}

// ---- a folder one level too high or too low

TEST_F(UnlistedSequenceTest, TheRightFolderIsNamed) {
  Add({"desk/rgb/1.png", "desk/depth/1.png", "notes/a.txt"});
  const std::string desk = std::filesystem::canonical(folder_.path() / "desk").string();
  ExpectError({"neither rgb.txt nor a folder rgb", "did you mean " + desk + "?"});
  ExpectInputError([&] { OpenTumSequence(folder_.path() / "desk" / "rgb"); },
                   {"did you mean " + desk + "?"});
  Add({"room/rgb/1.png"});  // now it is not known which of the two is meant
  try {
    Open();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("did you mean"), std::string::npos);
  }
}

}  // namespace
}  // namespace hullslam
