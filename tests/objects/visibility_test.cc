// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <utility>

#include "camera/wide_lens.h"
#include "objects/made_objects.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

// A cup that a camera at the world's origin sees 1 m ahead.
class Visibility : public ::testing::Test {
 protected:
  Visibility() {
    cup_.world_from_object.translation = {0.0, 0.0, 1.0};
    cup_.half_axes = {0.05, 0.05, 0.06};
    const KeyframeId first = AddObserver(map_, sensor_, Rigid3(), {{"cup", cup_}});
    id_ = map_.AddObject();
    map_.AddObservation(id_, first, 0);
    SetMapped(id_, cup_);
  }
  void SetMapped(ObjectId id, const Ellipsoid& ellipsoid) {
    ObjectLandmark& object = map_.MutableObject(id);
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = ellipsoid;
  }
  KeyframeId Add(const Rigid3& cam_from_world, std::shared_ptr<Frame> frame) {
    return map_.AddKeyframe(std::move(frame), cam_from_world);
  }
  // A keyframe that has only a depth image.
  KeyframeId Look(const Rigid3& cam_from_world, const cv::Mat& depth = {}) {
    auto frame = std::make_shared<Frame>();
    frame->depth = DepthGrid(depth, 1000.0);
    return Add(cam_from_world, std::move(frame));
  }
  bool Shows(KeyframeId keyframe) const {
    return FindVisibility(map_, sensor_, keyframe, map_.objects().At(id_), options_) ==
           LocationVisibility::kVisible;
  }
  static Rigid3 Back(double metres) { return {Eigen::Quaterniond::Identity(), {0, 0, metres}}; }
  static cv::Mat Wall(int millimetres) {
    return cv::Mat(480, 640, CV_16UC1, cv::Scalar(millimetres));
  }

  Sensor sensor_ = MakeObjectSensor();
  ObjectOptions options_;
  Map map_;
  Ellipsoid cup_;
  ObjectId id_;
};

TEST_F(Visibility, IsExpectedInTheImageUpToTheRange) {
  EXPECT_TRUE(Shows(Look(Rigid3())));
  EXPECT_TRUE(Shows(Look(Back(0.24))));  // max_range is 1.25
  EXPECT_FALSE(Shows(Look(Back(0.26))));
  EXPECT_FALSE(Shows(Look(Back(-2.0))));  // behind the camera
  Rigid3 aside;
  aside.translation.x() = 0.6;  // cut by the border of the image
  EXPECT_FALSE(Shows(Look(aside)));
}

TEST_F(Visibility, IsNotExpectedWhereTheMaskOfAllImagesIgnoresPixels) {
  const KeyframeId keyframe = Look(Rigid3());
  sensor_.mask_all = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  EXPECT_TRUE(Shows(keyframe));
  sensor_.mask_all(cv::Rect(0, 230, 640, 250)).setTo(0);  // its lower half
  EXPECT_FALSE(Shows(keyframe));
  sensor_.mask_all.setTo(255);
  sensor_.mask_all(cv::Rect(0, 400, 640, 80)).setTo(0);
  EXPECT_TRUE(Shows(keyframe));
}

TEST_F(Visibility, APartInTheImageCanBeEnough) {
  Rigid3 aside;
  aside.translation.x() = 0.6;  // the border of the image cuts a little of it
  const KeyframeId keyframe = Look(aside);
  const auto shows = [&](double min_inside) {
    return FindVisibility(map_, sensor_, keyframe, map_.objects().At(id_), options_, min_inside) ==
           LocationVisibility::kVisible;
  };
  EXPECT_FALSE(shows(1.0));
  EXPECT_TRUE(shows(0.5));
  Rigid3 far_aside;
  far_aside.translation.x() = 1.2;
  EXPECT_EQ(FindVisibility(map_, sensor_, Look(far_aside), map_.objects().At(id_), options_, 0.01),
            LocationVisibility::kOutside);
}

TEST_F(Visibility, IsNotExpectedBehindANearerSurface) {
  EXPECT_TRUE(Shows(Look(Rigid3(), Wall(3000))));  // a wall behind it
  EXPECT_TRUE(Shows(Look(Rigid3(), Wall(0))));     // unknown depth hides nothing
  EXPECT_FALSE(Shows(Look(Rigid3(), Wall(500))));  // a wall before it
  EXPECT_TRUE(Shows(Look(Rigid3(), Wall(930))));   // its own surface, a little nearer
  cv::Mat half = Wall(3000);
  half(cv::Rect(0, 0, 310, 480)) = 500;
  EXPECT_FALSE(Shows(Look(Rigid3(), half)));  // 40 % of it are hidden
  cv::Mat rim = Wall(3000);
  rim(cv::Rect(0, 0, 300, 480)) = 500;
  EXPECT_TRUE(Shows(Look(Rigid3(), rim)));
  cv::Mat corner = Wall(3000);
  corner(cv::Rect(0, 0, 310, 236)) = 500;  // hides some of it
  EXPECT_TRUE(Shows(Look(Rigid3(), corner)));
}

TEST_F(Visibility, WithoutDepthLandmarksShowNearerSurfaces) {
  const auto look = [&](double z) {
    auto frame = std::make_shared<Frame>();
    const std::vector<Eigen::Vector2f> pixels = {{320, 240}, {330, 240}, {320, 250}, {20, 20}};
    for (const Eigen::Vector2f& pixel : pixels) {
      frame->features.keypoints.push_back({.undistorted = pixel});
      frame->features.descriptors.emplace_back();
      frame->features.depth.push_back(0.0f);
    }
    const KeyframeId keyframe = Add(Rigid3(), std::move(frame));
    for (uint32_t i = 0; i < pixels.size(); ++i) {
      const LandmarkId id =
          map_.AddLandmark(sensor_.camera.Unproject(pixels[i].cast<double>(), z), keyframe);
      map_.AddObservation(id, keyframe, i);
    }
    return keyframe;
  };
  EXPECT_FALSE(Shows(look(0.5)));
  EXPECT_TRUE(Shows(look(2.0)));
}

TEST_F(Visibility, IsNotExpectedBehindANearerObject) {
  Ellipsoid box;
  box.world_from_object.translation = {0.0, 0.0, 0.6};
  box.half_axes = {0.1, 0.1, 0.1};
  const KeyframeId keyframe = AddObserver(map_, sensor_, Rigid3(), {{"box", box}});
  const ObjectId other = map_.AddObject();
  map_.AddObservation(other, keyframe, 0);
  map_.MutableObject(other).has_shape = true;
  map_.MutableObject(other).ellipsoid = box;
  EXPECT_TRUE(Shows(keyframe));  // a candidate hides nothing
  SetMapped(other, box);
  EXPECT_FALSE(Shows(keyframe));
  box.world_from_object.translation = {0.0, 0.0, 0.98};  // not nearer as a whole
  SetMapped(other, box);
  EXPECT_TRUE(Shows(keyframe));
}

class VisibilityWith : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(VisibilityWith);

// A ball whose image reaches far to the right, where the image of a fisheye bends its box. Only the
// depths near its right end are known. They are either before it or behind it.
TEST_P(VisibilityWith, TheDepthsOnAWideObjectAreFoundAtItsEnds) {
  const Sensor& sensor = GetParam().sensor;
  const PinholeCamera& camera = sensor.camera;
  const Eigen::Vector3d border =
      camera.Unproject(camera.Undistort({0.85 * camera.width, camera.cy}), 1.0);
  Ellipsoid ball;
  ball.world_from_object.translation = {0.0, 0.0, 3.0};
  ball.half_axes.setConstant(3.0 * std::sin(std::atan(border.x())));
  const Ellipse ellipse = ProjectEllipsoid(camera.Matrix(), Rigid3(), ball).value();
  const double right = ellipse.center.x() + 0.9 * ellipse.HalfExtent(Eigen::Vector2d::UnitX());
  Map map;
  const ObjectId id = map.AddObject();
  map.AddObservation(id, AddObserver(map, sensor, Rigid3(), {{"ball", ball}}), 0);
  map.MutableObject(id).ellipsoid = ball;
  const auto visibility = [&](int millimetres) {
    cv::Mat depth(camera.height, camera.width, CV_16UC1, cv::Scalar(0));
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        if (camera.Undistort(Eigen::Vector2d(x, y)).x() > right) {
          depth.at<uint16_t>(y, x) = static_cast<uint16_t>(millimetres);
        }
      }
    }
    auto frame = std::make_shared<Frame>();
    frame->depth = DepthGrid(depth, 1000.0);
    const KeyframeId keyframe = map.AddKeyframe(std::move(frame), Rigid3());
    return FindVisibility(map, sensor, keyframe, map.objects().At(id), {}, 0.0);
  };
  EXPECT_EQ(visibility(50), LocationVisibility::kHidden);
  EXPECT_EQ(visibility(9000), LocationVisibility::kVisible);
}

// The image of a fisheye fills only a part of the box around its undistorted image.
TEST(VisibilityOfAFisheye, IsThatOfItsImage) {
  const Sensor sensor = FisheyeTestCamera().sensor;
  const auto visibility = [&](const Eigen::Vector2d& raw) {
    Ellipsoid ball;
    const Eigen::Vector3d ray = RayOfRawPixel(sensor.camera, raw, LargestAngle(sensor.camera, 1.5));
    ball.world_from_object.translation = 2.0 * ray;
    ball.half_axes.setConstant(0.05);
    Map map;
    const ObjectId id = map.AddObject();
    const KeyframeId keyframe = AddObserver(map, sensor, Rigid3(), {{"ball", ball}});
    map.AddObservation(id, keyframe, 0);
    map.MutableObject(id).ellipsoid = ball;
    return FindVisibility(map, sensor, keyframe, map.objects().At(id), {});
  };
  EXPECT_EQ(visibility({590.0, 243.0}), LocationVisibility::kVisible);
  EXPECT_EQ(visibility({318.0, 440.0}), LocationVisibility::kVisible);
  // Below the image, but within the box, which reaches as far as its corners do.
  EXPECT_EQ(visibility({318.0, 520.0}), LocationVisibility::kOutside);
}

class SeeingThrough : public Visibility {
 protected:
  bool IsSeen(const Rigid3& cam_from_world, const cv::Mat& depth) const {
    Frame frame;
    frame.depth = DepthGrid(depth, 1000.0);
    return SeesThrough(sensor_, frame, cam_from_world, cup_, 0.8);
  }
};

TEST_F(SeeingThrough, NeedsDepthBehindTheObject) {
  EXPECT_TRUE(IsSeen(Rigid3(), Wall(1500)));
  EXPECT_TRUE(IsSeen(Rigid3(), Wall(1070)));   // just behind its back
  EXPECT_FALSE(IsSeen(Rigid3(), Wall(1000)));  // in its middle
  EXPECT_FALSE(IsSeen(Rigid3(), Wall(960)));   // its surface
  EXPECT_FALSE(IsSeen(Rigid3(), Wall(500)));   // something hides it
  EXPECT_FALSE(IsSeen(Rigid3(), Wall(0)));     // unknown
  EXPECT_FALSE(IsSeen(Rigid3(), cv::Mat()));
  EXPECT_FALSE(IsSeen(Back(-3.0), Wall(1500)));  // it is behind the camera
}

TEST_F(SeeingThrough, NeedsMostOfTheSurfacesBehindIt) {
  cv::Mat most = Wall(1500);
  most(cv::Rect(0, 0, 296, 480)) = 1000;
  EXPECT_TRUE(IsSeen(Rigid3(), most));
  cv::Mat half = Wall(1500);
  half(cv::Rect(0, 0, 320, 480)) = 1000;
  EXPECT_FALSE(IsSeen(Rigid3(), half));
}

// A detector may miss what is far away or cut by the border of the image. Depth does not.
TEST_F(SeeingThrough, WorksFartherAwayAndAtTheBorder) {
  EXPECT_TRUE(IsSeen(Back(1.0), Wall(4000)));
  EXPECT_FALSE(IsSeen(Back(4.0), Wall(8000)));  // too few samples
  Rigid3 aside;
  aside.translation.x() = 0.6;
  EXPECT_TRUE(IsSeen(aside, Wall(4000)));
  aside.translation.x() = 1.2;
  EXPECT_FALSE(IsSeen(aside, Wall(4000)));
}

// The near side of the cup is at 0.94 m, its far side at 1.06 m. Rays near its centre see it nearly
// there.
TEST_F(Visibility, TheSurfaceIsMeasuredFromTheNearSide) {
  const auto surface_before = [&](const cv::Mat& depth) {
    const Keyframe& keyframe = map_.keyframes().At(Look(Rigid3(), depth));
    return MeasureSurface(
        map_, sensor_,
        {*keyframe.frame, keyframe.cam_from_world, keyframe.landmarks, keyframe.objects}, cup_);
  };
  const auto wall = surface_before(Wall(1500));
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->behind, 0.55, 0.02);
  EXPECT_NEAR(wall->thickness, 0.10, 0.02);
  EXPECT_NEAR(surface_before(Wall(900))->behind, -0.05, 0.02);
  EXPECT_FALSE(surface_before(Wall(0)));
  EXPECT_FALSE(surface_before({}));
}

// A camera without depth sees landmarks.
TEST_F(Visibility, TheSurfaceIsMeasuredFromLandmarks) {
  auto frame = std::make_shared<Frame>();
  for (const double x : {318.0, 320.0, 322.0}) {
    frame->features.keypoints.push_back({.undistorted = Eigen::Vector2f(x, 240.0)});
  }
  frame->features.descriptors.resize(3);
  frame->features.depth.resize(3, 0.0f);
  const KeyframeId id = Add(Rigid3(), frame);
  for (uint32_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d pixel = frame->features.keypoints[i].undistorted.cast<double>();
    map_.AddObservation(map_.AddLandmark(sensor_.camera.Unproject(pixel, 2.0), id), id, i);
  }
  const Keyframe& keyframe = map_.keyframes().At(id);
  const auto surface = MeasureSurface(
      map_, sensor_,
      {*keyframe.frame, keyframe.cam_from_world, keyframe.landmarks, keyframe.objects}, cup_);
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->behind, 1.06, 0.01);
}

// A cup that a camera at the world's origin sees 1 m ahead, in five keyframes.
class ContradictedObject : public ::testing::Test {
 protected:
  ContradictedObject() {
    cup_.world_from_object.translation = {0.0, 0.0, 1.0};
    cup_.half_axes = {0.05, 0.05, 0.06};
    id_ = map_.AddObject();
    map_.MutableObject(id_).ellipsoid = cup_;
    for (int i = 0; i < 5; ++i) {
      Find();
    }
  }
  void Join(KeyframeId id) {
    if (id != KeyframeId(0)) {
      map_.MutableKeyframe(id).covisible = map_.keyframes().At(KeyframeId(id.value - 1)).covisible;
      map_.MutableKeyframe(id).covisible.push_back({KeyframeId(id.value - 1), 20});
    }
    current_ = id;
  }
  void Find() {
    const KeyframeId id = AddObserver(map_, sensor_, Rigid3(), {{"cup", cup_}});
    map_.AddObservation(id_, id, 0);
    Join(id);
  }
  bool IsGoneAfter(int millimetres) {
    return IsGoneAfter(millimetres, FrameId(map_.keyframes().NextId().value));
  }
  // The keyframe is made of this frame, and observes the object if `is_found`.
  bool IsGoneAfter(int millimetres, FrameId id, bool is_found = false) {
    auto frame = std::make_shared<Frame>();
    frame->id = id;
    if (is_found) {
      frame->detections = {Detect({"cup", cup_}, sensor_, Rigid3())};
    }
    frame->depth = DepthGrid(cv::Mat(480, 640, CV_16UC1, cv::Scalar(millimetres)), 1000.0);
    Join(map_.AddKeyframe(std::move(frame), Rigid3()));
    if (is_found) {
      map_.AddObservation(id_, current_, 0);
    }
    return IsContradicted(map_, sensor_, current_, id_, options_, contradictions_);
  }

  const Sensor sensor_ = MakeObjectSensor();
  const ChangeOptions options_;
  Map map_;
  Contradictions<ObjectId> contradictions_;
  Ellipsoid cup_;
  ObjectId id_;
  KeyframeId current_;
};

TEST_F(ContradictedObject, IsGoneAfterThreeKeyframesThatSeeThroughIt) {
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_TRUE(IsGoneAfter(2000));
}

TEST_F(ContradictedObject, IsThereWhereDepthDoesNotShowWhatIsBehindIt) {
  for (const int millimetres : {500, 0, 1000, 950}) {
    for (int i = 0; i < 5; ++i) {
      EXPECT_FALSE(IsGoneAfter(millimetres)) << millimetres << " mm";
    }
  }
}

TEST_F(ContradictedObject, IsThereAgainOnceItIsObserved) {
  IsGoneAfter(2000);
  IsGoneAfter(2000);
  Find();
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_FALSE(IsGoneAfter(2000));
  EXPECT_FALSE(IsGoneAfter(500)) << "the newest keyframe does not contradict it";
  EXPECT_TRUE(IsGoneAfter(2000));
}

// A mask says more than depth: that of glass is the depth behind it. So a keyframe that observes
// the object does not contradict it, and the count begins again after it.
TEST_F(ContradictedObject, IsThereWhereItIsObserved) {
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(10)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(11)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(12), true));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(13)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(14)));
  EXPECT_TRUE(IsGoneAfter(2000, FrameId(15)));
}

// Late masks make a keyframe of a frame that was taken before the last observation.
TEST_F(ContradictedObject, AFrameBeforeTheLastObservationSaysNothing) {
  EXPECT_FALSE(IsGoneAfter(1000, FrameId(100), true));
  for (const uint32_t frame : {50U, 60U, 70U, 80U}) {
    EXPECT_FALSE(IsGoneAfter(2000, FrameId(frame)));
  }
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(101)));
  EXPECT_FALSE(IsGoneAfter(2000, FrameId(102)));
  EXPECT_TRUE(IsGoneAfter(2000, FrameId(103)));
}

}  // namespace

}  // namespace hullslam
