// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/image_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "files/bytes.h"
#include "files/protobuf_reader.h"
#include "hullslam/util/error.h"

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

// google.protobuf.Timestamp.
BagTime ReadTimestamp(std::string_view bytes, const std::string& name) {
  BagTime stamp;
  ProtobufReader reader(bytes, name);
  while (reader.Next()) {
    if (reader.field() == 1) {
      stamp.seconds = static_cast<int64_t>(reader.number());
    } else if (reader.field() == 2) {
      stamp.nanoseconds = static_cast<uint32_t>(reader.number());
    }
  }
  if (stamp.nanoseconds >= 1'000'000'000) {
    throw InputError(
        fmt::format("{} has a stamp with {} nanoseconds, expected less than 1000000000", name,
                    stamp.nanoseconds));
  }
  return stamp;
}

// foxglove.RawImage. Its numbers of 16 and 32 bits are little-endian.
RawImageMessage ReadFoxgloveImage(std::string_view bytes, const std::string& name) {
  RawImageMessage image;
  ProtobufReader reader(bytes, name);
  while (reader.Next()) {
    switch (reader.field()) {
      case 1:
        image.stamp = ReadTimestamp(reader.bytes(), name);
        break;
      case 2:
        image.width = static_cast<uint32_t>(reader.number());
        break;
      case 3:
        image.height = static_cast<uint32_t>(reader.number());
        break;
      case 4:
        image.encoding = reader.bytes();
        break;
      case 5:
        image.step = static_cast<uint32_t>(reader.number());
        break;
      case 6:
        image.data = reader.bytes();
        break;
      default:
        break;
    }
  }
  return image;
}

// foxglove.CompressedImage.
CompressedImageMessage ReadFoxgloveCompressedImage(std::string_view bytes,
                                                   const std::string& name) {
  CompressedImageMessage image;
  ProtobufReader reader(bytes, name);
  while (reader.Next()) {
    if (reader.field() == 1) {
      image.stamp = ReadTimestamp(reader.bytes(), name);
    } else if (reader.field() == 2) {
      image.data = reader.bytes();
    } else if (reader.field() == 3) {
      image.format = reader.bytes();
    }
  }
  return image;
}

// A packed list of numbers.
std::vector<double> ReadDoubles(std::string_view bytes, const std::string& name) {
  std::vector<double> numbers(bytes.size() / sizeof(double));
  ByteReader reader(bytes, name);
  for (double& number : numbers) {
    number = reader.Get<double>();
  }
  return numbers;
}

template <size_t kCount>
void CopyMatrix(const std::vector<double>& numbers, std::array<double, kCount>& matrix) {
  std::copy_n(numbers.begin(), std::min(numbers.size(), kCount), matrix.begin());
}

// foxglove.CameraCalibration.
CameraInfoMessage ReadFoxgloveCamera(std::string_view bytes, const std::string& name) {
  CameraInfoMessage camera;
  ProtobufReader reader(bytes, name);
  while (reader.Next()) {
    if (reader.field() == 2) {
      camera.width = static_cast<uint32_t>(reader.number());
    } else if (reader.field() == 3) {
      camera.height = static_cast<uint32_t>(reader.number());
    } else if (reader.field() == 4) {
      camera.distortion_model = std::string(reader.bytes());
    } else if (reader.field() == 5) {
      camera.distortion = ReadDoubles(reader.bytes(), name);
    } else if (reader.field() == 6) {
      CopyMatrix(ReadDoubles(reader.bytes(), name), camera.k);
    } else if (reader.field() == 7) {
      CopyMatrix(ReadDoubles(reader.bytes(), name), camera.r);
    } else if (reader.field() == 8) {
      CopyMatrix(ReadDoubles(reader.bytes(), name), camera.p);
    }
  }
  return camera;
}

void CheckRows(const RawImageMessage& image, const std::string& name) {
  if (uint64_t{image.step} * image.height > image.data.size()) {
    throw InputError(fmt::format("{} has an image of {} rows of {} bytes, but only {} bytes", name,
                                 image.height, image.step, image.data.size()));
  }
}

}  // namespace

BagContent ContentOf(const BagTopic& topic) {
  const bool is_protobuf = topic.coding == MessageCoding::kProtobuf;
  if (topic.type == (is_protobuf ? "foxglove.RawImage" : "sensor_msgs/Image")) {
    return BagContent::kImage;
  }
  if (topic.type == (is_protobuf ? "foxglove.CompressedImage" : "sensor_msgs/CompressedImage")) {
    return BagContent::kCompressedImage;
  }
  return topic.type == (is_protobuf ? "foxglove.CameraCalibration" : "sensor_msgs/CameraInfo")
             ? BagContent::kCamera
             : BagContent::kOther;
}

RawImageMessage ReadRawImage(MessageCoding coding, std::string_view bytes,
                             const std::string& name) {
  if (coding == MessageCoding::kProtobuf) {
    const RawImageMessage image = ReadFoxgloveImage(bytes, name);
    CheckRows(image, name);
    return image;
  }
  FieldReader reader(coding, bytes, name);
  RawImageMessage image;
  image.stamp = ReadHeader(reader);
  image.height = reader.Get<uint32_t>();
  image.width = reader.Get<uint32_t>();
  image.encoding = reader.GetText();
  image.is_big_endian = reader.Get<uint8_t>() != 0;
  image.step = reader.Get<uint32_t>();
  image.data = reader.GetBytes();
  CheckRows(image, name);
  return image;
}

CompressedImageMessage ReadCompressedImage(MessageCoding coding, std::string_view bytes,
                                           const std::string& name) {
  if (coding == MessageCoding::kProtobuf) {
    return ReadFoxgloveCompressedImage(bytes, name);
  }
  FieldReader reader(coding, bytes, name);
  CompressedImageMessage image;
  image.stamp = ReadHeader(reader);
  image.format = reader.GetText();
  image.data = reader.GetBytes();
  return image;
}

CameraInfoMessage ReadCameraInfo(MessageCoding coding, std::string_view bytes,
                                 const std::string& name) {
  if (coding == MessageCoding::kProtobuf) {
    return ReadFoxgloveCamera(bytes, name);
  }
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
  for (const std::span<double> matrix :
       {std::span<double>(camera.k), std::span<double>(camera.r), std::span<double>(camera.p)}) {
    for (double& number : matrix) {
      number = reader.Get<double>();
    }
  }
  return camera;
}

}  // namespace hullslam
