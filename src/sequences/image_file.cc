// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/image_file.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "files/read_file.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "sequences/image_header.h"
#include "sequences/jpeg_codec.h"
#include "sequences/png_codec.h"

namespace hullslam {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view kJpegSignature = "\xff\xd8\xff"sv;

[[noreturn]] void Fail(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(path.string() + ": " + reason);
}

std::string ReadImageFile(const std::filesystem::path& path) {
  // An image of 64 million px with 4 channels of 16 bits, not compressed, has 512 MB.
  constexpr size_t kMostBytes = 512'000'000;
  return ReadFile(path, kMostBytes);
}

void CheckSize(const std::filesystem::path& path, const ImageHeader& header) {
  if (header.width == 0 || header.height == 0 || header.width > kMostImagePixels ||
      header.width * header.height > kMostImagePixels) {
    Fail(path, fmt::format("has a size of {}x{} px, expected up to {} million px", header.width,
                           header.height, kMostImagePixels / 1'000'000));
  }
}

cv::Mat Decode(const std::filesystem::path& path, std::string_view bytes, PixelForm form,
               const HeaderCheck& check) {
  if (bytes.empty()) {
    Fail(path, "is empty, expected a PNG or JPEG image");
  }
  const bool is_png = bytes.starts_with(kPngSignature);
  if (!is_png && !bytes.starts_with(kJpegSignature)) {
    Fail(path, "is neither a PNG nor a JPEG image");
  }
  const auto check_all = [&](const ImageHeader& header) {
    CheckSize(path, header);
    check(header);
  };
  try {
    return is_png ? DecodePng(bytes, form, check_all) : DecodeJpeg(bytes, form, check_all);
  } catch (const DecodeError& error) {
    Fail(path, error.what());
  }
}

cv::Mat Decode16Bit(const std::filesystem::path& path, std::string_view bytes, const char* kind) {
  return Decode(path, bytes, PixelForm::kSixteenBit, [&](const ImageHeader& header) {
    if (header.has_palette) {
      Fail(path, fmt::format("is a PNG with a palette of colours, expected a {} image with one "
                             "channel of 16 bits",
                             kind));
    }
    if (header.channels != 1 || header.bits != 16) {
      Fail(path, fmt::format("has {} channel(s) of {} bits, expected a {} image with one channel "
                             "of 16 bits",
                             header.channels, header.bits, kind));
    }
  });
}

cv::Mat Decode8Bit(const std::filesystem::path& path, std::string_view bytes, PixelForm form,
                   int most_bits = 8) {
  return Decode(path, bytes, form, [&](const ImageHeader& header) {
    if (header.bits > most_bits) {
      Fail(path,
           fmt::format("has {} bits per channel, expected an image with 8 bits, grey or in colour; "
                       "if this is no depth image, it must be converted",
                       header.bits));
    }
  });
}

}  // namespace

cv::Mat DecodeGreyImage(const std::filesystem::path& name, std::string_view bytes) {
  return Decode8Bit(name, bytes, PixelForm::kGrey);
}

cv::Mat DecodeColourImage(const std::filesystem::path& name, std::string_view bytes) {
  return Decode8Bit(name, bytes, PixelForm::kColour);
}

cv::Mat DecodeDepthImage(const std::filesystem::path& name, std::string_view bytes) {
  return Decode16Bit(name, bytes, "depth");
}

cv::Mat ReadGreyImage(const std::filesystem::path& path, int most_bits) {
  return Decode8Bit(path, ReadImageFile(path), PixelForm::kGrey, most_bits);
}

cv::Mat ReadColourImage(const std::filesystem::path& path, int most_bits) {
  return Decode8Bit(path, ReadImageFile(path), PixelForm::kColour, most_bits);
}

cv::Mat ReadDepthImage(const std::filesystem::path& path) {
  return DecodeDepthImage(path, ReadImageFile(path));
}

cv::Mat ReadLabelImage(const std::filesystem::path& path) {
  return Decode16Bit(path, ReadImageFile(path), "label");
}

std::string EncodeImage(const cv::Mat& image, const std::string& extension) {
  Check(extension == ".png" || extension == ".jpg" || extension == ".jpeg",
        "an image is written as .png, .jpg or .jpeg");
  constexpr int kQuality = 95;  // as cv::imencode
  return extension == ".png" ? EncodePng(image) : EncodeJpeg(image, kQuality);
}

}  // namespace hullslam
