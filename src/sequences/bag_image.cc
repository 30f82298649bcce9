// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "files/bytes.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "images/rvl_depth.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr int kNone = -1;

// How an encoding is stored.
struct Encoding {
  std::string_view name;
  int type = 0;
  BagImageKind kind = BagImageKind::kDepth;
  int red = kNone;        // the channel, if there are several; green is always 1
  int to_colour = kNone;  // the conversion of OpenCV to blue, green, red
};

constexpr auto kEncodings = std::to_array<Encoding>({
    {"mono8", CV_8UC1, BagImageKind::kColour, kNone, cv::COLOR_GRAY2BGR},
    {"8UC1", CV_8UC1, BagImageKind::kColour, kNone, cv::COLOR_GRAY2BGR},
    {"bgr8", CV_8UC3, BagImageKind::kColour, 2, kNone},
    {"8UC3", CV_8UC3, BagImageKind::kColour, 2, kNone},
    {"rgb8", CV_8UC3, BagImageKind::kColour, 0, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, BagImageKind::kColour, 2, cv::COLOR_BGRA2BGR},
    {"8UC4", CV_8UC4, BagImageKind::kColour, 2, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, BagImageKind::kColour, 0, cv::COLOR_RGBA2BGR},
    {"bayer_rggb8", CV_8UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerRGGB2BGR},
    {"bayer_bggr8", CV_8UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerBGGR2BGR},
    {"bayer_gbrg8", CV_8UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerGBRG2BGR},
    {"bayer_grbg8", CV_8UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerGRBG2BGR},
    {"bayer_rggb16", CV_16UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerRGGB2BGR},
    {"bayer_bggr16", CV_16UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerBGGR2BGR},
    {"bayer_gbrg16", CV_16UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerGBRG2BGR},
    {"bayer_grbg16", CV_16UC1, BagImageKind::kColour, kNone, cv::COLOR_BayerGRBG2BGR},
    {"yuv422", CV_8UC2, BagImageKind::kColour, kNone, cv::COLOR_YUV2BGR_UYVY},
    {"uyvy", CV_8UC2, BagImageKind::kColour, kNone, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8UC2, BagImageKind::kColour, kNone, cv::COLOR_YUV2BGR_YUY2},
    {"yuyv", CV_8UC2, BagImageKind::kColour, kNone, cv::COLOR_YUV2BGR_YUY2},
    {"mono16", CV_16UC1, BagImageKind::kEither, kNone, cv::COLOR_GRAY2BGR},
    {"16UC1", CV_16UC1},
    {"32FC1", CV_32FC1},
});

bool IsOfKind(const Encoding& encoding, BagImageKind kind) {
  return encoding.kind == kind || encoding.kind == BagImageKind::kEither;
}

const Encoding* FindEncoding(std::string_view name) {
  const auto* const found =
      std::find_if(kEncodings.begin(), kEncodings.end(),
                   [&](const Encoding& encoding) { return encoding.name == name; });
  return found == kEncodings.end() ? nullptr : found;
}

[[noreturn]] void FailKind(const std::string& name, std::string_view encoding,
                           std::string_view kind) {
  throw InputError(fmt::format("{}: the image is '{}', expected {}", name,
                               Printable(encoding.substr(0, 80)), kind));
}

const Encoding& ExpectKind(std::string_view name, BagImageKind kind, const std::string& place) {
  const Encoding* const encoding = FindEncoding(name);
  if (encoding == nullptr || !IsOfKind(*encoding, kind)) {
    FailKind(place, name,
             fmt::format("one of {}{}", ReadEncodings(kind),
                         kind == BagImageKind::kDepth ? "" : "; others must be converted"));
  }
  return *encoding;
}

// A copy of the pixels in this computer's order of bytes.
cv::Mat PixelsOf(const RawImageMessage& message, int type, const std::string& name) {
  const uint64_t pixels = uint64_t{message.width} * message.height;
  const uint64_t row_bytes = uint64_t{message.width} * CV_ELEM_SIZE(type);
  if (pixels == 0 || pixels > kMostImagePixels || message.width > kMostImagePixels ||
      message.height > kMostImagePixels || message.step < row_bytes) {
    throw InputError(fmt::format(
        "{}: the image has {}x{} px and rows of {} bytes, expected up to {} million px and rows of "
        "at least {} bytes",
        name, message.width, message.height, message.step, kMostImagePixels / 1'000'000,
        row_bytes));
  }
  cv::Mat image(static_cast<int>(message.height), static_cast<int>(message.width), type);
  for (int y = 0; y < image.rows; ++y) {
    std::memcpy(image.ptr(y), message.data.data() + size_t{message.step} * static_cast<size_t>(y),
                row_bytes);
  }
  const size_t size = CV_ELEM_SIZE1(type);
  if (size > 1 && message.is_big_endian != (std::endian::native == std::endian::big)) {
    for (uint8_t* number = image.data; number < image.dataend; number += size) {
      std::reverse(number, number + size);
    }
  }
  return image;
}

bool IsGrey(const Encoding& encoding) { return encoding.to_colour == cv::COLOR_GRAY2BGR; }

// "16UC1" of "16UC1; compressedDepth png".
std::string_view EncodingOfFormat(std::string_view format) {
  return format.substr(0, format.find(';'));
}

bool IsCompressedDepth(std::string_view format) {
  return format.find("compressedDepth") != std::string_view::npos;
}

// The depth of a PNG of inverse depths: z = a / (value - b), as in
// compressed_depth_image_transport.
cv::Mat InvertDepth(const cv::Mat& inverse, float a, float b) {
  cv::Mat depth(inverse.size(), CV_32FC1);
  for (int y = 0; y < inverse.rows; ++y) {
    const auto* const values = inverse.ptr<uint16_t>(y);
    auto* const metres = depth.ptr<float>(y);
    for (int x = 0; x < inverse.cols; ++x) {
      metres[x] = values[x] == 0 ? std::numeric_limits<float>::quiet_NaN()
                                 : a / (static_cast<float>(values[x]) - b);
    }
  }
  return depth;
}

}  // namespace

BagImageKind KindOfEncoding(std::string_view encoding) {
  const Encoding* const found = FindEncoding(encoding);
  return found == nullptr ? BagImageKind::kUnknown : found->kind;
}

// A format is an encoding, then a ';' and the compression, or only "png" or "jpeg".
BagImageKind KindOfFormat(std::string_view format) {
  if (IsCompressedDepth(format) ||
      KindOfEncoding(EncodingOfFormat(format)) == BagImageKind::kDepth) {
    return BagImageKind::kDepth;
  }
  const bool is_image = format.find("png") != std::string_view::npos ||
                        format.find("jpeg") != std::string_view::npos ||
                        format.find("jpg") != std::string_view::npos;
  return is_image ? BagImageKind::kColour : BagImageKind::kUnknown;
}

std::string ReadEncodings(BagImageKind kind) {
  std::vector<std::string_view> names;
  for (const Encoding& encoding : kEncodings) {
    if (IsOfKind(encoding, kind)) {
      names.push_back(encoding.name);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

uint16_t BrightestOf(const RawImageMessage& message) {
  const Encoding* const encoding = FindEncoding(message.encoding);
  if (encoding == nullptr || encoding->type != CV_16UC1 || encoding->kind == BagImageKind::kDepth) {
    return 0;
  }
  try {
    double brightest = 0.0;
    cv::minMaxLoc(PixelsOf(message, encoding->type, {}), nullptr, &brightest);
    return static_cast<uint16_t>(brightest);
  } catch (const InputError&) {  // the run will report this image
    return 0;
  }
}

cv::Mat GreyOf(const RawImageMessage& message, const std::string& name, uint16_t brightest) {
  const Encoding& encoding = ExpectKind(message.encoding, BagImageKind::kColour, name);
  if (IsGrey(encoding)) {
    return To8Bits(PixelsOf(message, encoding.type, name), brightest);
  }
  return encoding.red == kNone ? GreyLikePng(ColourOf(message, name, brightest), 2)
                               : GreyLikePng(PixelsOf(message, encoding.type, name), encoding.red);
}

cv::Mat GreyOf(const CompressedImageMessage& message, const std::string& name) {
  return DecodeGreyImage(name, message.data);
}

cv::Mat ColourOf(const RawImageMessage& message, const std::string& name, uint16_t brightest) {
  const Encoding& encoding = ExpectKind(message.encoding, BagImageKind::kColour, name);
  const cv::Mat image = To8Bits(PixelsOf(message, encoding.type, name), brightest);
  if (encoding.to_colour == kNone) {
    return image;
  }
  cv::Mat colour;
  try {
    cv::cvtColor(image, colour, encoding.to_colour);
  } catch (const cv::Exception&) {  // such as one with a single row in a Bayer pattern
    throw InputError(fmt::format("{}: an image of {}x{} px cannot have the encoding '{}'", name,
                                 image.cols, image.rows, encoding.name));
  }
  return colour;
}

cv::Mat ColourOf(const CompressedImageMessage& message, const std::string& name) {
  return DecodeColourImage(name, message.data);
}

cv::Mat DepthOf(const RawImageMessage& message, const std::string& name) {
  return PixelsOf(message, ExpectKind(message.encoding, BagImageKind::kDepth, name).type, name);
}

cv::Mat DepthOf(const CompressedImageMessage& message, const std::string& name) {
  if (!IsCompressedDepth(message.format)) {
    return DecodeDepthImage(name, message.data);
  }
  ByteReader reader(message.data, name + ": the depth image");
  reader.Get<uint32_t>();  // the kind of compression, which the format tells too
  const auto a = reader.Get<float>();
  const auto b = reader.Get<float>();
  const std::string_view data = reader.GetRaw(reader.left());
  const bool is_rvl = message.format.find("rvl") != std::string_view::npos;
  const cv::Mat values = is_rvl ? DecodeRvl(data, name) : DecodeDepthImage(name, data);
  return EncodingOfFormat(message.format) == "32FC1" ? InvertDepth(values, a, b) : values;
}

}  // namespace hullslam
