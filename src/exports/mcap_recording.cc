// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/mcap_recording.h"

#include <cstdint>
#include <map>
#include <vector>

#include "bags/mcap_writer.h"
#include "bags/ros2_schemas.h"
#include "exports/mcap_messages.h"
#include "hullslam/util/error.h"
#include "images/image_codecs.h"
#include "images/image_file.h"
#include "map/located_landmarks.h"
#include "sequences/image_list.h"
#include "system/make_sensor.h"
#include "view/point_colours.h"
#include "view/run_pictures.h"

namespace hullslam {
namespace {

constexpr int kJpegQuality = 90;

// Writes the messages of a run in the order of their times.
class RunRecorder {
 public:
  RunRecorder(const std::filesystem::path& file, const RecordedRun& run)
      : run_(run), writer_(file, run.writer) {
    for (const StampedPose& pose : *run.trajectory) {
      poses_[pose.timestamp] = pose.world_from_cam;
    }
    for (const TrackedFrame& frame : run.live) {
      live_[frame.timestamp] = &frame;
    }
  }

  // Returns the number of images that could not be read.
  size_t Write() {
    // Messages about the whole run come first, so that players show them from the beginning.
    const RosTime start = ToRosTime(run_.sequence->frames.front().timestamp);
    const std::vector<ObjectResult>& objects = run_.objects->objects;
    WriteOnce("/map/path", "nav_msgs/msg/Path", start, PathMessage(start, *run_.trajectory));
    WriteOnce("/map/points", "sensor_msgs/msg/PointCloud2", start, Points(start));
    WriteOnce("/map/objects", "vision_msgs/msg/Detection3DArray", start,
              DetectionsMessage(start, objects));
    WriteOnce("/map/scene", "foxglove_msgs/msg/SceneUpdate", start,
              SceneMessage(start, objects, *run_.scene));
    const size_t missing = WriteFrames();
    writer_.Close();
    return missing;
  }

 private:
  uint16_t Add(const char* topic, const char* type) {
    return writer_.AddTopic(topic, type, Ros2Schema(type));
  }

  void WriteOnce(const char* topic, const char* type, RosTime time, const std::string& message) {
    writer_.Write(Add(topic, type), time.Nanoseconds(), message);
  }

  // The landmarks, with colours of the images.
  std::string Points(RosTime time) const {
    const Sensor sensor = MakeSensor(*run_.options);
    const LocatedLandmarks located = LocateLandmarks(*run_.map, sensor);
    PointColours colours(*run_.map, located.ids);
    RunImageTasks(*run_.sequence, sensor.camera, ColourTasks(*run_.map, sensor.camera, colours));
    std::vector<Eigen::Vector3f> positions;
    for (const Eigen::Vector3d& position : located.positions) {
      positions.push_back(position.cast<float>());
    }
    return PointsMessage(time, positions, colours.Colours());
  }

  void AddPoses() {
    transforms_ = Add("/tf", "tf2_msgs/msg/TFMessage");
    if (!live_.empty()) {
      odometry_ = Add("/odom", "nav_msgs/msg/Odometry");
    }
  }

  void WritePose(RosTime time, double timestamp) {
    if (live_.empty()) {
      if (const auto pose = poses_.find(timestamp); pose != poses_.end()) {
        writer_.Write(transforms_, time.Nanoseconds(), TransformMessage(time, pose->second));
      }
      return;
    }
    const auto frame = live_.find(timestamp);
    if (frame == live_.end() || !frame->second->odometry) {
      return;
    }
    const Odometry& odometry = *frame->second->odometry;
    const bool is_tracked = frame->second->state == TrackingState::kTracked;
    if (is_tracked || odometry.step != OdometryStep::kStopped) {
      writer_.Write(transforms_, time.Nanoseconds(), TransformMessage(time, odometry));
    }
    if (is_tracked) {
      // The first pose has no covariance, because it defines the world.
      const Eigen::Matrix<double, 6, 6> exact = Eigen::Matrix<double, 6, 6>::Zero();
      writer_.Write(odometry_, time.Nanoseconds(),
                    OdometryMessage(time, odometry, frame->second->covariance.value_or(exact)));
    }
  }

  size_t WriteFrames() {
    AddPoses();
    const uint16_t cameras = Add("/camera/camera_info", "sensor_msgs/msg/CameraInfo");
    const uint16_t images = Add("/camera/image/compressed", "sensor_msgs/msg/CompressedImage");
    const PinholeCamera& camera = run_.options->camera;
    size_t missing = 0;
    for (size_t i = 0; i < run_.frames; ++i) {
      const FramePaths& frame = run_.sequence->frames[i];
      const RosTime time = ToRosTime(frame.timestamp);
      WritePose(time, frame.timestamp);
      try {
        const std::string jpeg =
            EncodeJpeg(LoadColour(*run_.sequence, frame, camera), kJpegQuality);
        writer_.Write(cameras, time.Nanoseconds(), CameraInfoMessageOf(time, camera));
        writer_.Write(images, time.Nanoseconds(), JpegMessage(time, jpeg));
      } catch (const InputError&) {
        ++missing;
      }
    }
    return missing;
  }

  const RecordedRun& run_;
  McapWriter writer_;
  std::map<double, Rigid3> poses_;  // by time stamp
  std::map<double, const TrackedFrame*> live_;
  uint16_t transforms_ = 0;  // topics
  uint16_t odometry_ = 0;
};

}  // namespace

size_t WriteRecording(const std::filesystem::path& file, const RecordedRun& run) {
  return RunRecorder(file, run).Write();
}

}  // namespace hullslam
