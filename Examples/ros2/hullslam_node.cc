// SPDX-License-Identifier: GPL-3.0-or-later
// A node of ROS 2: RGB-D images in; transforms, odometry and events out. See README.md.
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cmath>
#include <filesystem>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <map>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <std_msgs/msg/string.hpp>
#include <string>
#include <vector>

#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace {

using hullslam::Rigid3;
using sensor_msgs::msg::CameraInfo;
using sensor_msgs::msg::Image;
using OdometryMessage = nav_msgs::msg::Odometry;

// A view of the pixels, or grey ones of an image whose first colour is red.
cv::Mat PixelsOf(const Image& message) {
  static const std::map<std::string, int> kTypes = {
      {"mono8", CV_8UC1}, {"bgr8", CV_8UC3},   {"rgb8", CV_8UC3},    {"bgra8", CV_8UC4},
      {"rgba8", CV_8UC4}, {"16UC1", CV_16UC1}, {"mono16", CV_16UC1}, {"32FC1", CV_32FC1}};
  const auto type = kTypes.find(message.encoding);
  if (type == kTypes.end()) {
    throw hullslam::InputError("the encoding '" + message.encoding + "' is not read");
  }
  const size_t row = size_t{message.width} * CV_ELEM_SIZE(type->second);
  if (message.step < row || message.data.size() < size_t{message.step} * message.height) {
    throw hullslam::InputError("an image has fewer bytes than its rows need");
  }
  cv::Mat pixels(static_cast<int>(message.height), static_cast<int>(message.width), type->second,
                 const_cast<uint8_t*>(message.data.data()), message.step);
  if (message.encoding.starts_with("rgb")) {
    cv::cvtColor(pixels, pixels, pixels.channels() == 3 ? cv::COLOR_RGB2GRAY : cv::COLOR_RGBA2GRAY);
  }
  return pixels;
}

hullslam::SystemOptions OptionsOf(const CameraInfo& info) {
  if (info.distortion_model != "plumb_bob" && !info.distortion_model.empty()) {
    throw hullslam::InputError("the lens '" + info.distortion_model + "' needs settings");
  }
  hullslam::PinholeCamera camera{
      .fx = info.k[0], .fy = info.k[4], .cx = info.k[2], .cy = info.k[5]};
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  const std::vector<double*> numbers = {&camera.k1, &camera.k2, &camera.p1, &camera.p2, &camera.k3};
  for (size_t i = 0; i < numbers.size() && i < info.d.size(); ++i) {
    *numbers[i] = info.d[i];
  }
  return hullslam::MakeSettings({camera}, "camera_info",
                                std::vector<std::string>{"DepthMapFactor=1000"});  // REP 118
}

template <typename Position, typename Rotation>
void SetPose(const Rigid3& pose, Position& position, Rotation& rotation) {
  position.x = pose.translation.x();
  position.y = pose.translation.y();
  position.z = pose.translation.z();
  rotation.x = pose.rotation.x();
  rotation.y = pose.rotation.y();
  rotation.z = pose.rotation.z();
  rotation.w = pose.rotation.w();
}

geometry_msgs::msg::TransformStamped TransformOf(const std_msgs::msg::Header& parent,
                                                 const std::string& child, const Rigid3& pose) {
  geometry_msgs::msg::TransformStamped message;
  message.header = parent;
  message.child_frame_id = child;
  SetPose(pose, message.transform.translation, message.transform.rotation);
  return message;
}

class HullslamNode : public rclcpp::Node {
 public:
  HullslamNode() : rclcpp::Node("hullslam"), broadcaster_(this) {
    const std::vector<double> pose =
        declare_parameter<std::vector<double>>("camera_in_base", {0, 0, 0, 0, 0, 0, 1});
    if (pose.size() != 7) {
      throw hullslam::InputError("camera_in_base has not the 7 numbers x y z qx qy qz qw");
    }
    base_from_cam_ = {Eigen::Quaterniond(&pose[3]).normalized(), Eigen::Vector3d(pose.data())};
    moved_.odometry.emplace();
    if (!settings_.empty()) {
      Begin(hullslam::ReadSettings(settings_));
    }
    info_ = create_subscription<CameraInfo>(
        "camera_info", rclcpp::SensorDataQoS(),
        [this](CameraInfo::ConstSharedPtr info) { Guard([&] { OnCameraInfo(*info); }); });
    odometry_ = create_subscription<OdometryMessage>(
        "odometry", rclcpp::SensorDataQoS(),
        [this](OdometryMessage::ConstSharedPtr message) { OnOdometry(*message); });
    image_.subscribe(this, "image", rmw_qos_profile_sensor_data);
    depth_.subscribe(this, "depth", rmw_qos_profile_sensor_data);
    pairs_.registerCallback(&HullslamNode::OnImages, this);
  }

  // Adjusts the whole map and writes it. To be called once, at the end.
  void Finish() {
    if (saver_ && slam_->map() != nullptr && !slam_->map()->keyframes().empty()) {
      slam_->Finish();
      saver_.reset();  // waits until an earlier map is written
      hullslam::WriteMap(map_, *slam_->map(), hullslam::MapSettingsOf(slam_->options()));
    }
  }

 private:
  using Pairs = message_filters::sync_policies::ApproximateTime<Image, Image>;

  template <typename Action>
  void Guard(const Action& action) {
    try {
      action();
    } catch (const std::exception& error) {
      RCLCPP_ERROR(get_logger(), "%s", error.what());
    }
  }

  void Begin(hullslam::SystemOptions options) {
    if (vocabulary_ != "none") {
      options.vocabulary = std::make_shared<const hullslam::Vocabulary>(
          hullslam::ReadVocabulary(vocabulary_.empty() ? hullslam::FindDefaultVocabulary()
                                                       : std::filesystem::path(vocabulary_)));
    }
    hullslam::SystemStart start;
    if (!map_.empty() && std::filesystem::exists(map_)) {
      start.map = hullslam::ReadMap(map_, options);
    }
    start.localization_only = localization_only_;
    slam_ = std::make_unique<hullslam::System>(
        options,
        realtime_ ? hullslam::PipelineKind::kRealtime : hullslam::PipelineKind::kSequential,
        std::move(start));
    slam_->SetFrameCallback([this](const hullslam::FrameReport& report) { TellEvents(report); });
    if (!map_.empty() && !localization_only_) {
      saver_.emplace(map_, hullslam::MapSettingsOf(options), 5.0, [this](const std::string& why) {
        RCLCPP_ERROR(get_logger(), "%s", why.c_str());
      });
    }
  }

  void OnCameraInfo(const CameraInfo& info) {
    if (slam_ == nullptr) {
      Begin(OptionsOf(info));
    }
  }

  // Poses of the base in any frame in which they do not jump.
  void OnOdometry(const OdometryMessage& message) {
    const auto& position = message.pose.pose.position;
    const auto& rotation = message.pose.pose.orientation;
    const Rigid3 odom_from_base(
        Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z).normalized(),
        {position.x, position.y, position.z});
    hullslam::Trajectory& poses = *moved_.odometry;
    const double stamp = rclcpp::Time(message.header.stamp).seconds();
    if (poses.empty() || stamp > poses.back().timestamp) {
      constexpr double kKept = 10.0;  // s
      std::erase_if(poses, [&](const auto& pose) { return pose.timestamp < stamp - kKept; });
      poses.push_back({stamp, odom_from_base * base_from_cam_});
    }
  }

  void OnImages(const Image::ConstSharedPtr& image, const Image::ConstSharedPtr& depth) {
    Guard([&] {
      if (slam_ == nullptr) {
        return;  // the camera is not known yet
      }
      const double stamp = rclcpp::Time(image->header.stamp).seconds();
      std::optional<hullslam::MotionPrior> prior;
      if (!slam_->frames().empty() && !moved_.odometry->empty()) {
        prior = PriorBetween(moved_, slam_->frames().back().timestamp, stamp,
                             slam_->options().odometry);
      }
      Publish(image->header,
              slam_->Track(stamp, PixelsOf(*image), PixelsOf(*depth), {}, {}, prior));
      if (saver_) {
        saver_->Offer(slam_->map());
      }
    });
  }

  // The poses of the base, in worlds that have the axes that the base had at the first frame.
  void Publish(const std_msgs::msg::Header& header, const hullslam::TrackedFrame& frame) {
    const bool is_tracked = frame.state == hullslam::TrackingState::kTracked;
    if (!frame.odometry ||
        (!is_tracked && frame.odometry->step == hullslam::OdometryStep::kStopped)) {
      return;  // nothing is known about the motion
    }
    std_msgs::msg::Header in_map = header;
    in_map.frame_id = map_frame_;
    OdometryMessage message;
    message.header = header;
    message.header.frame_id = odom_frame_;
    message.child_frame_id = base_frame_.empty() ? header.frame_id : base_frame_;
    const Rigid3 cam_from_base = Inverse(base_from_cam_);
    const Rigid3 odom_from_base = base_from_cam_ * frame.odometry->odom_from_cam * cam_from_base;
    broadcaster_.sendTransform(
        {TransformOf(in_map, odom_frame_,
                     base_from_cam_ * frame.odometry->map_from_odom * cam_from_base),
         TransformOf(message.header, message.child_frame_id, odom_from_base)});
    if (!is_tracked) {
      return;
    }
    SetPose(odom_from_base, message.pose.pose.position, message.pose.pose.orientation);
    // Ours has the rotation first and the axes of the camera, that of ROS the axes of the odometry.
    const Eigen::Matrix<double, 6, 6> covariance =
        InAxesOf(Rigid3(odom_from_base.rotation, Eigen::Vector3d::Zero()) * base_from_cam_,
                 frame.covariance.value_or(Eigen::Matrix<double, 6, 6>::Zero()));
    for (int i = 0; i < 36; ++i) {
      message.pose.covariance[i] = covariance((i / 6 + 3) % 6, (i + 3) % 6);
    }
    Eigen::Matrix<double, 6, 1> velocity;
    velocity << frame.odometry->angular_velocity, frame.odometry->linear_velocity;
    velocity = Adjoint(base_from_cam_) * velocity;
    auto& twist = message.twist.twist;
    twist.angular.x = velocity[0];
    twist.angular.y = velocity[1];
    twist.angular.z = velocity[2];
    twist.linear.x = velocity[3];
    twist.linear.y = velocity[4];
    twist.linear.z = velocity[5];
    odometry_publisher_->publish(message);
  }

  void TellEvents(const hullslam::FrameReport& report) {
    for (const hullslam::MapEvent& event : report.events) {
      std_msgs::msg::String message;
      message.data = ToString(event.kind);
      if (event.object.IsValid()) {
        message.data += " object " + std::to_string(event.object.value);
      }
      if (event.kept.IsValid()) {
        message.data += " kept " + std::to_string(event.kept.value);
      }
      if (event.most_moved > 0.0) {
        message.data += " moved " + std::to_string(std::lround(1e3 * event.most_moved)) + " mm";
      }
      events_publisher_->publish(message);
    }
  }

  const std::string settings_ = declare_parameter<std::string>("settings", "");
  const std::string vocabulary_ = declare_parameter<std::string>("vocabulary", "");
  const std::string map_ = declare_parameter<std::string>("map", "");
  const bool localization_only_ = declare_parameter<bool>("localization_only", false);
  const bool realtime_ = declare_parameter<bool>("realtime", true);
  const std::string map_frame_ = declare_parameter<std::string>("map_frame", "map");
  const std::string odom_frame_ = declare_parameter<std::string>("odom_frame", "odom");
  const std::string base_frame_ = declare_parameter<std::string>("base_frame", "");
  Rigid3 base_from_cam_;
  hullslam::ImageSequence moved_;  // only its odometry
  std::unique_ptr<hullslam::System> slam_;
  std::optional<hullslam::MapSaver> saver_;
  tf2_ros::TransformBroadcaster broadcaster_;
  rclcpp::Publisher<OdometryMessage>::SharedPtr odometry_publisher_ =
      create_publisher<OdometryMessage>("visual_odometry", 10);
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr events_publisher_ =
      create_publisher<std_msgs::msg::String>("events", 100);
  rclcpp::Subscription<CameraInfo>::SharedPtr info_;
  rclcpp::Subscription<OdometryMessage>::SharedPtr odometry_;
  message_filters::Subscriber<Image> image_;
  message_filters::Subscriber<Image> depth_;
  message_filters::Synchronizer<Pairs> pairs_ =
      message_filters::Synchronizer<Pairs>(Pairs(10), image_, depth_);
};

}  // namespace

int main(int argc, char** argv) try {
  rclcpp::init(argc, argv);
  const auto node = std::make_shared<HullslamNode>();
  rclcpp::spin(node);
  node->Finish();
  rclcpp::shutdown();
} catch (const std::exception& error) {
  RCLCPP_FATAL(rclcpp::get_logger("hullslam"), "%s", error.what());
  return 1;
}
