// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/mcap_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <utility>
#include <vector>

#include "bags/mcap_writer.h"
#include "bags/ros2_schemas.h"
#include "hullslam/util/error.h"
#include "run/mcap_messages.h"
#include "run/messages.h"
#include "sequences/frame_colour.h"
#include "sequences/jpeg_codec.h"
#include "system/make_sensor.h"
#include "view/run_pictures.h"
#include "view/view_of_map.h"

namespace hullslam {
namespace {

constexpr int kJpegQuality = 90;

// Writes the messages of a run in the order of their times.
class RunRecorder {
 public:
  RunRecorder(const std::filesystem::path& file, const McapContent& content)
      : content_(content), writer_(file, fmt::format("hullslam {}", HULLSLAM_VERSION)) {
    for (const StampedPose& pose : *content.trajectory) {
      poses_[pose.timestamp] = pose.world_from_cam;
    }
  }

  // Returns the number of images that could not be read.
  size_t Write() {
    // What holds for the whole run comes first, so that players show it from the beginning.
    const RosTime start = ToRosTime(content_.sequence->frames.front().timestamp);
    const std::vector<ReportedObject>& objects = content_.objects->objects;
    WriteOnce("/map/path", "nav_msgs/msg/Path", start, PathMessage(start, *content_.trajectory));
    WriteOnce("/map/points", "sensor_msgs/msg/PointCloud2", start, Points(start));
    WriteOnce("/map/objects", "vision_msgs/msg/Detection3DArray", start,
              DetectionsMessage(start, objects));
    WriteOnce("/map/scene", "foxglove_msgs/msg/SceneUpdate", start, SceneMessage(start, objects));
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
    const Sensor sensor = MakeSensor(*content_.options);
    ViewModel model;
    AddMap(*content_.map, sensor, content_.options->objects, model);
    RunImageTasks(*content_.sequence, sensor.camera,
                  ColourTasks(FindLandmarkPixels(*content_.map, sensor), model));
    return PointsMessage(time, model.landmarks.positions, model.landmarks.colours);
  }

  size_t WriteFrames() {
    const uint16_t transforms = Add("/tf", "tf2_msgs/msg/TFMessage");
    const uint16_t cameras = Add("/camera/camera_info", "sensor_msgs/msg/CameraInfo");
    const uint16_t images = Add("/camera/image/compressed", "sensor_msgs/msg/CompressedImage");
    const PinholeCamera& camera = content_.options->camera;
    size_t missing = 0;
    for (size_t i = 0; i < content_.frames; ++i) {
      const FramePaths& frame = content_.sequence->frames[i];
      const RosTime time = ToRosTime(frame.timestamp);
      if (const auto pose = poses_.find(frame.timestamp); pose != poses_.end()) {
        writer_.Write(transforms, time.Nanoseconds(), TransformMessage(time, pose->second));
      }
      try {
        const std::string jpeg =
            EncodeJpeg(LoadColour(*content_.sequence, frame, camera), kJpegQuality);
        writer_.Write(cameras, time.Nanoseconds(), CameraInfoMessageOf(time, camera));
        writer_.Write(images, time.Nanoseconds(), JpegMessage(time, jpeg));
      } catch (const InputError&) {
        ++missing;
      }
    }
    return missing;
  }

  const McapContent& content_;
  McapWriter writer_;
  std::map<double, Rigid3> poses_;  // by time stamp
};

}  // namespace

void AddMcapOption(CLI::App& app, std::filesystem::path& file) {
  app.add_option(
      "--mcap", file,
      "file for a recording of the run, to be played by Foxglove, Rerun or ROS 2: images, "
      "poses, landmarks and objects; replaces an earlier one");
}

std::string WriteMcap(const RunArguments& arguments, const McapContent& content) {
  if (arguments.mcap.empty()) {
    return {};
  }
  if (!arguments.quiet) {
    PrintError("writing {}\n", arguments.mcap.string());
  }
  try {
    const size_t missing = RunRecorder(arguments.mcap, content).Write();
    if (missing > 0) {
      PrintError("warning: {}: {} images could not be read and are not in it\n",
                 arguments.mcap.string(), missing);
    }
  } catch (const InputError& error) {
    return fmt::format("{}; the recording was not written, the other results were", error.what());
  }
  return {};
}

}  // namespace hullslam
