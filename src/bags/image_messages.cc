// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/image_messages.h"

#include <fmt/format.h>

namespace hullslam {
namespace {

// std_msgs/Header; the frame is not used.
BagTime ReadHeader(FieldReader& reader) {
  BagTime stamp;
  if (reader.coding() == MessageCoding::kRos1) {
    reader.Get<uint32_t>();  // the number of the message
    stamp.seconds = reader.Get<uint32_t>();
  } else {
    stamp.seconds = reader.Get<int32_t>();
  }
  stamp.nanoseconds = reader.Get<uint32_t>();
  if (stamp.nanoseconds >= 1'000'000'000) {
    reader.Fail(fmt::format("has a stamp with {} nanoseconds, expected less than 1000000000",
                            stamp.nanoseconds));
  }
  reader.GetText();
  return stamp;
}

}  // namespace

RawImageMessage ReadRawImage(MessageCoding coding, std::string_view bytes,
                             const std::string& name) {
  FieldReader reader(coding, bytes, name);
  RawImageMessage image;
  image.stamp = ReadHeader(reader);
  image.height = reader.Get<uint32_t>();
  image.width = reader.Get<uint32_t>();
  image.encoding = reader.GetText();
  image.is_big_endian = reader.Get<uint8_t>() != 0;
  image.step = reader.Get<uint32_t>();
  image.data = reader.GetBytes();
  if (uint64_t{image.step} * image.height > image.data.size()) {
    reader.Fail(fmt::format("has an image of {} rows of {} bytes, but only {} bytes", image.height,
                            image.step, image.data.size()));
  }
  return image;
}

CompressedImageMessage ReadCompressedImage(MessageCoding coding, std::string_view bytes,
                                           const std::string& name) {
  FieldReader reader(coding, bytes, name);
  CompressedImageMessage image;
  image.stamp = ReadHeader(reader);
  image.format = reader.GetText();
  image.data = reader.GetBytes();
  return image;
}

CameraInfoMessage ReadCameraInfo(MessageCoding coding, std::string_view bytes,
                                 const std::string& name) {
  FieldReader reader(coding, bytes, name);
  CameraInfoMessage camera;
  ReadHeader(reader);
  camera.height = reader.Get<uint32_t>();
  camera.width = reader.Get<uint32_t>();
  camera.distortion_model = std::string(reader.GetText());
  camera.distortion.resize(reader.GetCount(sizeof(double)));
  for (double& number : camera.distortion) {
    number = reader.Get<double>();
  }
  for (double& number : camera.k) {
    number = reader.Get<double>();
  }
  return camera;
}

}  // namespace hullslam
