// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/image_file.h"

#include <fmt/format.h>

#include <boost/crc.hpp>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "files/read_file.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view kJpegSignature = "\xff\xd8\xff"sv;

constexpr int kGreyFlags = cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION;

struct ImageSize {
  uint64_t width = 0;
  uint64_t height = 0;
};

uint64_t BigEndian(std::string_view bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

enum class ImageState { kGood, kCutOff, kBroken };

// A chunk consists of length, type, data, and the checksum of type and data. libpng would return
// the upper part of an image whose lower part is missing, so the last chunk must be there. libpng
// also reports wrong bytes on stderr, so the checksums are tested before it is called.
ImageState CheckPngChunks(std::string_view bytes) {
  constexpr size_t kFrame = 12;  // bytes of a chunk in addition to its data
  size_t at = kPngSignature.size();
  while (at + kFrame <= bytes.size()) {
    const size_t length = BigEndian(bytes, at, 4);
    const std::string_view chunk = bytes.substr(at + 4, length + 4);
    at += kFrame + length;
    if (at > bytes.size()) {
      return ImageState::kCutOff;
    }
    boost::crc_32_type checksum;
    checksum.process_bytes(chunk.data(), chunk.size());
    if (checksum.checksum() != BigEndian(bytes, at - 4, 4)) {
      return ImageState::kBroken;
    }
    if (chunk.starts_with("IEND")) {
      return ImageState::kGood;
    }
  }
  return ImageState::kCutOff;
}

// The size in the header of a PNG; zeros if the first chunk is no header.
ImageSize PngSize(std::string_view bytes) {
  constexpr size_t kWidth = 16;  // after the signature and the length and type of the header chunk
  if (bytes.size() < kWidth + 8 || bytes.substr(kWidth - 4, 4) != "IHDR") {
    return {};
  }
  return {BigEndian(bytes, kWidth, 4), BigEndian(bytes, kWidth + 4, 4)};
}

bool HasPalette(std::string_view bytes) {
  constexpr size_t kColourType = 25;  // in the header chunk, after the size and the bits
  return bytes.starts_with(kPngSignature) && bytes.size() > kColourType && bytes[kColourType] == 3;
}

// Whether a marker has no length and no data.
bool IsAlone(unsigned char marker) { return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7); }

// Whether the JPEG has its end marker. Anything may follow: phones append a film (motion photos) or
// further images. Segments are passed over by their lengths, because a thumbnail inside one has an
// end marker of its own. Within the data of a scan, a marker follows 0xff, and 0xff itself is
// followed by 0.
ImageState CheckJpegEnd(std::string_view bytes) {
  constexpr unsigned char kEndOfImage = 0xd9;
  size_t at = 2;
  while (true) {
    at = bytes.find('\xff', at);
    at = at == std::string_view::npos ? at : bytes.find_first_not_of('\xff', at);
    if (at == std::string_view::npos) {
      return ImageState::kCutOff;
    }
    const auto marker = static_cast<unsigned char>(bytes[at]);
    ++at;
    if (marker == kEndOfImage) {
      return ImageState::kGood;
    }
    if (marker != 0 && !IsAlone(marker)) {
      at += at + 2 <= bytes.size() ? BigEndian(bytes, at, 2) : 0;
    }
  }
}

// The size in the frame header of a JPEG (SOF0 to SOF15; the codes DHT, JPG and DAC between them
// are no frame headers). Zeros if there is no frame header before the first scan. Also zeros if
// anything else than segments comes before the header: a decoder might skip those bytes and find
// another header than this function.
ImageSize JpegSize(std::string_view bytes) {
  constexpr unsigned char kStartOfScan = 0xda;
  constexpr unsigned char kEndOfImage = 0xd9;
  for (size_t at = 2; at < bytes.size() && bytes[at] == '\xff';) {
    at = bytes.find_first_not_of('\xff', at);  // fill bytes may come before the marker's code
    constexpr size_t kHeader = 8;              // code, length, precision, height, width
    if (at == std::string_view::npos || at + kHeader > bytes.size()) {
      return {};
    }
    const auto marker = static_cast<unsigned char>(bytes[at]);
    const bool is_table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !is_table) {
      return {BigEndian(bytes, at + 6, 2), BigEndian(bytes, at + 4, 2)};
    }
    if (marker == kStartOfScan || marker == kEndOfImage) {
      return {};
    }
    at += IsAlone(marker) ? 1 : 1 + BigEndian(bytes, at + 1, 2);
  }
  return {};
}

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(path.string() + ": " + reason);
}

void CheckBytes(const std::filesystem::path& path, std::string_view bytes) {
  if (bytes.empty()) {
    Fail(path, "is empty, expected a PNG or JPEG image");
  }
  const bool is_png = bytes.starts_with(kPngSignature);
  if (!is_png && !bytes.starts_with(kJpegSignature)) {
    Fail(path, "is neither a PNG nor a JPEG image");
  }
  const ImageState state = is_png ? CheckPngChunks(bytes) : CheckJpegEnd(bytes);
  if (state == ImageState::kCutOff) {
    Fail(path, "is cut off, the end of the image is missing");
  }
  const ImageSize size = is_png ? PngSize(bytes) : JpegSize(bytes);
  if (size.width == 0 && size.height == 0) {
    Fail(path, "is broken, the header with the size of the image is missing");
  }
  if (size.width == 0 || size.height == 0 || size.width > kMostImagePixels ||
      size.width * size.height > kMostImagePixels) {
    Fail(path, fmt::format("has a size of {}x{} px, expected up to {} million px", size.width,
                           size.height, kMostImagePixels / 1'000'000));
  }
  if (state == ImageState::kBroken) {
    Fail(path, "is broken, a checksum of the PNG is wrong");
  }
}

std::string ReadImageFile(const std::filesystem::path& path) {
  // An image of 64 million px with 4 channels of 16 bits, not compressed, has 512 MB.
  constexpr size_t kMostBytes = 512'000'000;
  return ReadFile(path, kMostBytes);
}

cv::Mat Decode(const std::filesystem::path& path, std::string_view bytes, int flags) {
  CheckBytes(path, bytes);
  const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1,
                       const_cast<char*>(bytes.data()));  // OpenCV only reads it
  cv::Mat image;
  try {
    image = cv::imdecode(buffer, flags);
  } catch (const cv::Exception& error) {
    Fail(path, "cannot be decoded: " + error.err);
  }
  if (image.empty()) {
    Fail(path, "is broken and cannot be decoded");
  }
  return image;
}

cv::Mat Decode16Bit(const std::filesystem::path& path, std::string_view bytes, const char* kind) {
  cv::Mat image = Decode(path, bytes, cv::IMREAD_UNCHANGED);
  if (image.type() != CV_16UC1) {
    if (HasPalette(bytes)) {
      Fail(path, fmt::format("is a PNG with a palette of colours, expected a {} image with one "
                             "channel of 16 bits",
                             kind));
    }
    Fail(path, fmt::format("has {} channel(s) of {} bits, expected a {} image with one channel of "
                           "16 bits",
                           image.channels(), 8 * image.elemSize1(), kind));
  }
  return image;
}

cv::Mat Decode8Bit(const std::filesystem::path& path, std::string_view bytes, int flags) {
  cv::Mat image = Decode(path, bytes, flags | cv::IMREAD_ANYDEPTH);
  if (image.depth() != CV_8U) {
    Fail(path,
         fmt::format("has {} bits per channel, expected an image with 8 bits, grey or in colour; "
                     "if this is no depth image, it must be converted",
                     8 * image.elemSize1()));
  }
  return image;
}

std::string Encode(const cv::Mat& image, const std::string& extension,
                   const std::vector<int>& parameters) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

cv::Mat DecodeGreyImage(const std::filesystem::path& name, std::string_view bytes) {
  return Decode8Bit(name, bytes, kGreyFlags);
}

cv::Mat DecodeColourImage(const std::filesystem::path& name, std::string_view bytes) {
  return Decode8Bit(name, bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
}

cv::Mat DecodeDepthImage(const std::filesystem::path& name, std::string_view bytes) {
  return Decode16Bit(name, bytes, "depth");
}

cv::Mat ReadGreyImage(const std::filesystem::path& path) {
  return DecodeGreyImage(path, ReadImageFile(path));
}

cv::Mat ReadColourImage(const std::filesystem::path& path) {
  return DecodeColourImage(path, ReadImageFile(path));
}

cv::Mat ReadDepthImage(const std::filesystem::path& path) {
  return DecodeDepthImage(path, ReadImageFile(path));
}

cv::Mat ReadLabelImage(const std::filesystem::path& path) {
  return Decode16Bit(path, ReadImageFile(path), "label");
}

std::string EncodeImage(const cv::Mat& image, const std::string& extension) {
  return Encode(image, extension, {});
}

std::string EncodeJpeg(const cv::Mat& image, int quality) {
  return Encode(image, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality});
}

}  // namespace hullslam
