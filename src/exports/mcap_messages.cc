// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/mcap_messages.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "bags/message_fields.h"
#include "camera/named_lens.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr const char* kMapFrame = "map";
constexpr const char* kOdometryFrame = "odom";
constexpr const char* kCameraFrame = "camera";

void PutTime(RosTime time, CdrWriter& message) {
  message.Put(time.seconds);
  message.Put(time.nanoseconds);
}

void PutHeader(RosTime time, const char* frame, CdrWriter& message) {
  PutTime(time, message);
  message.PutText(frame);
}

// A Point or a Vector3.
void PutVector(const Eigen::Vector3d& vector, CdrWriter& message) {
  for (const double coordinate : vector) {
    message.Put(coordinate);
  }
}

// A Pose or a Transform: both have the position first, then the quaternion x y z w.
void PutPose(const Rigid3& pose, CdrWriter& message) {
  PutVector(pose.translation, message);
  for (const double coordinate : pose.rotation.coeffs()) {
    message.Put(coordinate);
  }
}

std::vector<const ObjectResult*> MappedObjects(std::span<const ObjectResult> objects) {
  std::vector<const ObjectResult*> mapped;
  for (const ObjectResult& object : objects) {
    if (object.state == ObjectState::kMapped) {
      mapped.push_back(&object);
    }
  }
  return mapped;
}

std::string NameOf(const ObjectResult& object) {
  return fmt::format("{} {}", object.label, object.id.value);
}

constexpr Colour kTextColour = {255, 255, 255};

// A Color: red, green, blue and alpha, from 0 to 1.
void PutColour(const Colour& colour, double alpha, CdrWriter& message) {
  for (const uint8_t channel : colour) {
    message.Put(channel / 255.0);
  }
  message.Put(alpha);
}

// `body` is null if the scene does not have the object.
void PutEntity(RosTime time, const ObjectResult& object, const SceneObject* body,
               CdrWriter& message) {
  constexpr double kFontPixels = 14.0;
  const Rigid3& pose = object.ellipsoid.world_from_object;
  PutHeader(time, kMapFrame, message);  // the time and the frame
  message.PutText(NameOf(object));
  message.Put(int32_t{0});  // lifetime: for ever
  message.Put(uint32_t{0});
  message.Put(uint8_t{0});  // it stays in the frame
  message.PutCount(0);      // metadata
  message.PutCount(0);      // arrows
  const bool has_box = body != nullptr && body->box;
  message.PutCount(has_box ? 1 : 0);  // cubes
  if (has_box) {
    PutPose(body->box->world_from_box, message);
    PutVector(2.0 * body->box->half_extents, message);
    PutColour(ColourOfClass(object.label), 0.2, message);
  }
  message.PutCount(1);  // spheres
  PutPose(pose, message);
  PutVector(2.0 * object.ellipsoid.half_axes, message);
  PutColour(ColourOfClass(object.label), 0.5, message);
  message.PutCount(0);  // cylinders
  message.PutCount(0);  // lines
  message.PutCount(0);  // triangles
  message.PutCount(1);  // texts
  PutPose({Eigen::Quaterniond::Identity(), pose.translation}, message);
  message.Put(uint8_t{1});  // it faces the viewer
  message.Put(kFontPixels);
  message.Put(uint8_t{1});  // the size is in pixels
  PutColour(kTextColour, 1.0, message);
  message.PutText(NameOf(object));
  message.PutCount(0);  // models
}

}  // namespace

RosTime ToRosTime(double stamp) {
  constexpr double kMost = std::numeric_limits<int32_t>::max();
  if (!(stamp >= 0.0 && stamp < kMost)) {
    throw InputError(fmt::format(
        "the time stamp {:.6f} s cannot be written, because ROS expresses 0 to {:.0f} s", stamp,
        kMost));
  }
  const auto microseconds = static_cast<int64_t>(std::llround((stamp - std::floor(stamp)) * 1e6));
  return {static_cast<int32_t>(std::floor(stamp)) + static_cast<int32_t>(microseconds / 1'000'000),
          static_cast<uint32_t>(microseconds % 1'000'000 * 1'000)};
}

std::string JpegMessage(RosTime time, std::string_view jpeg) {
  CdrWriter message;
  PutHeader(time, kCameraFrame, message);
  message.PutText("jpeg");
  message.PutBytes(jpeg);
  return message.Message();
}

namespace {

void PutLens(const PinholeCamera& camera, CdrWriter& message) {
  const auto [model, numbers] = LensOfRos(camera);
  message.PutText(model);
  message.PutCount(numbers.size());
  for (const double number : numbers) {
    message.Put(number);
  }
}

}  // namespace

std::string CameraInfoMessageOf(RosTime time, const PinholeCamera& camera) {
  CdrWriter message;
  PutHeader(time, kCameraFrame, message);
  message.Put(static_cast<uint32_t>(camera.height));
  message.Put(static_cast<uint32_t>(camera.width));
  PutLens(camera, message);
  for (const double number :
       {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0,       0.0, 1.0,  // K
        1.0,       0.0, 0.0,       0.0, 1.0,       0.0,       0.0,       0.0, 1.0,  // R
        camera.fx, 0.0, camera.cx, 0.0, 0.0,       camera.fy, camera.cy, 0.0, 0.0,
        0.0,       1.0, 0.0}) {  // P
    message.Put(number);
  }
  for (int i = 0; i < 6; ++i) {  // binning and the region of interest: the whole image
    message.Put(uint32_t{0});
  }
  message.Put(uint8_t{0});
  return message.Message();
}

namespace {

void PutTransform(RosTime time, const char* parent, const char* child, const Rigid3& pose,
                  CdrWriter& message) {
  PutHeader(time, parent, message);
  message.PutText(child);
  PutPose(pose, message);
}

}  // namespace

std::string TransformMessage(RosTime time, const Rigid3& world_from_cam) {
  CdrWriter message;
  message.PutCount(1);
  PutTransform(time, kMapFrame, kCameraFrame, world_from_cam, message);
  return message.Message();
}

std::string TransformMessage(RosTime time, const Odometry& odometry) {
  CdrWriter message;
  message.PutCount(2);
  PutTransform(time, kMapFrame, kOdometryFrame, odometry.map_from_odom, message);
  PutTransform(time, kOdometryFrame, kCameraFrame, odometry.odom_from_cam, message);
  return message.Message();
}

std::string OdometryMessage(RosTime time, const Odometry& odometry,
                            const Eigen::Matrix<double, 6, 6>& covariance) {
  CdrWriter message;
  PutTransform(time, kOdometryFrame, kCameraFrame, odometry.odom_from_cam, message);
  const Eigen::Matrix<double, 6, 6> in_odom =
      InAxesOf({odometry.odom_from_cam.rotation, Eigen::Vector3d::Zero()}, covariance);
  for (int i = 0; i < 36; ++i) {
    message.Put(in_odom((i / 6 + 3) % 6, (i + 3) % 6));
  }
  PutVector(odometry.linear_velocity, message);
  PutVector(odometry.angular_velocity, message);
  for (int i = 0; i < 36; ++i) {
    message.Put(0.0);
  }
  return message.Message();
}

std::string PathMessage(RosTime time, const Trajectory& trajectory) {
  CdrWriter message;
  PutHeader(time, kMapFrame, message);
  message.PutCount(trajectory.size());
  for (const StampedPose& pose : trajectory) {
    PutHeader(ToRosTime(pose.timestamp), kMapFrame, message);
    PutPose(pose.world_from_cam, message);
  }
  return message.Message();
}

std::string PointsMessage(RosTime time, std::span<const Eigen::Vector3f> positions,
                          std::span<const Colour> colours) {
  Check(positions.size() == colours.size(), "each point has a colour");
  constexpr uint8_t kFloat32 = 7;
  constexpr uint32_t kPointBytes = 4 * sizeof(float);
  CdrWriter message;
  PutHeader(time, kMapFrame, message);
  message.Put(uint32_t{1});  // height: the points have no rows
  message.PutCount(positions.size());
  message.PutCount(4);
  uint32_t offset = 0;
  for (const char* const name : {"x", "y", "z", "rgb"}) {
    message.PutText(name);
    message.Put(offset);
    message.Put(kFloat32);
    message.Put(uint32_t{1});
    offset += sizeof(float);
  }
  message.Put(uint8_t{0});  // little-endian
  message.Put(kPointBytes);
  message.Put(static_cast<uint32_t>(kPointBytes * positions.size()));
  ByteWriter points;
  for (size_t i = 0; i < positions.size(); ++i) {
    for (const float coordinate : positions[i]) {
      points.Put(coordinate);
    }
    const auto& [red, green, blue] = colours[i];
    points.Put(uint32_t{red} << 16U | uint32_t{green} << 8U | blue);
  }
  message.PutBytes(points.bytes());
  message.Put(uint8_t{1});  // all points are finite
  return message.Message();
}

std::string DetectionsMessage(RosTime time, std::span<const ObjectResult> objects) {
  const std::vector<const ObjectResult*> mapped = MappedObjects(objects);
  CdrWriter message;
  PutHeader(time, kMapFrame, message);
  message.PutCount(mapped.size());
  for (const ObjectResult* const object : mapped) {
    double votes = 0.0;
    for (const auto& [label, of_label] : object->votes) {
      votes += of_label;
    }
    const Rigid3& pose = object->ellipsoid.world_from_object;
    PutHeader(time, kMapFrame, message);
    message.PutCount(object->votes.size());
    for (const auto& [label, of_label] : object->votes) {
      message.PutText(label);
      message.Put(of_label / votes);
      PutPose(pose, message);
      for (int i = 0; i < 36; ++i) {  // the covariance is not known
        message.Put(0.0);
      }
    }
    PutPose(pose, message);
    PutVector(2.0 * object->ellipsoid.half_axes, message);
    message.PutText(NameOf(*object));
  }
  return message.Message();
}

std::string SceneMessage(RosTime time, std::span<const ObjectResult> objects, const Scene& scene) {
  const std::vector<const ObjectResult*> mapped = MappedObjects(objects);
  CdrWriter message;
  message.PutCount(0);  // deletions
  message.PutCount(mapped.size());
  for (const ObjectResult* const object : mapped) {
    PutEntity(time, *object, scene.Find(object->id), message);
  }
  return message.Message();
}

}  // namespace hullslam
