// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/messages.h"
#include "report/object_results.h"
#include "results/unit_mesh.h"
#include "scene/scene.h"

namespace hullslam {

// The results of a run as messages of ROS 2, in CDR. The world is the frame "map", that of the
// odometry "odom", the camera (x to the right, y down, z ahead) the frame "camera". Lengths are in
// the unit of the map.

// A time stamp as ROS has it, rounded to microseconds as in trajectory.txt.
struct RosTime {
  int32_t seconds = 0;
  uint32_t nanoseconds = 0;

  uint64_t Nanoseconds() const { return uint64_t(seconds) * 1'000'000'000 + nanoseconds; }
};
// Throws InputError for a stamp (s) that ROS cannot express: negative, or beyond the year 2038.
RosTime ToRosTime(double stamp);

// sensor_msgs/msg/CompressedImage of a JPEG.
std::string JpegMessage(RosTime time, std::string_view jpeg);
// sensor_msgs/msg/CameraInfo.
std::string CameraInfoMessageOf(RosTime time, const PinholeCamera& camera);
// tf2_msgs/msg/TFMessage with the pose of the camera in the map.
std::string TransformMessage(RosTime time, const Rigid3& world_from_cam);
// The same as two transforms: the odometry in the map, and the camera in the odometry.
std::string TransformMessage(RosTime time, const Odometry& odometry);
// nav_msgs/msg/Odometry of the camera in the odometry. `covariance` is that of the pose in the map
// (TrackedFrame::covariance). The message has the position before the rotation, both in the axes of
// the odometry. The covariance of the velocity is 0, which stands for unknown.
std::string OdometryMessage(RosTime time, const Odometry& odometry,
                            const Eigen::Matrix<double, 6, 6>& covariance);
// nav_msgs/msg/Path. Poses whose stamps ROS cannot express throw InputError.
std::string PathMessage(RosTime time, const Trajectory& trajectory);
// sensor_msgs/msg/PointCloud2 with the fields x, y, z and rgb. There is a colour for each point.
std::string PointsMessage(RosTime time, std::span<const Eigen::Vector3f> positions,
                          std::span<const Colour> colours);
// vision_msgs/msg/Detection3DArray: the mapped objects with their oriented boxes and the share of
// the votes of each class.
std::string DetectionsMessage(RosTime time, std::span<const ObjectResult> objects);
// foxglove_msgs/msg/SceneUpdate: the mapped objects as ellipsoids in the colours of their classes
// (ColourOfClass()), with their class names, and their boxes in the scene as cubes that are more
// transparent.
std::string SceneMessage(RosTime time, std::span<const ObjectResult> objects, const Scene& scene);

}  // namespace hullslam
