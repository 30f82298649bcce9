// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/mcap_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bags/image_messages.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

constexpr MessageCoding kCdr = MessageCoding::kCdr;

const Rigid3 kPose(ExpSo3({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0});

// Reads a header and expects this time and the frame.
void ExpectHeader(FieldReader& reader, RosTime time, const char* frame) {
  EXPECT_EQ(reader.Get<int32_t>(), time.seconds);
  EXPECT_EQ(reader.Get<uint32_t>(), time.nanoseconds);
  EXPECT_EQ(reader.GetText(), frame);
}

void ExpectNumbers(FieldReader& reader, const std::vector<double>& numbers) {
  for (const double number : numbers) {
    EXPECT_EQ(reader.Get<double>(), number);
  }
}

std::vector<double> NumbersOf(const Rigid3& pose) {
  return {pose.translation.x(), pose.translation.y(), pose.translation.z(), pose.rotation.x(),
          pose.rotation.y(),    pose.rotation.z(),    pose.rotation.w()};
}

ObjectResult Cup(ObjectState state) {
  ObjectResult object;
  object.id = ObjectId(7);
  object.state = state;
  object.label = "cup";
  object.votes = {{"bowl", 1.0}, {"cup", 3.0}};
  object.ellipsoid = {kPose, {0.1, 0.2, 0.3}};
  return object;
}

TEST(McapMessagesTest, TimesAreRoundedToMicroseconds) {
  EXPECT_EQ(ToRosTime(1305031102.175304).seconds, 1305031102);
  EXPECT_EQ(ToRosTime(1305031102.175304).nanoseconds, 175304000u);
  EXPECT_EQ(ToRosTime(1.9999999).seconds, 2);
  EXPECT_EQ(ToRosTime(1.9999999).nanoseconds, 0u);
  EXPECT_EQ(ToRosTime(1.5).Nanoseconds(), 1'500'000'000u);
  for (const double stamp : {-1.0, 3e9, std::nan("")}) {
    ExpectInputError([&] { ToRosTime(stamp); }, {"cannot be written", "ROS"});
  }
}

TEST(McapMessagesTest, OurReaderReadsImagesAndCameras) {
  const PinholeCamera camera{.fx = 500,
                             .fy = 510,
                             .cx = 320,
                             .cy = 240,
                             .k1 = 0.1,
                             .k2 = 0.2,
                             .p1 = 0.3,
                             .p2 = 0.4,
                             .k3 = 0.5};
  const CameraInfoMessage info = ReadCameraInfo(kCdr, CameraInfoMessageOf({1, 2}, camera), "m");
  EXPECT_EQ(info.width, 640u);
  EXPECT_EQ(info.k, (std::array<double, 9>{500, 0, 320, 0, 510, 240, 0, 0, 1}));
  EXPECT_EQ(info.distortion, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
  PinholeCamera rational = camera;
  rational.k6 = 0.8;
  const CameraInfoMessage of_rational =
      ReadCameraInfo(kCdr, CameraInfoMessageOf({1, 2}, rational), "m");
  EXPECT_EQ(of_rational.distortion_model, "rational_polynomial");
  EXPECT_EQ(of_rational.distortion, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.0, 0.0, 0.8}));
  PinholeCamera fisheye = camera;
  fisheye.lens = LensModel::kKannalaBrandt;
  fisheye.k4 = 0.6;
  const CameraInfoMessage of_fisheye =
      ReadCameraInfo(kCdr, CameraInfoMessageOf({1, 2}, fisheye), "m");
  EXPECT_EQ(of_fisheye.distortion_model, "equidistant");
  EXPECT_EQ(of_fisheye.distortion, (std::vector<double>{0.1, 0.2, 0.5, 0.6}));
  PinholeCamera sphere = camera;
  sphere.lens = LensModel::kDoubleSphere;
  sphere.xi = -0.2;
  sphere.alpha = 0.6;
  const CameraInfoMessage of_sphere =
      ReadCameraInfo(kCdr, CameraInfoMessageOf({1, 2}, sphere), "m");
  EXPECT_EQ(of_sphere.distortion_model, "double_sphere");
  EXPECT_EQ(of_sphere.distortion, (std::vector<double>{-0.2, 0.6}));
  const std::string message = JpegMessage({1, 2}, "jpeg bytes");
  const CompressedImageMessage image = ReadCompressedImage(kCdr, message, "m");
  EXPECT_EQ(image.stamp, (BagTime{1, 2}));
  EXPECT_EQ(image.format, "jpeg");
  EXPECT_EQ(image.data, "jpeg bytes");
}

TEST(McapMessagesTest, PosesAreThoseOfTheCameraInTheMap) {
  const std::string transform = TransformMessage({3, 4}, kPose);
  FieldReader reader(kCdr, transform, "tf");
  EXPECT_EQ(reader.Get<uint32_t>(), 1u);
  ExpectHeader(reader, {3, 4}, "map");
  EXPECT_EQ(reader.GetText(), "camera");
  ExpectNumbers(reader, NumbersOf(kPose));
  const std::string path = PathMessage({3, 4}, {{5.5, kPose}});
  FieldReader of_path(kCdr, path, "path");
  ExpectHeader(of_path, {3, 4}, "map");
  EXPECT_EQ(of_path.Get<uint32_t>(), 1u);
  ExpectHeader(of_path, {5, 500'000'000}, "map");
  ExpectNumbers(of_path, NumbersOf(kPose));
}

// The camera looks along x of the odometry, so a motion ahead is one along x.
TEST(McapMessagesTest, OdometryHasTransformsAndACovarianceInItsAxes) {
  Odometry odometry;
  odometry.map_from_odom = kPose;
  odometry.odom_from_cam = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {4.0, 5.0, 6.0}};
  odometry.linear_velocity = {0.1, 0.2, 0.3};
  odometry.angular_velocity = {0.4, 0.5, 0.6};
  const std::string transforms = TransformMessage({3, 4}, odometry);
  FieldReader reader(kCdr, transforms, "tf");
  EXPECT_EQ(reader.Get<uint32_t>(), 2u);
  ExpectHeader(reader, {3, 4}, "map");
  EXPECT_EQ(reader.GetText(), "odom");
  ExpectNumbers(reader, NumbersOf(kPose));
  ExpectHeader(reader, {3, 4}, "odom");
  EXPECT_EQ(reader.GetText(), "camera");
  ExpectNumbers(reader, NumbersOf(odometry.odom_from_cam));
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance.diagonal() << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  covariance(2, 5) = covariance(5, 2) = 0.5;  // of the rotation about, and the motion along, z
  const std::string message = OdometryMessage({3, 4}, odometry, covariance);
  FieldReader of_odometry(kCdr, message, "odom");
  ExpectHeader(of_odometry, {3, 4}, "odom");
  EXPECT_EQ(of_odometry.GetText(), "camera");
  ExpectNumbers(of_odometry, NumbersOf(odometry.odom_from_cam));
  Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
  expected.diagonal() << 6.0, 4.0, 5.0, 3.0, 1.0, 2.0;
  expected(0, 3) = expected(3, 0) = 0.5;
  for (const double number : expected.reshaped()) {
    EXPECT_NEAR(of_odometry.Get<double>(), number, 1e-12);
  }
  ExpectNumbers(of_odometry, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  ExpectNumbers(of_odometry, std::vector<double>(36, 0.0));
  EXPECT_THROW(of_odometry.Get<uint8_t>(), InputError);
}

TEST(McapMessagesTest, PointsHaveTheirColours) {
  const std::vector<Eigen::Vector3f> positions = {{1.0f, 2.0f, 3.0f}};
  const std::vector<Colour> colours = {{0x11, 0x22, 0x33}};
  const std::string message = PointsMessage({1, 2}, positions, colours);
  FieldReader reader(kCdr, message, "points");
  ExpectHeader(reader, {1, 2}, "map");
  EXPECT_EQ(reader.Get<uint32_t>(), 1u);
  EXPECT_EQ(reader.Get<uint32_t>(), 1u);
  ASSERT_EQ(reader.Get<uint32_t>(), 4u);
  for (const char* const name : {"x", "y", "z", "rgb"}) {
    EXPECT_EQ(reader.GetText(), name);
    reader.Get<uint32_t>();
    EXPECT_EQ(reader.Get<uint8_t>(), 7);
    EXPECT_EQ(reader.Get<uint32_t>(), 1u);
  }
  EXPECT_EQ(reader.Get<uint8_t>(), 0);
  EXPECT_EQ(reader.Get<uint32_t>(), 16u);
  EXPECT_EQ(reader.Get<uint32_t>(), 16u);
  const std::string_view data = reader.GetBytes();
  ASSERT_EQ(data.size(), 16u);
  EXPECT_EQ(data.substr(12), std::string_view("\x33\x22\x11\0", 4));
}

TEST(McapMessagesTest, OnlyMappedObjectsAreWritten) {
  const std::vector<ObjectResult> objects = {Cup(ObjectState::kCandidate),
                                             Cup(ObjectState::kMapped)};
  const std::string detections = DetectionsMessage({1, 2}, objects);
  FieldReader reader(kCdr, detections, "objects");
  ExpectHeader(reader, {1, 2}, "map");
  ASSERT_EQ(reader.Get<uint32_t>(), 1u);
  ExpectHeader(reader, {1, 2}, "map");
  ASSERT_EQ(reader.Get<uint32_t>(), 2u);
  for (const char* const label : {"bowl", "cup"}) {
    EXPECT_EQ(reader.GetText(), label);
    EXPECT_EQ(reader.Get<double>(), label[0] == 'c' ? 0.75 : 0.25);
    ExpectNumbers(reader, NumbersOf(kPose));
    ExpectNumbers(reader, std::vector<double>(36, 0.0));
  }
  ExpectNumbers(reader, NumbersOf(kPose));
  ExpectNumbers(reader, {0.2, 0.4, 0.6});
  EXPECT_EQ(reader.GetText(), "cup 7");
  Scene boxes;
  boxes.objects.resize(1);
  boxes.objects[0].id = ObjectId(7);
  const Rigid3 pose_of_box(ExpSo3({0.0, 0.0, 0.4}), {1.1, 2.0, 3.0});
  boxes.objects[0].box = UprightBox{pose_of_box, {0.1, 0.3, 0.4}};
  const std::string scene = SceneMessage({1, 2}, objects, boxes);
  EXPECT_LT(SceneMessage({1, 2}, objects, {}).size(), scene.size()) << "without a box";
  FieldReader of_scene(kCdr, scene, "scene");
  EXPECT_EQ(of_scene.Get<uint32_t>(), 0u);
  ASSERT_EQ(of_scene.Get<uint32_t>(), 1u);
  ExpectHeader(of_scene, {1, 2}, "map");
  EXPECT_EQ(of_scene.GetText(), "cup 7");
  EXPECT_EQ(of_scene.Get<int32_t>(), 0);
  EXPECT_EQ(of_scene.Get<uint32_t>(), 0u);
  EXPECT_EQ(of_scene.Get<uint8_t>(), 0);
  const auto [red, green, blue] = ColourOfClass("cup");
  for (const uint32_t count : {0, 0, 1}) {  // metadata, arrows, cubes
    EXPECT_EQ(of_scene.Get<uint32_t>(), count);
  }
  ExpectNumbers(of_scene, NumbersOf(pose_of_box));
  ExpectNumbers(of_scene, {0.2, 0.6, 0.8});
  ExpectNumbers(of_scene, {red / 255.0, green / 255.0, blue / 255.0, 0.2});
  EXPECT_EQ(of_scene.Get<uint32_t>(), 1u);  // spheres
  ExpectNumbers(of_scene, NumbersOf(kPose));
  ExpectNumbers(of_scene, {0.2, 0.4, 0.6});
  ExpectNumbers(of_scene, {red / 255.0, green / 255.0, blue / 255.0, 0.5});
}

}  // namespace
}  // namespace hullslam
