// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bags/bag.h"
#include "bags/message_fields.h"

namespace hullslam {

// The messages that a sequence is made of: messages of ROS (sensor_msgs), and of Foxglove with
// the same content. Views refer to the bytes of the message.

// A time as ROS has it: seconds and nanoseconds since a beginning that the recorder knows.
struct BagTime {
  int64_t seconds = 0;
  uint32_t nanoseconds = 0;
  auto operator<=>(const BagTime&) const = default;

  bool IsZero() const { return seconds == 0 && nanoseconds == 0; }
  // s. The double that is nearest to the decimal number, for stamps of whole microseconds.
  double Seconds() const { return static_cast<double>(seconds) + nanoseconds / 1e9; }
};

// The kind of the messages of a topic.
enum class BagContent { kImage, kCompressedImage, kCamera, kOther };
BagContent ContentOf(const BagTopic& topic);

// sensor_msgs/Image or foxglove.RawImage. The rows have `step` bytes each; `data` has at least
// `height` of them.
struct RawImageMessage {
  BagTime stamp;
  uint32_t height = 0;  // px
  uint32_t width = 0;
  std::string_view encoding;  // "bgr8", "16UC1", ...
  bool is_big_endian = false;
  uint32_t step = 0;
  std::string_view data;
};

// sensor_msgs/CompressedImage or foxglove.CompressedImage.
struct CompressedImageMessage {
  BagTime stamp;
  std::string_view format;  // "jpeg", "bgr8; jpeg compressed bgr8", "16UC1; compressedDepth", ...
  std::string_view data;
};

// sensor_msgs/CameraInfo or foxglove.CameraCalibration.
struct CameraInfoMessage {
  uint32_t height = 0;  // px
  uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> distortion;
  // Matrices row by row: the calibration matrix (px), the rotation that rectifies a camera of a
  // pair, and the projection of the rectified images (px). The last two are 0 if the message lacks
  // them.
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
};

// Read a message. Throw InputError that begins with `name`, the name of the file and the topic, if
// the bytes are cut off or contradict each other.
RawImageMessage ReadRawImage(MessageCoding coding, std::string_view bytes, const std::string& name);
CompressedImageMessage ReadCompressedImage(MessageCoding coding, std::string_view bytes,
                                           const std::string& name);
CameraInfoMessage ReadCameraInfo(MessageCoding coding, std::string_view bytes,
                                 const std::string& name);

}  // namespace hullslam
