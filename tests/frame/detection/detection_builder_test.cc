// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/detection/detection_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "frame/made_masks.h"
#include "geometry/polygon.h"
#include "hullslam/geometry/dual_quadric.h"
#include "hullslam/util/check.h"
#include "support/fisheye_camera.h"
#include "support/random_geometry.h"
#include "support/square_mask.h"

namespace hullslam {
namespace {

constexpr double kUnits = 1000.0;

using Reason = DetectionRejection;

DetectionResult Build(const std::vector<InstanceMask>& masks, const PinholeCamera& camera,
                      const DetectionOptions& options = {}, const cv::Mat& depth = {}) {
  return DetectionBuilder(camera, kUnits, options).Build(masks, depth, {});
}

Detection BuildOne(const InstanceMask& mask, const PinholeCamera& camera,
                   const DetectionOptions& options = {}, const cv::Mat& depth = {}) {
  DetectionResult result = Build({mask}, camera, options, depth);
  EXPECT_EQ(result.detections.size(), 1U);
  return result.detections.empty() ? Detection() : result.detections[0];
}

std::optional<Reason> RejectionOf(const InstanceMask& mask, const DetectionOptions& options = {}) {
  return Build({mask}, PlainCamera(), options).rejections.at(0);
}

DetectionOptions WithPrimitive(ObjectPrimitive primitive, double epsilon = 3.0) {
  DetectionOptions options;
  options.primitive = primitive;
  options.epsilon_px = epsilon;
  return options;
}

// Distance from the parallel tangent of the ellipse to the line, px; positive if the line is
// outside of the ellipse.
double Excess(const Line2& line, const Ellipse& ellipse) {
  return -line.SignedDistance(ellipse.center) - ellipse.HalfExtent(line.normal);
}

double LargestExcess(const Detection& detection, const Ellipse& ellipse) {
  double largest = 0.0;
  for (const SilhouetteLine& line : detection.lines) {
    largest = std::max(largest, std::abs(Excess(line.line, ellipse)));
  }
  return largest;
}

double MeanExcess(const Detection& detection, const Ellipse& ellipse) {
  double sum = 0.0;
  for (const SilhouetteLine& line : detection.lines) {
    sum += Excess(line.line, ellipse);
  }
  return sum / static_cast<double>(detection.lines.size());
}

std::vector<bool> SidesOneSided(const Detection& detection) {
  const std::vector<Eigen::Vector2d> directions{{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
  std::vector<bool> sides;
  for (const Eigen::Vector2d& direction : directions) {
    const auto line = std::find_if(
        detection.lines.begin(), detection.lines.end(),
        [&](const SilhouetteLine& l) { return l.line.normal.dot(direction) > 0.9999; });
    EXPECT_NE(line, detection.lines.end());
    sides.push_back(line != detection.lines.end() && line->is_one_sided);
  }
  return sides;  // right, bottom, left, top
}

// The projection of an ellipsoid into the undistorted image of freiburg1's camera, away from the
// middle of the image.
Ellipse SeenEllipsoid() {
  const PinholeCamera camera = DistortedCamera();
  const Ellipsoid ellipsoid{{ExpSo3({0.3, 0.5, -0.2}), {-0.62, -0.4, 1.6}}, {0.25, 0.15, 0.2}};
  return ProjectEllipsoid(camera.Matrix(), Rigid3(), ellipsoid).value();
}

// Readers of maps refuse longer vectors.
TEST(DetectionBuilder, EmbeddingsGetLengthOne) {
  InstanceMask mask = MaskOf(SeenEllipsoid(), DistortedCamera());
  EXPECT_TRUE(BuildOne(mask, DistortedCamera()).embedding.empty());
  mask.embedding = {3.0F, 0.0F, -4.0F};
  EXPECT_EQ(BuildOne(mask, DistortedCamera()).embedding, (std::vector<float>{0.6F, 0.0F, -0.8F}));
  mask.embedding = {-7.3e-20F};
  EXPECT_EQ(BuildOne(mask, DistortedCamera()).embedding, (std::vector<float>{-1.0F}));
}

TEST(DetectionBuilder, SupportLinesOfADistortedMaskTouchTheTrueEllipse) {
  const Ellipse truth = SeenEllipsoid();
  const Detection detection = BuildOne(MaskOf(truth, DistortedCamera()), DistortedCamera());
  ASSERT_GE(detection.lines.size(), 8U);
  EXPECT_LT(LargestExcess(detection, truth), 0.1);
  EXPECT_FALSE(detection.is_cut);
  for (const SilhouetteLine& line : detection.lines) {
    EXPECT_FALSE(line.is_one_sided);
  }
  // A mask whose points are rounded to pixels gives an error of half a pixel.
  InstanceMask rounded = MaskOf(truth, DistortedCamera());
  for (Eigen::Vector2d& p : rounded.outlines[0]) {
    p = p.array().round();
  }
  EXPECT_LT(LargestExcess(BuildOne(rounded, DistortedCamera()), truth), 0.75);
}

TEST(DetectionBuilder, MasksNeedToBeUndistorted) {
  const Ellipse truth = SeenEllipsoid();
  PinholeCamera undistorted = DistortedCamera();
  undistorted.k1 = undistorted.k2 = undistorted.k3 = undistorted.p1 = undistorted.p2 = 0.0;
  EXPECT_GT(LargestExcess(BuildOne(MaskOf(truth, DistortedCamera()), undistorted), truth), 2.0);
}

// An edge that is straight in the raw image is curved in the undistorted image, also between two
// distant corners.
TEST(DetectionBuilder, LongEdgesAreUndistortedAllAlong) {
  const PinholeCamera camera = DistortedCamera();
  const Detection detection = BuildOne(RectangleMask(20.0, 20.0, 400.0, 160.0), camera);
  const Eigen::Vector2d middle = camera.Undistort({220.0, 20.0});
  double nearest = 1e9;
  for (const Eigen::Vector2d& p : detection.contour.Unpack()) {
    nearest = std::min(nearest, std::abs((p - middle).norm()));
  }
  EXPECT_LT(nearest, 6.1);
  for (const SilhouetteLine& line : detection.lines) {
    EXPECT_LT(line.line.SignedDistance(middle), 1e-9);
  }
}

TEST(DetectionBuilder, SupportLinesRestOnTheFullHull) {
  RandomGeometry random(1);
  for (int round = 0; round < 30; ++round) {
    InstanceMask mask{.label = "thing", .score = 0.7, .outlines = {{}}};
    for (int i = 0; i < 60; ++i) {
      const double angle = 2.0 * 3.14159265 * i / 60;
      mask.outlines[0].emplace_back(Eigen::Vector2d(320.0, 240.0) +
                                    random.Number(40.0, 60.0) *
                                        Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    const Detection detection = BuildOne(mask, DistortedCamera());
    double before = -4.0;
    for (const SilhouetteLine& line : detection.lines) {
      double outermost = -1e9;
      for (const Eigen::Vector2d& corner : detection.hull) {
        outermost = std::max(outermost, line.line.SignedDistance(corner));
      }
      EXPECT_NEAR(outermost, 0.0, 1e-9);
      EXPECT_NEAR(line.line.normal.norm(), 1.0, 1e-12);
      // No two lines have nearly the same direction.
      const double angle = std::atan2(line.line.normal.y(), line.line.normal.x());
      EXPECT_GT(angle - before, 0.08);
      before = angle;
    }
  }
}

// The edges of a simplified hull are chords, which are biased to the inside. Support lines are not.
TEST(DetectionBuilder, ChordsOfTheSimplifiedHullCutInsideAndSupportLinesDoNot) {
  const Ellipse truth = MakeEllipse({320.0, 240.0}, 90.0, 60.0, 0.3);
  const InstanceMask mask = MaskOf(truth, PlainCamera());
  for (const double epsilon : {3.0, 6.0}) {
    const Detection chords =
        BuildOne(mask, PlainCamera(), WithPrimitive(ObjectPrimitive::kHull, epsilon));
    EXPECT_LT(MeanExcess(chords, truth), -0.4 * epsilon);
    EXPECT_GT(MeanExcess(chords, truth), -epsilon - 0.1);
    const Detection support =
        BuildOne(mask, PlainCamera(), WithPrimitive(ObjectPrimitive::kSupport, epsilon));
    EXPECT_LT(LargestExcess(support, truth), 0.02);
  }
}

// The mask of all images ignores what is right of the square, as if the image ended there. So the
// right side of the square says only how far the thing reaches at least.
TEST(DetectionBuilder, ALineAtPixelsThatAreIgnoredIsOneSided) {
  const InstanceMask square = Square("cup", 200, 150, 100);
  for (const PinholeCamera& camera : {PlainCamera(), FisheyeCamera()}) {
    cv::Mat mask_all(480, 640, CV_8UC1, cv::Scalar(255));
    const auto build = [&] {
      return DetectionBuilder(camera, kUnits, {}, mask_all)
          .Build(std::vector{square}, {}, {})
          .detections.at(0);
    };
    EXPECT_FALSE(build().is_cut);
    mask_all.colRange(301, 640).setTo(0);
    const Detection cut = build();
    EXPECT_TRUE(cut.is_cut);
    for (const SilhouetteLine& line : cut.lines) {
      EXPECT_EQ(line.is_one_sided, line.line.normal.x() > 0.2) << line.line.normal.transpose();
    }
    mask_all.colRange(0, 320).setTo(0);
    EXPECT_EQ(DetectionBuilder(camera, kUnits, {}, mask_all)
                  .Build(std::vector{square}, {}, {})
                  .rejections.at(0),
              Reason::kNoSilhouette)
        << "all of it is ignored";
  }
}

// A side that reaches from border to border is two-sided, although both its ends are cut.
TEST(DetectionBuilder, ASideFromBorderToBorderIsNotOneSided) {
  for (const ObjectPrimitive primitive : {ObjectPrimitive::kSupport, ObjectPrimitive::kHull}) {
    const Detection detection =
        BuildOne(RectangleMask(0.0, 0.0, 639.0, 200.0), PlainCamera(), WithPrimitive(primitive));
    EXPECT_EQ(SidesOneSided(detection), (std::vector<bool>{true, false, true, true}));
  }
}

struct Cut {
  Eigen::Vector2d center;
  const char* name;
};

// The border of the image cuts an ellipse. No line is outside of the ellipse, two-sided lines touch
// it, and lines that touch it away from the border are two-sided.
TEST(DetectionBuilder, LinesOfACutMaskAreOneSidedWhereItIsCut) {
  for (const PinholeCamera& camera : {PlainCamera(), DistortedCamera()}) {
    for (const Cut& cut :
         {Cut{{20.0, 240.0}, "left"}, Cut{{620.0, 200.0}, "right"}, Cut{{320.0, 10.0}, "top"},
          Cut{{300.0, 470.0}, "bottom"}, Cut{{15.0, 465.0}, "corner"}}) {
      SCOPED_TRACE(cut.name);
      const Ellipse truth = MakeEllipse(camera.Undistort(cut.center), 80.0, 50.0, 0.4);
      const Detection detection = BuildOne(MaskOf(truth, camera), camera);
      EXPECT_TRUE(detection.is_cut);
      int one_sided = 0;
      for (const SilhouetteLine& line : detection.lines) {
        const Eigen::Vector2d touch =
            truth.center + truth.shape * line.line.normal / truth.HalfExtent(line.line.normal);
        const Eigen::Vector2d raw = camera.Distort(touch);
        const bool is_inside = raw.x() > 12.0 && raw.y() > 12.0 && raw.x() < camera.width - 12.0 &&
                               raw.y() < camera.height - 12.0;
        EXPECT_LT(Excess(line.line, truth), 0.1);
        if (is_inside) {
          EXPECT_FALSE(line.is_one_sided) << line.line.normal.transpose();
        }
        if (!line.is_one_sided) {
          EXPECT_NEAR(Excess(line.line, truth), 0.0, 0.7);
        }
        one_sided += line.is_one_sided ? 1 : 0;
      }
      EXPECT_GE(one_sided, 1);
      EXPECT_GE(static_cast<int>(detection.lines.size()) - one_sided, 4);
    }
  }
}

// A depth image in millimetres: a wall at 3 m, and an object at 2 m that fills the rectangle.
cv::Mat DepthOfAnObject(const cv::Rect& object) {
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(3000));
  depth(object) = 2000;
  return depth;
}

TEST(DetectionBuilder, SidesHiddenBySomethingNearerAreOneSided) {
  const InstanceMask mask = RectangleMask(200.0, 150.0, 119.0, 99.0);
  cv::Mat depth = DepthOfAnObject({200, 150, 120, 100});
  EXPECT_EQ(SidesOneSided(BuildOne(mask, PlainCamera(), {}, depth)),
            (std::vector<bool>{false, false, false, false}));
  depth(cv::Rect(320, 100, 80, 200)) = 1500;  // on its right, nearer
  EXPECT_EQ(SidesOneSided(BuildOne(mask, PlainCamera(), {}, depth)),
            (std::vector<bool>{true, false, false, false}));
  depth(cv::Rect(320, 100, 80, 200)) =
      1960;  // a little nearer, as noise or a slanted surface could be
  EXPECT_EQ(SidesOneSided(BuildOne(mask, PlainCamera(), {}, depth)),
            (std::vector<bool>{false, false, false, false}));
  depth(cv::Rect(320, 150, 80, 30)) = 1500;  // less than half of the side
  EXPECT_EQ(SidesOneSided(BuildOne(mask, PlainCamera(), {}, depth)),
            (std::vector<bool>{false, false, false, false}));
  EXPECT_EQ(SidesOneSided(BuildOne(mask, PlainCamera())),
            (std::vector<bool>{false, false, false, false}));
}

TEST(DetectionBuilder, OcclusionIsSeenInDepthInMetresToo) {
  const InstanceMask mask = RectangleMask(200.0, 150.0, 119.0, 99.0);
  cv::Mat depth = DepthOfAnObject({200, 150, 120, 100});
  depth(cv::Rect(180, 250, 160, 80)) = 1500;  // below it
  cv::Mat metres;
  depth.convertTo(metres, CV_32FC1, 1e-3);
  EXPECT_EQ(SidesOneSided(BuildOne(mask, PlainCamera(), {}, metres)),
            (std::vector<bool>{false, true, false, false}));
}

// If the depth along the common border of two objects is unknown, their masks are used.
TEST(DetectionBuilder, ANearerMaskThatTouchesASideHidesIt) {
  const InstanceMask far = RectangleMask(200.0, 150.0, 119.0, 99.0, "book");
  const InstanceMask near = RectangleMask(320.0, 130.0, 99.0, 140.0, "cup");
  cv::Mat depth = DepthOfAnObject({200, 150, 120, 100});
  depth(cv::Rect(320, 130, 100, 140)) = 1500;
  depth(cv::Rect(305, 100, 30, 200)) = 0;
  const DetectionResult result = Build({far, near}, PlainCamera(), {}, depth);
  ASSERT_EQ(result.detections.size(), 2U);
  EXPECT_EQ(SidesOneSided(result.detections[0]), (std::vector<bool>{true, false, false, false}));
  EXPECT_EQ(SidesOneSided(result.detections[1]), (std::vector<bool>{false, false, false, false}));
}

// A table under a cup. Below the cup in the image, the surface of the table is nearer to the
// camera. It meets the cup at the common border, so it does not hide it.
TEST(DetectionBuilder, TheSurfaceThatAnObjectStandsOnDoesNotHideIt) {
  const InstanceMask cup = RectangleMask(280.0, 200.0, 79.0, 99.0, "cup");
  const InstanceMask table = RectangleMask(100.0, 180.0, 439.0, 280.0, "dining table", 0.5);
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(3000));
  for (int y = 180; y < 460; ++y) {
    depth.row(y).colRange(100, 540) = 2000 - 12 * (y - 300);  // 12 mm nearer with each row
  }
  depth(cv::Rect(280, 200, 80, 100)) = 2000;
  EXPECT_EQ(SidesOneSided(BuildOne(cup, PlainCamera(), {}, depth)),
            (std::vector<bool>{false, false, false, false}));
  // Its mask has a nearer median depth than the cup, and the depth along the border is unknown.
  depth(cv::Rect(270, 190, 10, 120)) = 0;
  depth(cv::Rect(360, 190, 10, 120)) = 0;
  const DetectionResult result = Build({cup, table}, PlainCamera(), {}, depth);
  ASSERT_EQ(result.detections.size(), 2U);
  EXPECT_EQ(SidesOneSided(result.detections[0]), (std::vector<bool>{false, false, false, false}));
}

TEST(DetectionBuilder, DepthOfTheBackgroundIsLeftOut) {
  const InstanceMask mask = RectangleMask(200.0, 150.0, 100.0, 60.0, "chair");
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(2000));
  depth(cv::Rect(260, 100, 100, 200)) = 2250;  // at 500 px of focal length 100 px are 0.4 m
  EXPECT_GT(BuildOne(mask, PlainCamera(), {}, depth).points.size(), 100U);
  size_t far = 0;
  const auto count_far = [&] {
    far = 0;
    for (const Eigen::Vector3d& point : BuildOne(mask, PlainCamera(), {}, depth).points.Unpack()) {
      far += point.z() > 2.1 ? 1 : 0;
    }
    return far;
  };
  EXPECT_GT(count_far(), 20U);
  depth(cv::Rect(260, 100, 100, 200)) = 2350;
  EXPECT_EQ(count_far(), 0U);
}

TEST(DetectionBuilder, AllPartsExceptSmallOnesFormOneHull) {
  InstanceMask mask = RectangleMask(100.0, 100.0, 60.0, 80.0);
  mask.outlines.push_back(Rectangle(200.0, 110.0, 40.0, 60.0));
  mask.outlines.push_back(Rectangle(400.0, 400.0, 10.0, 10.0));  // 2 % of the first part's area
  const Detection detection = BuildOne(mask, PlainCamera());
  EXPECT_EQ(detection.box.min(), Eigen::Vector2d(100.0, 100.0));
  EXPECT_EQ(detection.box.max(), Eigen::Vector2d(240.0, 180.0));
  EXPECT_NEAR(SignedArea(detection.contour.Unpack()), 60.0 * 80.0, 0.1);
  EXPECT_EQ(detection.hull, ConvexHull(std::vector<Eigen::Vector2d>{{100.0, 100.0},
                                                                    {160.0, 100.0},
                                                                    {100.0, 180.0},
                                                                    {160.0, 180.0},
                                                                    {240.0, 110.0},
                                                                    {240.0, 170.0}}));
}

TEST(DetectionBuilder, TellsWhyAMaskIsRejected) {
  const InstanceMask good = RectangleMask(100.0, 100.0, 60.0, 80.0);
  EXPECT_EQ(RejectionOf(good), std::nullopt);
  DetectionOptions strict;
  strict.min_score = 0.85;
  EXPECT_EQ(RejectionOf(good, strict), Reason::kLowScore);
  DetectionOptions textured;
  textured.min_keypoints = 2;
  EXPECT_EQ(RejectionOf(good, textured), Reason::kFewKeypoints);
  EXPECT_EQ(RejectionOf(RectangleMask(100.0, 100.0, 80.0, 6.0)), Reason::kTooSmall);
  DetectionOptions large;
  large.min_area_px2 = 4801.0;  // the good one has 60 x 80
  EXPECT_EQ(RejectionOf(good, large), Reason::kTooSmall);
  large.min_area_px2 = 4799.0;
  EXPECT_EQ(RejectionOf(good, large), std::nullopt);
  EXPECT_EQ(RejectionOf(RectangleMask(20.0, 20.0, 500.0, 400.0)), Reason::kTooLarge);
  EXPECT_EQ(RejectionOf(RectangleMask(0.0, 0.0, 639.0, 200.0)), std::nullopt);
  // With this border all its sides are cut.
  DetectionOptions wide;
  wide.border_px = 130.0;
  EXPECT_EQ(RejectionOf(RectangleMask(50.0, 50.0, 60.0, 60.0), wide), Reason::kNoSilhouette);
  EXPECT_EQ(RejectionOf(RectangleMask(-90.0, 50.0, 60.0, 60.0)), Reason::kNoSilhouette);
}

TEST(DetectionBuilder, RejectsOutlinesWithoutAnArea) {
  InstanceMask mask = RectangleMask(100.0, 100.0, 60.0, 80.0);
  mask.outlines = {};
  EXPECT_EQ(RejectionOf(mask), Reason::kDegenerate);
  mask.outlines = {{}};
  EXPECT_EQ(RejectionOf(mask), Reason::kDegenerate);
  mask.outlines = {{{10.0, 10.0}, {50.0, 50.0}, {90.0, 90.0}}};
  EXPECT_EQ(RejectionOf(mask), Reason::kDegenerate);
  mask.outlines = {std::vector<Eigen::Vector2d>(5, Eigen::Vector2d(30.0, 40.0))};
  EXPECT_EQ(RejectionOf(mask), Reason::kDegenerate);
}

TEST(DetectionBuilder, KeepsTheOrderAndClassOfMasks) {
  const DetectionResult result = Build({RectangleMask(20.0, 20.0, 60.0, 60.0, "cup", 0.3),
                                        RectangleMask(200.0, 20.0, 60.0, 4.0, "pen", 0.9),
                                        RectangleMask(300.0, 300.0, 80.0, 60.0, "book", 0.8)},
                                       PlainCamera());
  ASSERT_EQ(result.detections.size(), 2U);
  EXPECT_EQ(result.detections[0].label, "cup");
  EXPECT_EQ(result.detections[0].score, 0.3);
  EXPECT_EQ(result.detections[1].label, "book");
  EXPECT_EQ(result.rejections,
            (std::vector<std::optional<Reason>>{std::nullopt, Reason::kTooSmall, std::nullopt}));
}

TEST(DetectionBuilder, OneObjectUnderTwoClassesIsOneDetection) {
  const DetectionResult result = Build({RectangleMask(200.0, 150.0, 100.0, 80.0, "laptop", 0.4),
                                        RectangleMask(203.0, 152.0, 100.0, 80.0, "tv", 0.7)},
                                       PlainCamera());
  ASSERT_EQ(result.detections.size(), 1U);
  EXPECT_EQ(result.detections[0].label, "tv");
  EXPECT_EQ(result.rejections[0], Reason::kDuplicate);
}

TEST(DetectionBuilder, AFragmentIsADuplicateOnlyAtTheSameDepth) {
  const std::vector<InstanceMask> masks{RectangleMask(200.0, 150.0, 120.0, 80.0, "keyboard", 0.9),
                                        RectangleMask(202.0, 152.0, 52.0, 76.0, "keyboard", 0.5)};
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(2000));
  EXPECT_EQ(Build(masks, PlainCamera(), {}, depth).rejections[1], Reason::kDuplicate);
  depth(cv::Rect(202, 152, 53, 77)) = 1500;
  EXPECT_EQ(Build(masks, PlainCamera(), {}, depth).rejections[1], std::nullopt);
}

// Networks outline one thing twice: the book, and the book with the paper under it.
TEST(DetectionBuilder, MasksOfOneClassThatOverlapAreOneObjectIfNoDepthTellsThemApart) {
  const auto second = [](double width, const std::string& label) {
    return std::vector<InstanceMask>{RectangleMask(200.0, 150.0, 120.0, 80.0, "book", 0.9),
                                     RectangleMask(200.0, 150.0, width, 80.0, label, 0.5)};
  };
  EXPECT_EQ(Build(second(50.0, "book"), PlainCamera()).rejections[1], Reason::kDuplicate);
  // Two instances may share their border, but not much more.
  EXPECT_EQ(Build(second(25.0, "book"), PlainCamera()).rejections[1], std::nullopt);
  EXPECT_EQ(Build(second(50.0, "cup"), PlainCamera()).rejections[1], std::nullopt);
  DetectionOptions options;
  options.duplicate_class_iou = 0.45;
  EXPECT_EQ(Build(second(50.0, "book"), PlainCamera(), options).rejections[1], std::nullopt);
  EXPECT_EQ(Build(second(60.0, "book"), PlainCamera(), options).rejections[1], Reason::kDuplicate);

  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(2000));
  depth(cv::Rect(200, 150, 51, 81)) = 1500;
  EXPECT_EQ(Build(second(50.0, "book"), PlainCamera(), {}, depth).rejections[1], std::nullopt);
  depth(cv::Rect(200, 150, 51, 81)) = 0;
  EXPECT_EQ(Build(second(50.0, "book"), PlainCamera(), {}, depth).rejections[1],
            Reason::kDuplicate);
}

// The box of a chair contains much of the chair behind it.
TEST(DetectionBuilder, BoxesOfOneClassThatOverlapAreTwoObjects) {
  std::vector<InstanceMask> boxes{RectangleMask(200.0, 150.0, 120.0, 80.0, "chair", 0.9),
                                  RectangleMask(200.0, 150.0, 60.0, 80.0, "chair", 0.5)};
  boxes[0].shape = MaskShape::kBox;
  EXPECT_EQ(Build(boxes, PlainCamera()).rejections[1], std::nullopt);
  boxes[1].shape = MaskShape::kBox;
  EXPECT_EQ(Build(boxes, PlainCamera()).rejections[1], std::nullopt);
}

// If one mask contains another one, they can still show two objects.
TEST(DetectionBuilder, ACupBeforeAMonitorIsADetectionOfItsOwn) {
  const InstanceMask cup = RectangleMask(260.0, 200.0, 30.0, 40.0, "cup", 0.6);
  // In the first case the cup is cut out of the monitor's mask, but is inside its hull. In the
  // second case the monitor's mask covers the cup.
  InstanceMask with_hole = RectangleMask(200.0, 100.0, 160.0, 140.0, "tv", 0.9);
  with_hole.outlines = {{{200.0, 100.0},
                         {360.0, 100.0},
                         {360.0, 240.0},
                         {292.0, 240.0},
                         {292.0, 198.0},
                         {258.0, 198.0},
                         {258.0, 240.0},
                         {200.0, 240.0}}};
  const InstanceMask covering = RectangleMask(200.0, 100.0, 160.0, 140.0, "tv", 0.9);
  const cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(2000));
  for (const InstanceMask& monitor : {with_hole, covering}) {
    EXPECT_EQ(Build({monitor, cup}, PlainCamera()).detections.size(), 2U);
    EXPECT_EQ(Build({monitor, cup}, PlainCamera(), {}, depth).detections.size(), 2U);
  }
}

TEST(DetectionBuilder, ABoxGivesItsFourSidesForAnyPrimitive) {
  for (const ObjectPrimitive primitive :
       {ObjectPrimitive::kSupport, ObjectPrimitive::kHull, ObjectPrimitive::kConic}) {
    for (const bool is_reversed : {false, true}) {
      InstanceMask box = RectangleMask(3.0, 100.0, 80.0, 60.0);
      box.shape = MaskShape::kBox;
      if (is_reversed) std::reverse(box.outlines[0].begin(), box.outlines[0].end());
      const Detection detection = BuildOne(box, PlainCamera(), WithPrimitive(primitive));
      EXPECT_TRUE(detection.is_box);
      ASSERT_EQ(detection.lines.size(), 4U);
      EXPECT_EQ(SidesOneSided(detection), (std::vector<bool>{false, false, true, false}));
      for (const SilhouetteLine& line : detection.lines) {
        const Eigen::Vector2d center(43.0, 130.0);
        EXPECT_NEAR(line.line.SignedDistance(center),
                    std::abs(line.line.normal.x()) > 0.5 ? -40.0 : -30.0, 1e-9);
      }
    }
  }
}

// The box of a detector touches the object somewhere on its sides, which are curved after
// undistortion, and not at its corners.
TEST(DetectionBuilder, SidesOfADistortedBoxAreTheUndistortedSides) {
  const PinholeCamera camera = DistortedCamera();
  InstanceMask box = RectangleMask(20.0, 20.0, 150.0, 120.0);
  box.shape = MaskShape::kBox;
  for (const SilhouetteLine& line : BuildOne(box, camera).lines) {
    double least = 1e9;
    double most = -1e9;
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      for (size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d& from = box.outlines[0][i];
        const Eigen::Vector2d along = box.outlines[0][(i + 1) % 4] - from;
        const Eigen::Vector2d outwards(along.y(), -along.x());
        if (outwards.normalized().dot(line.line.normal) > 0.9) {
          const double distance = line.line.SignedDistance(camera.Undistort(from + share * along));
          least = std::min(least, distance);
          most = std::max(most, distance);
        }
      }
    }
    EXPECT_LT(most, 1.5);
    EXPECT_GT(least, -1.5);
    EXPECT_LE(least, 1e-9);
    EXPECT_GE(most, -1e-9);
  }
}

TEST(DetectionBuilder, AnEllipseGivesItsTangents) {
  const Ellipse truth = SeenEllipsoid();
  InstanceMask mask = MaskOf(truth, DistortedCamera());
  mask.shape = MaskShape::kEllipse;
  const Detection detection = BuildOne(mask, DistortedCamera());
  ASSERT_TRUE(detection.ellipse);
  EXPECT_EQ(detection.lines.size(), 16U);
  EXPECT_LT(LargestExcess(detection, truth), 0.1);
}

TEST(DetectionBuilder, ConicGivesTheFittedEllipseAndItsTangents) {
  const Ellipse truth = SeenEllipsoid();
  const InstanceMask mask = MaskOf(truth, DistortedCamera());
  const Detection detection =
      BuildOne(mask, DistortedCamera(), WithPrimitive(ObjectPrimitive::kConic));
  ASSERT_TRUE(detection.ellipse);
  EXPECT_LT((detection.ellipse->center - truth.center).norm(), 0.05);
  EXPECT_LT(LargestExcess(detection, truth), 0.1);
  for (const SilhouetteLine& line : detection.lines) {
    EXPECT_NEAR(Excess(line.line, *detection.ellipse), 0.0, 1e-9);
  }
  EXPECT_FALSE(BuildOne(mask, DistortedCamera()).ellipse);
}

TEST(DetectionBuilder, BoxEllipseTouchesTheMiddleOfTheSidesOfTheBox) {
  const Detection detection =
      BuildOne(MaskOf(SeenEllipsoid(), DistortedCamera()), DistortedCamera(),
               WithPrimitive(ObjectPrimitive::kBoxEllipse));
  ASSERT_TRUE(detection.ellipse);
  const Eigen::AlignedBox2d bounds = detection.ellipse->Bounds();
  EXPECT_LT((bounds.min() - detection.box.min()).norm(), 1e-9);
  EXPECT_LT((bounds.max() - detection.box.max()).norm(), 1e-9);
  EXPECT_EQ(detection.ellipse->shape(0, 1), 0.0);
  EXPECT_EQ(detection.lines.size(), 16U);
  for (const SilhouetteLine& line : detection.lines) {
    EXPECT_NEAR(Excess(line.line, *detection.ellipse), 0.0, 1e-9);
  }
}

TEST(DetectionBuilder, BoxOfAContourHasFourTangents) {
  const Ellipse truth = SeenEllipsoid();
  const Detection detection = BuildOne(MaskOf(truth, DistortedCamera()), DistortedCamera(),
                                       WithPrimitive(ObjectPrimitive::kBox));
  EXPECT_EQ(detection.lines.size(), 4U);
  EXPECT_LT(LargestExcess(detection, truth), 0.1);
  EXPECT_FALSE(detection.is_box);
}

TEST(DetectionBuilder, ContourFollowsAnInwardCornerAndTheHullDoesNot) {
  InstanceMask mask = RectangleMask(0.0, 0.0, 1.0, 1.0);
  mask.outlines = {{{100.0, 100.0},
                    {200.0, 100.0},
                    {200.0, 140.0},
                    {140.0, 140.0},
                    {140.0, 200.0},
                    {100.0, 200.0}}};  // an L
  const Detection contour = BuildOne(mask, PlainCamera(), WithPrimitive(ObjectPrimitive::kContour));
  EXPECT_EQ(contour.lines.size(), 6U);
  const Detection hull = BuildOne(mask, PlainCamera(), WithPrimitive(ObjectPrimitive::kHull));
  EXPECT_EQ(hull.lines.size(), 5U);
  const auto cuts_the_hull = [](const Detection& detection) {
    return std::count_if(detection.lines.begin(), detection.lines.end(), [&](const auto& line) {
      return std::any_of(detection.hull.begin(), detection.hull.end(), [&](const auto& corner) {
        return line.line.SignedDistance(corner) > 1.0;
      });
    });
  };
  EXPECT_EQ(cuts_the_hull(contour), 2);
  EXPECT_EQ(cuts_the_hull(hull), 0);
}

TEST(DetectionBuilder, ShortEdgesGiveNoLine) {
  InstanceMask mask = RectangleMask(0.0, 0.0, 1.0, 1.0);
  mask.outlines = {
      {{100.0, 100.0}, {200.0, 100.0}, {204.0, 103.0}, {200.0, 200.0}, {100.0, 200.0}}};
  DetectionOptions options = WithPrimitive(ObjectPrimitive::kHull, 0.0);
  options.min_line_px = 6.0;
  EXPECT_EQ(BuildOne(mask, PlainCamera(), options).lines.size(), 4U);
  options.min_line_px = 4.0;
  EXPECT_EQ(BuildOne(mask, PlainCamera(), options).lines.size(), 5U);
}

TEST(DetectionBuilder, DepthPointsAreInsideTheErodedMaskOnAGrid) {
  const PinholeCamera camera = DistortedCamera();
  const cv::Mat depth = DepthOfAnObject({200, 150, 120, 100});
  const InstanceMask mask = RectangleMask(200.0, 150.0, 119.0, 99.0);
  const Detection detection = BuildOne(mask, camera, {}, depth);
  EXPECT_GT(detection.points.size(), 100U);
  EXPECT_LE(detection.points.size(), 200U);
  std::set<int> columns;
  for (const Eigen::Vector3d& point : detection.points.Unpack()) {
    EXPECT_NEAR(point.z(), 2.0, 1e-6);
    const Eigen::Vector2d raw = camera.Distort(camera.Project(point));
    EXPECT_LT((raw - raw.array().round().matrix()).norm(), 2e-3);
    EXPECT_GE(raw.x(), 204.9);
    EXPECT_LE(raw.x(), 315.1);
    EXPECT_GE(raw.y(), 154.9);
    EXPECT_LE(raw.y(), 245.1);
    columns.insert(static_cast<int>(std::lround(raw.x())));
  }
  EXPECT_LT(columns.size(), 20U);
  DetectionOptions few;
  few.max_depth_points = 30;
  EXPECT_LE(BuildOne(mask, camera, few, depth).points.size(), 30U);
  EXPECT_TRUE(BuildOne(mask, camera).points.empty());
}

TEST(DetectionBuilder, UnknownDepthGivesNoPoints) {
  cv::Mat depth = DepthOfAnObject({200, 150, 120, 100});
  depth(cv::Rect(200, 150, 60, 100)) = 0;
  const Detection detection =
      BuildOne(RectangleMask(200.0, 150.0, 119.0, 99.0), PlainCamera(), {}, depth);
  EXPECT_FALSE(detection.points.empty());
  for (const Eigen::Vector3d& point : detection.points.Unpack()) {
    EXPECT_GE(PlainCamera().Project(point).x(), 259.9);
  }
}

TEST(DetectionBuilder, KeypointsAreThoseInAnyPartOfTheMask) {
  InstanceMask mask = RectangleMask(100.0, 100.0, 60.0, 80.0);
  mask.outlines.push_back(Rectangle(200.0, 110.0, 40.0, 60.0));
  std::vector<RawKeypoint> keypoints(5);
  keypoints[0].raw = {50.0f, 50.0f};
  keypoints[1].raw = {120.0f, 150.0f};
  keypoints[2].raw = {180.0f, 140.0f};  // in the hull, between the parts
  keypoints[3].raw = {220.0f, 140.0f};
  keypoints[4].raw = {1e6f, -1e6f};
  const DetectionResult result =
      DetectionBuilder(PlainCamera(), kUnits, {}).Build(std::vector{mask}, {}, keypoints);
  ASSERT_EQ(result.detections.size(), 1U);
  EXPECT_EQ(result.detections[0].keypoints, (std::vector<uint32_t>{1, 3}));
}

TEST(DetectionBuilder, RefusesADepthImageOfAnotherKind) {
  const std::vector<InstanceMask> masks{RectangleMask(100.0, 100.0, 60.0, 80.0)};
  EXPECT_THROW(Build(masks, PlainCamera(), {}, cv::Mat(240, 320, CV_16UC1, cv::Scalar(1))),
               CheckError);
  EXPECT_THROW(Build(masks, PlainCamera(), {}, cv::Mat(480, 640, CV_8UC1, cv::Scalar(1))),
               CheckError);
}

TEST(DetectionRejection, HasANameForEach) {
  std::set<std::string> names;
  for (int i = 0; i < kDetectionRejectionCount; ++i) {
    names.insert(ToString(static_cast<DetectionRejection>(i)));
  }
  EXPECT_EQ(names.size(), static_cast<size_t>(kDetectionRejectionCount));
  EXPECT_EQ(ToString(DetectionRejection::kNoSilhouette), "no_silhouette");
}

// A line is a plane through the centre, so it touches the ellipsoid at all angles; in the raw image
// its error is some tenths of a pixel.
TEST(DetectionBuilder, LinesAtTheRimOfAFisheyeTouchTheObject) {
  const PinholeCamera camera = FisheyeCamera();
  for (const double degrees : {0.0, 40.0, 60.0, 70.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    Ellipsoid ellipsoid;
    ellipsoid.world_from_object.translation = {2.0 * std::sin(angle), 0.1, 2.0 * std::cos(angle)};
    ellipsoid.half_axes = {0.15, 0.2, 0.12};
    const auto projected = ProjectEllipsoid(camera.Matrix(), Rigid3(), ellipsoid);
    ASSERT_TRUE(projected);
    const Detection detection = BuildOne(MaskOf(*projected, camera), camera);
    ASSERT_GE(detection.lines.size(), 8u) << degrees;
    EXPECT_FALSE(detection.is_cut);
    for (const SilhouetteLine& line : detection.lines) {
      EXPECT_FALSE(line.is_one_sided);
      const Eigen::Vector2d touching =
          projected->center +
          projected->shape * line.line.normal / projected->HalfExtent(line.line.normal);
      const double raw_per_pixel =
          1.0 / (camera.DistortionJacobian(touching).inverse().transpose() *
                 Eigen::Vector2d(line.line.normal))
                    .norm();
      EXPECT_LT(std::abs(Excess(line.line, *projected)) * raw_per_pixel, 0.3) << degrees;
    }
  }
}

TEST(DetectionBuilder, TheLargestAngleOfAFisheyeCutsAMask) {
  PinholeCamera camera = FisheyeCamera();
  camera.width = 900;
  camera.cx = 450.0;
  const InstanceMask mask = RectangleMask(750.0, 210.0, 60.0, 60.0);
  const Detection detection = BuildOne(mask, camera);
  EXPECT_TRUE(detection.is_cut);
  const auto one_sided = std::count_if(detection.lines.begin(), detection.lines.end(),
                                       [](const auto& line) { return line.is_one_sided; });
  EXPECT_GT(one_sided, 0);
  EXPECT_LT(one_sided, static_cast<int>(detection.lines.size()));
}

}  // namespace
}  // namespace hullslam
