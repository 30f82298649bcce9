// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace hullslam {

// The definition of a type of ROS 2 in the form "ros2msg" of MCAP: its fields, then, after a line
// of '=', the fields of each type that it contains. `type` is one that this program writes, such as
// "sensor_msgs/msg/CameraInfo"; throws CheckError for others.
std::string Ros2Schema(std::string_view type);

}  // namespace hullslam
