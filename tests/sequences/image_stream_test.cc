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

std::string BigEndian(uint32_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes += static_cast<char>(value >> shift & 0xffU);
  }
  return bytes;
}

// Replaces `count` bytes at `at` of the box at the end of `path` in an MP4 file, and makes the
// boxes around them larger. OpenCV writes the images before these boxes, so that no place of them
// changes.
void ReplaceInBox(const std::vector<std::string>& path, size_t at, size_t count,
                  const std::string& text, std::string& file) {
  size_t box = 0;
  const auto size_of = [&](size_t place) {
    uint32_t size = 0;
    for (size_t i = 0; i < 4; ++i) {
      size = size << 8U | static_cast<unsigned char>(file[place + i]);
    }
    return size;
  };
  for (const std::string& name : path) {
    while (file.compare(box + 4, 4, name) != 0) {
      box += size_of(box);
      ASSERT_LT(box + 8, file.size()) << name;
    }
    const auto size = static_cast<uint32_t>(size_of(box) + text.size() - count);
    file.replace(box, 4, BigEndian(size));
    box += name == path.back() ? 0 : 8;
  }
  file.replace(box + at, count, text);
}

class ImageStreamTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  // A grey image whose value is `grey`.
  std::string WriteImage(const std::string& name, int grey, int width = kWidth) const {
    cv::imwrite(Path(name), cv::Mat(kHeight, width, CV_8UC3, cv::Scalar::all(grey)));
    return Path(name);
  }

  // A video of frames with the grey values 0, 20, 40 and so on, with 25 frames per second. The
  // upper left quarter is white if `has_corner`.
  std::string WriteVideo(const std::string& name, int frames, const char* coding = "MJPG",
                         bool has_corner = false) const {
    cv::VideoWriter writer(Path(name), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc(coding[0], coding[1], coding[2], coding[3]),
                           25.0, cv::Size(kWidth, kHeight));
    for (int i = 0; i < frames; ++i) {
      cv::Mat image(kHeight, kWidth, CV_8UC3, cv::Scalar::all(20 * i));
      if (has_corner) {
        image(cv::Rect(0, 0, kWidth / 2, kHeight / 2)).setTo(cv::Scalar::all(255));
      }
      writer.write(image);
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

// The decoder delivers the last frames after the end of the file, and in another order than that of
// their packets.
TEST_F(ImageStreamTest, FramesThatAreDecodedLateHaveTheirTimeStamps) {
  for (const char* const name : {"a.mp4", "a.mkv", "a.avi"}) {
    const ImageStream stream = OpenImageStream(WriteVideo(name, 12, "avc1"));
    ASSERT_EQ(stream.images.frames.size(), 12U) << name;
    for (size_t i = 0; i < 12; ++i) {
      EXPECT_NEAR(stream.images.frames[i].timestamp, 0.04 * static_cast<double>(i), 1e-3) << name;
      EXPECT_NEAR(GreyOf(stream, i), 20 * static_cast<int>(i), 4) << name;
    }
  }
}

TEST_F(ImageStreamTest, IntervalsOfAVideoMayDifferAndRepeatedStampsAreLeftOut) {
  std::string file = ReadFile(WriteVideo("a.mp4", 6, "mp4v"));
  constexpr uint32_t kUnit = 512;    // 0.04 s
  std::string table = BigEndian(6);  // the sum stays, because an edit list tells the end
  for (const uint32_t units : {1U, 2U, 0U, 1U, 1U, 1U}) {
    table += BigEndian(1) + BigEndian(units * kUnit);
  }
  ReplaceInBox({"moov", "trak", "mdia", "minf", "stbl", "stts"}, 12, 12, table, file);
  const ImageStream stream = OpenImageStream(folder_.Write("b.mp4", file));
  ASSERT_EQ(stream.images.frames.size(), 5U);
  const std::vector<double> stamps = {0.0, 0.04, 0.12, 0.16, 0.2};
  const std::vector<size_t> numbers = {0, 1, 2, 4, 5};
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(stream.images.frames[i].timestamp, stamps[i], 1e-3);
    EXPECT_NEAR(GreyOf(stream, i), 20 * static_cast<int>(numbers[i]), 4);
  }
  EXPECT_EQ(stream.images.frames[3].image.stem(), "000004");
  EXPECT_NE(stream.images.stamps_note.find("1 repeat the previous stamp"), std::string::npos);
}

// A camera that was held upright stores its images lying, and says so in the matrix of the track.
TEST_F(ImageStreamTest, AVideoIsTurnedAsItAsks) {
  struct Case {
    std::vector<int> matrix;  // a, b, c, d
    const char* note;
    int x, y;  // a pixel in the white corner
  };
  const std::string stored = ReadFile(WriteVideo("a.mp4", 3, "mp4v", true));
  for (const Case& turn : {Case{{0, 1, -1, 0}, "turned by 90 degrees clockwise", 40, 9},
                           Case{{-1, 0, 0, -1}, "turned by 180 degrees", 56, 40},
                           Case{{0, -1, 1, 0}, "turned by 90 degrees counterclockwise", 9, 56},
                           Case{{-1, 0, 0, 1}, "mirrored", 56, 9}}) {
    std::string file = stored;
    const auto fixed = [&](int i) {
      return BigEndian(static_cast<uint32_t>(turn.matrix[i]) << 16);
    };
    ReplaceInBox({"moov", "trak", "tkhd"}, 48, 20,
                 fixed(0) + fixed(1) + BigEndian(0) + fixed(2) + fixed(3), file);
    const ImageStream stream = OpenImageStream(folder_.Write("turned.mp4", file));
    EXPECT_NE(stream.images.stamps_note.find(std::string("; the images are ") + turn.note),
              std::string::npos)
        << stream.images.stamps_note;
    EXPECT_EQ(stream.width, turn.matrix[0] == 0 ? kHeight : kWidth);
    const cv::Mat grey = stream.images.load(stream.images.frames[1], CameraOf(stream)).grey;
    EXPECT_GT(grey.at<uint8_t>(turn.y, turn.x), 200) << turn.note;
    EXPECT_LT(cv::mean(grey)[0], 120.0) << turn.note;
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
