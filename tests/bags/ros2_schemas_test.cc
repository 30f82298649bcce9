// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/ros2_schemas.h"

#include <gtest/gtest.h>

#include <string>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TEST(Ros2SchemasTest, ContainedTypesFollowOnceInTheOrderOfTheirUse) {
  const std::string line(80, '=');
  EXPECT_EQ(Ros2Schema("sensor_msgs/msg/CompressedImage"),
            "std_msgs/Header header\nstring format\nuint8[] data\n" + line +
                "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + line +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
  const std::string path = Ros2Schema("nav_msgs/msg/Path");
  EXPECT_EQ(path.find("MSG: std_msgs/Header"), path.rfind("MSG: std_msgs/Header"));
  EXPECT_NE(path.find("MSG: geometry_msgs/Quaternion"), std::string::npos);
}

TEST(Ros2SchemasTest, OtherTypesAreErrorsOfTheProgram) {
  EXPECT_THROW(Ros2Schema("std_msgs/msg/String"), CheckError);
  EXPECT_THROW(Ros2Schema("std_msgs/Header"), CheckError);
}

}  // namespace
}  // namespace hullslam
