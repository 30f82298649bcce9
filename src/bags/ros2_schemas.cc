// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/ros2_schemas.h"

#include <algorithm>
#include <array>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// A type, without the "msg" in its name, and its fields.
struct TypeFields {
  std::string_view type;
  std::string_view fields;
};

// The types of common_interfaces (ROS 2 Humble and later), of vision_msgs 4 and of Foxglove's
// schemas (https://docs.foxglove.dev/docs/sdk/schemas). The fields are in the order of their
// bytes.
constexpr auto kTypes = std::to_array<TypeFields>({
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
     "uint8 is_bigendian\nuint32 step\nuint8[] data\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
     "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
     "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n"},
    {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"vision_msgs/BoundingBox3D", "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n"},
    {"vision_msgs/ObjectHypothesis", "string class_id\nfloat64 score\n"},
    {"vision_msgs/ObjectHypothesisWithPose",
     "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n"},
    {"vision_msgs/Detection3D",
     "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
     "vision_msgs/BoundingBox3D bbox\nstring id\n"},
    {"vision_msgs/Detection3DArray",
     "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n"},
    {"foxglove_msgs/Color", "float64 r\nfloat64 g\nfloat64 b\nfloat64 a\n"},
    {"foxglove_msgs/KeyValuePair", "string key\nstring value\n"},
    {"foxglove_msgs/ArrowPrimitive",
     "geometry_msgs/Pose pose\nfloat64 shaft_length\nfloat64 shaft_diameter\n"
     "float64 head_length\nfloat64 head_diameter\nfoxglove_msgs/Color color\n"},
    {"foxglove_msgs/CubePrimitive",
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    {"foxglove_msgs/SpherePrimitive",
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    {"foxglove_msgs/CylinderPrimitive",
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfloat64 bottom_scale\n"
     "float64 top_scale\nfoxglove_msgs/Color color\n"},
    {"foxglove_msgs/LinePrimitive",
     "uint8 type\ngeometry_msgs/Pose pose\nfloat64 thickness\nbool scale_invariant\n"
     "geometry_msgs/Point[] points\nfoxglove_msgs/Color color\nfoxglove_msgs/Color[] colors\n"
     "uint32[] indices\n"},
    {"foxglove_msgs/TriangleListPrimitive",
     "geometry_msgs/Pose pose\ngeometry_msgs/Point[] points\nfoxglove_msgs/Color color\n"
     "foxglove_msgs/Color[] colors\nuint32[] indices\n"},
    {"foxglove_msgs/TextPrimitive",
     "geometry_msgs/Pose pose\nbool billboard\nfloat64 font_size\nbool scale_invariant\n"
     "foxglove_msgs/Color color\nstring text\n"},
    {"foxglove_msgs/ModelPrimitive",
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nfoxglove_msgs/Color color\n"
     "bool override_color\nstring url\nstring media_type\nuint8[] data\n"},
    {"foxglove_msgs/SceneEntityDeletion",
     "builtin_interfaces/Time timestamp\nuint8 type\nstring id\n"},
    {"foxglove_msgs/SceneEntity",
     "builtin_interfaces/Time timestamp\nstring frame_id\nstring id\n"
     "builtin_interfaces/Duration lifetime\nbool frame_locked\n"
     "foxglove_msgs/KeyValuePair[] metadata\nfoxglove_msgs/ArrowPrimitive[] arrows\n"
     "foxglove_msgs/CubePrimitive[] cubes\nfoxglove_msgs/SpherePrimitive[] spheres\n"
     "foxglove_msgs/CylinderPrimitive[] cylinders\nfoxglove_msgs/LinePrimitive[] lines\n"
     "foxglove_msgs/TriangleListPrimitive[] triangles\nfoxglove_msgs/TextPrimitive[] texts\n"
     "foxglove_msgs/ModelPrimitive[] models\n"},
    {"foxglove_msgs/SceneUpdate",
     "foxglove_msgs/SceneEntityDeletion[] deletions\nfoxglove_msgs/SceneEntity[] entities\n"},
});

const TypeFields& FindType(std::string_view type) {
  const auto* const found = std::find_if(
      kTypes.begin(), kTypes.end(), [&](const TypeFields& fields) { return fields.type == type; });
  Check(found != kTypes.end(), "a type of ROS 2 that is not written");
  return *found;
}

// Adds a type behind those that contain it, once. The type of a field is the first word of its line
// and has a '/' if it is no basic one.
void Collect(std::string_view type, std::vector<std::string_view>& types) {
  if (std::find(types.begin(), types.end(), type) != types.end()) {
    return;
  }
  types.push_back(type);
  std::string_view fields = FindType(type).fields;
  while (!fields.empty()) {
    const std::string_view of_field = fields.substr(0, fields.find_first_of(" ["));
    if (of_field.find('/') != std::string_view::npos) {
      Collect(of_field, types);
    }
    fields.remove_prefix(fields.find('\n') + 1);
  }
}

}  // namespace

std::string Ros2Schema(std::string_view type) {
  std::string name(type);
  const size_t at = name.find("/msg/");
  Check(at != std::string::npos, "a type of ROS 2 without msg");
  name.erase(at, 4);
  std::vector<std::string_view> types;
  Collect(name, types);
  std::string schema;
  for (const std::string_view part : types) {
    if (!schema.empty()) {
      schema += std::string(80, '=') + "\nMSG: " + std::string(part) + '\n';
    }
    schema += FindType(part).fields;
  }
  return schema;
}

}  // namespace hullslam
