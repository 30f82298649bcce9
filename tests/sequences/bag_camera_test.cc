// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_camera.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"

namespace hullslam {
namespace {

constexpr const char* kBag = "a.mcap";

IndexedTopic Images(const std::string& name) { return {.name = name, .type = {}, .encoding = {}}; }

// As image_proc publishes it: K and D of the raw images, P of the rectified ones.
IndexedTopic Info(double right_by = 0.0) {
  CameraInfoMessage info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.distortion = {-0.3, 0.1, 0.0, 0.0, 0.0};
  info.k = {500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0};
  info.r = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.p = {450.0, 0.0, 310.0, -450.0 * right_by, 0.0, 450.0, 230.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  IndexedTopic topic = Images("/camera/camera_info");
  topic.camera = info;
  return topic;
}

TEST(BagCamera, TheNameOfTheTopicTellsWhichMatrixIsThatOfTheImages) {
  for (const char* const raw : {"/camera/image_raw", "/direct_drive/image", "/rectangle/image"}) {
    const InfoCamera read = CameraOfInfo(kBag, Info(), Images(raw));
    EXPECT_EQ(read.camera.fx, 500.0) << raw;
    EXPECT_EQ(read.camera.k1, -0.3) << raw;
    EXPECT_NE(read.note.find("K and D"), std::string::npos);
  }
  for (const char* const rectified : {"/camera/image_rect", "/rgb/image_rect_color"}) {
    const InfoCamera read = CameraOfInfo(kBag, Info(), Images(rectified));
    EXPECT_EQ(read.camera.fy, 450.0) << rectified;
    EXPECT_EQ(read.camera.cy, 230.0) << rectified;
    EXPECT_FALSE(read.camera.IsDistorted());
    EXPECT_NE(read.note.find("P"), std::string::npos);
  }
}

TEST(BagCamera, RectifiedImagesWithoutAProjectionHaveK) {
  IndexedTopic info = Info();
  info.camera->p = {};
  ExpectInputError([&] { CameraOfInfo(kBag, info, Images("/image_rect")); },
                   {kBag, "/camera/camera_info", "its matrix P is 0", "--settings"});
  info.camera->distortion = {0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(CameraOfInfo(kBag, info, Images("/image_rect")).camera.fx, 500.0);
}

TEST(BagCamera, ACameraThatIsNotCalibratedIsRefused) {
  IndexedTopic info = Info();
  info.camera->k = {};
  ExpectInputError([&] { CameraOfInfo(kBag, info, Images("/image")); },
                   {kBag, "its matrix K is 0"});
  info = Info();
  info.camera->distortion = {0.1};
  ExpectInputError([&] { CameraOfInfo(kBag, info, Images("/image")); },
                   {"plumb_bob", "1 coefficients"});
}

TEST(BagCamera, ThePairHasTheBaselineOfTheRightProjection) {
  const IndexedTopic left = Info();
  const IndexedTopic right = Info(0.12);
  for (const char* const name : {"/image_raw", "/image_rect"}) {
    const IndexedTopic images = Images(name);
    std::vector<std::string> notes;
    const StereoCalibration pair = PairOfInfos(kBag, {&left, &right}, {&images, &images}, notes);
    EXPECT_NEAR(pair.right_from_left.translation.x(), -0.12, 1e-12) << name;
    EXPECT_EQ(pair.left.IsDistorted(), std::string(name) == "/image_raw");
    ASSERT_EQ(notes.size(), 1U);
  }
}

TEST(BagCamera, RawImagesNeedARotation) {
  const IndexedTopic left = Info();
  IndexedTopic right = Info(0.12);
  right.camera->r = {};
  std::vector<std::string> notes;
  const IndexedTopic raw = Images("/image_raw");
  ExpectInputError(
      [&] {
        PairOfInfos(kBag, {&left, &right}, {&raw, &raw}, notes);
      },
      {"its matrix R is no rotation"});
  const IndexedTopic rectified = Images("/image_rect");
  EXPECT_NO_THROW(PairOfInfos(kBag, {&left, &right}, {&rectified, &rectified}, notes));
}

}  // namespace
}  // namespace hullslam
