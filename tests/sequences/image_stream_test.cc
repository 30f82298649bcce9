// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_stream.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr int kWidth = 66;
constexpr int kHeight = 50;

class ImageStreamTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  // A grey image whose value is `grey`.
  std::string WriteImage(const std::string& name, int grey, int width = kWidth) const {
    cv::imwrite(Path(name), cv::Mat(kHeight, width, CV_8UC3, cv::Scalar::all(grey)));
    return Path(name);
  }

  // A video of frames with the grey values 0, 20, 40 and so on, with 25 frames per second.
  std::string WriteVideo(const std::string& name, int frames) const {
    cv::VideoWriter writer(Path(name), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                           25.0, cv::Size(kWidth, kHeight));
    for (int i = 0; i < frames; ++i) {
      writer.write(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(20 * i)));
    }
    return Path(name);
  }

  static PinholeCamera CameraOf(const ImageStream& stream) {
    return CameraOfFieldOfView(60.0, stream.width, stream.height);
  }

  static int GreyOf(const ImageStream& stream, size_t frame) {
    return stream.images.load(stream.images.frames.at(frame), CameraOf(stream))
        .grey.at<uint8_t>(9, 9);
  }

  void ExpectError(const std::string& path, const std::vector<std::string>& parts,
                   const ImageStreamOptions& options = {}) const {
    ExpectInputError([&] { OpenImageStream(path, options); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(ImageStreamTest, AFolderIsReadInNaturalOrder) {
  WriteImage("frame10.png", 30);
  WriteImage("frame9.JPG", 20);
  WriteImage("frame2.png", 10);
  folder_.Write("notes.txt", "no image");
  const ImageStream stream = OpenImageStream(folder_.path());
  ASSERT_EQ(stream.images.frames.size(), 3U);
  EXPECT_EQ(stream.images.frames[0].image, Path("frame2.png"));
  EXPECT_EQ(stream.images.frames[2].image, Path("frame10.png"));
  EXPECT_EQ(stream.images.frames[2].timestamp, 2.0 / 30.0);
  EXPECT_EQ(stream.width, kWidth);
  EXPECT_EQ(stream.height, kHeight);
  EXPECT_EQ(stream.frames_per_second, 30.0);
  EXPECT_NE(stream.images.stamps_note.find("30 images per second, the default"), std::string::npos);
  EXPECT_NEAR(GreyOf(stream, 0), 10, 1);
  EXPECT_NEAR(GreyOf(stream, 2), 30, 1);
  const ImageInput image = stream.images.load(stream.images.frames[1], CameraOf(stream));
  EXPECT_EQ(image.timestamp, 1.0 / 30.0);
  EXPECT_EQ(image.grey.type(), CV_8UC1);
  EXPECT_TRUE(image.depth.empty());
}

TEST_F(ImageStreamTest, TheFrameRateOfAFolderCanBeGiven) {
  for (const char* const name : {"a.png", "b.png", "c.png", "d.png"}) {
    WriteImage(name, 50);
  }
  const ImageStream stream = OpenImageStream(
      folder_.path(), {.frames_per_second = 12.5, .selection = {.first = 1, .stride = 2}});
  ASSERT_EQ(stream.images.frames.size(), 2U);
  EXPECT_EQ(stream.images.frames[1].timestamp, 3.0 / 12.5);
  EXPECT_EQ(stream.images.frames[1].number, 3U);
  EXPECT_EQ(stream.images.available, 4U);
  EXPECT_NE(stream.images.stamps_note.find("12.5 images per second (--fps)"), std::string::npos);
  for (const double rate : {0.0, -1.0, 1e9, std::nan("")}) {
    ExpectError(folder_.path(), {"--fps is '"}, {.frames_per_second = rate});
  }
}

TEST_F(ImageStreamTest, BadFoldersAreRefusedByName) {
  ExpectError(folder_.path(), {folder_.path().string(), "has no PNG or JPEG images"});
  ExpectError(Path("none"), {"none: no such file or folder"});
  WriteImage("a.png", 9);
  folder_.Write("b.TIFF", "");
  ExpectError(folder_.path(), {"b.TIFF: is neither a PNG nor a JPEG"});
  std::filesystem::remove(Path("b.TIFF"));
  folder_.Write("a.png", "broken");
  ExpectError(folder_.path(), {"a.png: is neither a PNG nor a JPEG image"});
  cv::imwrite(Path("a.png"), cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(900)));
  ExpectError(folder_.path(), {"a.png: has 16 bits per channel", "8 bits"});
}

TEST_F(ImageStreamTest, AnImageOfAnotherSizeIsRefusedByName) {
  WriteImage("a.png", 9);
  WriteImage("b.png", 9, kWidth + 1);
  const ImageStream stream = OpenImageStream(folder_.path());
  ExpectInputError([&] { GreyOf(stream, 1); }, {"b.png: 67x50 px", "66x50"});
}

TEST_F(ImageStreamTest, OddSizesAndGreyImagesAreRead) {
  cv::imwrite(Path("a.png"), cv::Mat(33, 71, CV_8UC1, cv::Scalar(77)));
  cv::imwrite(Path("b.png"), cv::Mat(33, 71, CV_8UC4, cv::Scalar(77, 77, 77, 0)));
  const ImageStream stream = OpenImageStream(folder_.path());
  EXPECT_EQ(stream.width, 71);
  EXPECT_EQ(stream.height, 33);
  EXPECT_EQ(GreyOf(stream, 0), 77);
  EXPECT_EQ(GreyOf(stream, 1), 77);
}

TEST_F(ImageStreamTest, AVideoHasItsOwnTimeStamps) {
  for (const char* const name : {"a.avi", "a.mkv"}) {
    const ImageStream stream = OpenImageStream(WriteVideo(name, 10));
    ASSERT_EQ(stream.images.frames.size(), 10U) << name;
    EXPECT_EQ(stream.width, kWidth);
    EXPECT_EQ(stream.height, kHeight);
    EXPECT_NEAR(stream.frames_per_second, 25.0, 0.1);
    EXPECT_NEAR(stream.images.frames[7].timestamp - stream.images.frames[0].timestamp, 0.28, 1e-3);
    EXPECT_EQ(stream.images.frames[7].image.stem(), "000007");
    EXPECT_NE(stream.images.stamps_note.find("of the video"), std::string::npos);
  }
}

// The order may go back to the beginning, and it may skip frames.
TEST_F(ImageStreamTest, FramesOfAVideoAreDecodedInAnyOrder) {
  const ImageStream stream = OpenImageStream(WriteVideo("a.avi", 10));
  for (const size_t frame : {0U, 1U, 2U, 7U, 9U, 0U, 4U, 4U}) {
    EXPECT_NEAR(GreyOf(stream, frame), 20 * static_cast<int>(frame), 3) << frame;
  }
  const ImageStream some = OpenImageStream(
      Path("a.avi"), {.frames_per_second = 10.0, .selection = {.first = 3, .stride = 3}});
  ASSERT_EQ(some.images.frames.size(), 3U);
  EXPECT_EQ(some.images.frames[1].timestamp, 0.6);
  EXPECT_EQ(some.frames_per_second, 10.0);
  EXPECT_NEAR(GreyOf(some, 1), 120, 3);
}

TEST_F(ImageStreamTest, BrokenVideosAreRefusedByName) {
  ExpectError(folder_.Write("a.mp4", ""), {"a.mp4: cannot be decoded", "FFmpeg"});
  ExpectError(folder_.Write("a.mp4", "no video at all"), {"a.mp4: cannot be decoded"});
  const std::string good = ReadFile(WriteVideo("good.avi", 10));
  ExpectError(folder_.Write("cut.avi", good.substr(0, 600)), {"cut.avi: "});
  // If a video is cut off, the frames that can be decoded are used.
  const ImageStream part =
      OpenImageStream(folder_.Write("part.avi", good.substr(0, good.size() * 3 / 4)));
  EXPECT_GE(part.images.frames.size(), 1U);
  EXPECT_LT(part.images.frames.size(), 10U);
  EXPECT_GE(GreyOf(part, 0), 0);
  ExpectError("/dev/null", {"/dev/null: is not a file"});
}

TEST_F(ImageStreamTest, AVideoDoesNotOpenOtherFiles) {
  WriteVideo("private.avi", 10);
  ExpectError(folder_.Write("list.mp4", "ffconcat version 1.0\nfile private.avi\n"),
              {"list.mp4: cannot be decoded"});
}

// The size is in the header, so that no memory is needed to refuse it.
TEST_F(ImageStreamTest, AVideoOfHugeImagesIsRefused) {
  ExpectError(folder_.Write("huge.y4m", "YUV4MPEG2 W16000 H16000 F25:1 Cmono\nFRAME\n0123456789"),
              {"huge.y4m: has images of 16000x16000 px", "64 million px"});
}

TEST(CameraOfFieldOfView, TheBordersAreSeenAtHalfTheAngle) {
  const PinholeCamera camera = CameraOfFieldOfView(90.0, 640, 480);
  EXPECT_NEAR(camera.fx, 320.0, 1e-9);
  EXPECT_EQ(camera.fx, camera.fy);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_FALSE(camera.IsDistorted());
  EXPECT_EQ(camera.FindFault(), "");
  // The outer edge of the last pixel is at x = 639.5.
  EXPECT_NEAR(camera.Project({1.0, 0.0, 1.0}).x(), 639.5, 1e-9);
  for (const double degrees : {0.0, 9.9, 180.0, -60.0, std::nan("")}) {
    ExpectInputError([&] { CameraOfFieldOfView(degrees, 640, 480); },
                     {"--fov is '", "field of view"});
  }
}

}  // namespace
}  // namespace hullslam
