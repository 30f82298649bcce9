// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"

// The part of the API of ROS 2 that Examples/ros2/hullslam_node.cc uses, written for its test. The
// arguments are a sequence in TUM's format, maybe "odometry", and parameters as "name:=value".
// rclcpp::spin gives the node the images, the camera and, with "odometry", the true poses of the
// base as those of wheels; the images 30 to 34 are black then. What the node publishes is printed.

namespace stubs {

struct State {
  std::string sequence;
  bool has_odometry = false;
  std::map<std::string, std::string> parameters;
  // By topic, they get a pointer to the message.
  std::map<std::string, std::function<void(std::shared_ptr<const void>)>> subscriptions;
  std::function<void(std::shared_ptr<const void>, std::shared_ptr<const void>)> on_pair;
};
inline State& TheState() {
  static State state;
  return state;
}

}  // namespace stubs

namespace std_msgs::msg {
struct Header {
  struct {
    int32_t sec = 0;
    uint32_t nanosec = 0;
  } stamp;
  std::string frame_id;
};
struct String {
  std::string data;
};
inline std::string Show(const String& message) { return message.data; }
}  // namespace std_msgs::msg

namespace geometry_msgs::msg {
struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
};
struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};
struct TransformStamped {
  std_msgs::msg::Header header;
  std::string child_frame_id;
  struct {
    Vector3 translation;
    Quaternion rotation;
  } transform;
};
inline std::string Show(const std_msgs::msg::Header& header, const std::string& child,
                        const Vector3& t, const Quaternion& q) {
  return fmt::format("{} {} {}.{:09} {} {} {} {} {} {} {}", header.frame_id, child,
                     header.stamp.sec, header.stamp.nanosec, t.x, t.y, t.z, q.x, q.y, q.z, q.w);
}
}  // namespace geometry_msgs::msg

namespace nav_msgs::msg {
struct Odometry {
  using ConstSharedPtr = std::shared_ptr<const Odometry>;
  std_msgs::msg::Header header;
  std::string child_frame_id;
  struct {
    struct {
      geometry_msgs::msg::Vector3 position;
      geometry_msgs::msg::Quaternion orientation;
    } pose;
    std::array<double, 36> covariance{};
  } pose;
  struct {
    struct {
      geometry_msgs::msg::Vector3 linear, angular;
    } twist;
    std::array<double, 36> covariance{};
  } twist;
};
inline std::string Show(const Odometry& message) {
  return Show(message.header, message.child_frame_id, message.pose.pose.position,
              message.pose.pose.orientation) +
         fmt::format(" {} {} {}", message.pose.covariance[0], message.pose.covariance[35],
                     message.twist.twist.linear.x);
}
}  // namespace nav_msgs::msg

namespace sensor_msgs::msg {
struct Image {
  using ConstSharedPtr = std::shared_ptr<const Image>;
  std_msgs::msg::Header header;
  uint32_t height = 0, width = 0, step = 0;
  std::string encoding;
  std::vector<uint8_t> data;
};
struct CameraInfo {
  using ConstSharedPtr = std::shared_ptr<const CameraInfo>;
  uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
};
}  // namespace sensor_msgs::msg

struct rmw_qos_profile_t {};
inline constexpr rmw_qos_profile_t rmw_qos_profile_sensor_data;

namespace rclcpp {

struct Logger {};
inline Logger get_logger(const std::string&) { return {}; }
#define RCLCPP_ERROR(logger, ...) \
  ((void)(logger), std::fprintf(stderr, __VA_ARGS__), std::fputc('\n', stderr))
#define RCLCPP_FATAL RCLCPP_ERROR

struct SensorDataQoS {};

struct Time {
  template <typename Stamp>
  explicit Time(const Stamp& stamp) : value(stamp.sec + 1e-9 * stamp.nanosec) {}
  double seconds() const { return value; }
  double value;
};

template <typename Message>
struct Publisher {
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const Message& message) const {
    std::printf("%s %s\n", topic.c_str(), Show(message).c_str());
  }
  std::string topic;
};
template <typename Message>
struct Subscription {
  using SharedPtr = std::shared_ptr<Subscription>;
};

class Node {
 public:
  explicit Node(const std::string&) {}
  Logger get_logger() const { return {}; }
  template <typename Value>
  Value declare_parameter(const std::string& name, const Value& value) {
    const auto& given = stubs::TheState().parameters;
    const auto found = given.find(name);
    if (found == given.end()) {
      return value;
    }
    std::istringstream stream(found->second);
    Value read{};
    if constexpr (std::is_same_v<Value, std::vector<double>>) {
      read.assign(std::istream_iterator<double>(stream), {});
    } else {
      stream >> std::boolalpha >> read;
    }
    return read;
  }
  template <typename Message>
  auto create_publisher(const std::string& topic, int) {
    return std::make_shared<Publisher<Message>>(Publisher<Message>{topic});
  }
  template <typename Message, typename Callback>
  auto create_subscription(const std::string& topic, SensorDataQoS, Callback callback) {
    stubs::TheState().subscriptions[topic] = [callback](std::shared_ptr<const void> message) {
      callback(std::static_pointer_cast<const Message>(message));
    };
    return std::make_shared<Subscription<Message>>();
  }
};

inline void init(int argc, const char* const* argv) {
  stubs::State& state = stubs::TheState();
  state.sequence = argv[1];
  for (int i = 2; i < argc; ++i) {
    const std::string argument = argv[i];
    state.has_odometry |= argument == "odometry";
    if (const size_t at = argument.find(":="); at != std::string::npos) {
      state.parameters[argument.substr(0, at)] = argument.substr(at + 2);
    }
  }
}
inline void shutdown() {}

inline std_msgs::msg::Header HeaderOf(double stamp, const char* frame) {
  const auto whole = static_cast<int32_t>(stamp);
  return {{whole, static_cast<uint32_t>((stamp - whole) * 1e6 + 0.5) * 1000}, frame};
}

inline auto ImageOf(const cv::Mat& pixels, const char* encoding, double stamp) {
  auto message = std::make_shared<sensor_msgs::msg::Image>();
  message->header = HeaderOf(stamp, "camera_optical");
  message->height = static_cast<uint32_t>(pixels.rows);
  message->width = static_cast<uint32_t>(pixels.cols);
  message->step = static_cast<uint32_t>(pixels.step);
  message->encoding = encoding;
  message->data.assign(pixels.data, pixels.data + pixels.step * pixels.rows);
  return message;
}

template <typename NodePointer>
void spin(const NodePointer& node) {
  const stubs::State& state = stubs::TheState();
  hullslam::Rigid3 base_from_cam;
  if (state.parameters.contains("camera_in_base")) {
    const std::vector<double> given =
        node->template declare_parameter<std::vector<double>>("camera_in_base", {});
    base_from_cam = {Eigen::Quaterniond(&given[3]), Eigen::Vector3d(given.data())};
  }
  const auto camera = hullslam::ReadSettings(state.sequence + "/camera.yaml").camera;
  const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(state.sequence);
  const hullslam::Trajectory truth = *hullslam::ReadGroundtruth(sequence);
  auto info = std::make_shared<sensor_msgs::msg::CameraInfo>();
  info->height = static_cast<uint32_t>(camera.height);
  info->width = static_cast<uint32_t>(camera.width);
  info->distortion_model = "plumb_bob";
  info->d = {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
  info->k = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const hullslam::FramePaths& frame = sequence.frames[i];
    if (state.has_odometry) {
      auto odometry = std::make_shared<nav_msgs::msg::Odometry>();
      const hullslam::Rigid3 pose = truth.at(i).world_from_cam * hullslam::Inverse(base_from_cam);
      odometry->header = HeaderOf(truth.at(i).timestamp, "wheels");
      odometry->pose.pose = {
          {pose.translation.x(), pose.translation.y(), pose.translation.z()},
          {pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()}};
      state.subscriptions.at("odometry")(odometry);
    }
    state.subscriptions.at("camera_info")(info);
    cv::Mat image = cv::imread(frame.image);
    if (state.has_odometry && i >= 30 && i < 35) {
      image.setTo(0);
    }
    cv::Mat depth = cv::imread(frame.depth, cv::IMREAD_UNCHANGED);
    depth.convertTo(depth, CV_32F, 1.0 / 5000.0);
    state.on_pair(ImageOf(image, "bgr8", frame.timestamp),
                  ImageOf(depth, "32FC1", frame.timestamp));
  }
}

}  // namespace rclcpp

namespace tf2_ros {
struct TransformBroadcaster {
  explicit TransformBroadcaster(const void*) {}
  void sendTransform(const std::vector<geometry_msgs::msg::TransformStamped>& transforms) const {
    for (const auto& sent : transforms) {
      std::printf("tf %s\n", Show(sent.header, sent.child_frame_id, sent.transform.translation,
                                  sent.transform.rotation)
                                 .c_str());
    }
  }
};
}  // namespace tf2_ros

namespace message_filters {
template <typename Message>
struct Subscriber {
  void subscribe(void*, const std::string&, rmw_qos_profile_t) {}
};
namespace sync_policies {
template <typename A, typename B>
struct ApproximateTime {
  explicit ApproximateTime(int) {}
  using First = A;
  using Second = B;
};
}  // namespace sync_policies
template <typename Policy>
class Synchronizer {
 public:
  template <typename A, typename B>
  Synchronizer(const Policy&, A&, B&) {}
  template <typename Function, typename Object>
  void registerCallback(const Function& function, Object* object) {
    stubs::TheState().on_pair = [=](std::shared_ptr<const void> a, std::shared_ptr<const void> b) {
      (object->*function)(std::static_pointer_cast<const typename Policy::First>(a),
                          std::static_pointer_cast<const typename Policy::Second>(b));
    };
  }
};
}  // namespace message_filters
