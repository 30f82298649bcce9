// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/ask_scene.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "support/made_view.h"

namespace hullslam {
namespace {

// A blue cut-out of 40x20 px with a square outline.
ViewPicture MadeCutout() {
  std::vector<uchar> bytes;
  cv::imencode(".jpg", cv::Mat(20, 40, CV_8UC3, cv::Scalar(255, 0, 0)), bytes);
  ViewPicture picture;
  picture.jpeg.assign(bytes.begin(), bytes.end());
  picture.width = 40;
  picture.height = 20;
  picture.outlines = {{ObjectId(7), "cup", {{10, 5}, {30, 5}, {30, 15}, {10, 15}}}};
  return picture;
}

bool Has(const cv::Mat& image, const cv::Scalar& low, const cv::Scalar& high) {
  cv::Mat found;
  cv::inRange(image, low, high, found);
  return cv::countNonZero(found) > 100;
}

TEST(DrawAnswers, ShowsTheCutoutsOfEachAnswer) {
  ViewModel model = MadeView(2);
  model.objects[0].cutouts.assign(5, MadeCutout());  // more than a row has room for
  const std::vector<Answer> one = {{ObjectId(7), 0.9, "cup 7"}};
  const cv::Mat sheet = DrawAnswers(one, model);
  EXPECT_TRUE(Has(sheet, {240, 0, 0}, {255, 20, 20})) << "the blue cut-out";
  EXPECT_TRUE(Has(sheet, {0, 120, 230}, {40, 160, 255})) << "the orange outline";
  const std::vector<Answer> two = {{ObjectId(7), 0.9, "cup 7"}, {ObjectId(99), 0.8, "unknown"}};
  EXPECT_GT(DrawAnswers(two, model).rows, sheet.rows);
}

TEST(DrawAnswers, ACutoutThatIsNoImageIsLeftOut) {
  ViewModel model = MadeView(2);
  model.objects[0].cutouts.assign(1, MadeCutout());
  model.objects[0].cutouts[0].jpeg = "no image";
  EXPECT_FALSE(Has(DrawAnswers(std::vector<Answer>{{ObjectId(7), 0.9, ""}}, model), {240, 0, 0},
                   {255, 20, 20}));
}

}  // namespace

}  // namespace hullslam
