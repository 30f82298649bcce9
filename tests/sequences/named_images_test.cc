// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/named_images.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class NamedImagesTest : public ::testing::Test {
 protected:
  void Make(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      folder_.Write(name, "");
    }
  }
  NamedImages Find(double frames_per_second = 25.0) const {
    return FindNamedImages(folder_.path(), frames_per_second);
  }
  std::vector<double> Stamps(double frames_per_second = 25.0) const {
    std::vector<double> stamps;
    for (const FramePaths& frame : Find(frames_per_second).frames) {
      stamps.push_back(frame.timestamp);
    }
    return stamps;
  }
  void ExpectRefused(const std::vector<std::string>& parts) const {
    ExpectInputError([&] { Find(); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(NamedImagesTest, NumbersOfFramesAreInOrderWithoutLeadingZeros) {
  Make({"frame10.png", "frame2.JPG", "frame1.jpeg", "notes.txt"});
  const NamedImages named = Find(10.0);
  EXPECT_TRUE(named.are_numbered);
  ASSERT_EQ(named.frames.size(), 3u);
  EXPECT_EQ(named.frames[1].image.filename(), "frame2.JPG");
  EXPECT_EQ(Stamps(10.0), (std::vector<double>{0.1, 0.2, 1.0}));
}

TEST_F(NamedImagesTest, TheLastNumberOfANameCounts) {
  Make({"cam2-frame-000004.color.png", "cam3-frame-000005.color.png"});
  EXPECT_EQ(Stamps(), (std::vector<double>{4.0 / 25.0, 5.0 / 25.0}));
}

TEST_F(NamedImagesTest, ADecimalPointMakesSeconds) {
  Make({"1305031102.175304.png", "1305031102.211214.png"});
  EXPECT_FALSE(Find().are_numbered);
  EXPECT_EQ(Stamps(), (std::vector<double>{1305031102.175304, 1305031102.211214}));
}

// The same two times in the units of three clocks.
TEST(NamedImages, TheNumberOfDigitsTellsTheUnitOfAClock) {
  for (const char* const zeros : {"", "000", "000000"}) {
    const TemporaryFolder folder;
    folder.Write("1403636579763" + std::string(zeros) + ".png", "");
    folder.Write("1403636579813" + std::string(zeros) + ".png", "");
    const NamedImages named = FindNamedImages(folder.path(), 25.0);
    EXPECT_FALSE(named.are_numbered);
    ASSERT_EQ(named.frames.size(), 2u);
    EXPECT_NEAR(named.frames[0].timestamp, 1403636579.763, 1e-6);
    EXPECT_NEAR(named.frames[1].timestamp, 1403636579.813, 1e-6);
  }
}

TEST_F(NamedImagesTest, NamesOfTwoKindsAreRefused) {
  Make({"1.png", "1.5.png"});
  ExpectRefused({"of another kind than that of"});
}

TEST_F(NamedImagesTest, ANameWithoutANumberIsRefused) {
  Make({"left.png"});
  ExpectRefused({"left.png", "neither the number of a frame nor a time stamp"});
}

TEST_F(NamedImagesTest, ANumberThatTwoImagesHaveIsRefused) {
  Make({"7.png", "07.png"});
  ExpectRefused({"the last number in the name is that of", "7.png"});
}

TEST_F(NamedImagesTest, StepsThatNoCameraMakesAreRefused) {
  Make({"0.png", "40000.png", "80000.png"});  // microseconds from the start
  ExpectRefused({"4e+04 apart on average", "a list with lines"});
  const TemporaryFolder folder;
  folder.Write("1.0001.png", "");  // image 1 of camera 1
  folder.Write("1.0002.png", "");
  ExpectInputError([&] { FindNamedImages(folder.path(), 25.0); }, {"0.0001 apart"});
}

TEST_F(NamedImagesTest, OtherFormatsAndFoldersWithoutImagesAreRefused) {
  ExpectRefused({"has no PNG or JPEG images"});
  Make({"1.png", "2.tiff"});
  ExpectRefused({"2.tiff", "neither a PNG nor a JPEG"});
}

TEST_F(NamedImagesTest, OnlyNamesWithThePartCount) {
  Make({"frame-000001.color.png", "frame-000001.depth.png", "frame-000001.pose.tif"});
  const NamedImages named = FindNamedImages(folder_.path(), 25.0, ".depth.");
  ASSERT_EQ(named.frames.size(), 1u);
  EXPECT_EQ(named.frames[0].image.filename(), "frame-000001.depth.png");
}

}  // namespace
}  // namespace hullslam
