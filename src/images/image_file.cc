// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "files/read_file.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "images/image_codecs.h"

namespace hullslam {

cv::Mat To8Bits(const cv::Mat& image, uint16_t brightest) {
  if (image.depth() == CV_8U) {
    return image;
  }
  const int bits = std::max(8, (static_cast<int>(std::bit_width(unsigned{brightest})) + 1) / 2 * 2);
  // The lower bits are cut off, as libpng does: the offset makes rounding do this.
  const double scale = 1.0 / (1 << (bits - 8));
  cv::Mat scaled;
  image.convertTo(scaled, CV_8U, scale, 0.5 * scale - 0.5);
  return scaled;
}

cv::Mat GreyLikePng(const cv::Mat& image, int red) {
  constexpr unsigned int kRed = 9797;     // 0.299
  constexpr unsigned int kGreen = 19234;  // 0.587
  constexpr unsigned int kBlue = 32768 - kRed - kGreen;
  cv::Mat grey(image.size(), CV_8UC1);
  const int blue = 2 - red;
  const int channels = image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const uint8_t* pixel = image.ptr<uint8_t>(y);
    auto* const luma = grey.ptr<uint8_t>(y);
    for (int x = 0; x < image.cols; ++x, pixel += channels) {
      luma[x] = static_cast<uint8_t>(
          (kRed * pixel[red] + kGreen * pixel[1] + kBlue * pixel[blue]) >> 15U);
    }
  }
  return grey;
}

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
  if (header.width == 0 || header.height == 0 || header.width > kMostImageSide ||
      header.height > kMostImageSide || header.width * header.height > kMostImagePixels) {
    Fail(path,
         fmt::format("has a size of {}x{} px, expected up to {} million px, and up to {} on a side",
                     header.width, header.height, kMostImagePixels / 1'000'000, kMostImageSide));
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

// Whether these are the bytes of a PNG with 16 bits per channel. Its first chunk has them at a
// fixed position.
bool IsSixteenBitPng(std::string_view bytes) {
  constexpr size_t kBitsAt = 24;
  return bytes.starts_with(kPngSignature) && bytes.size() > kBitsAt && bytes[kBitsAt] == 16;
}

cv::Mat Decode8Bit(const std::filesystem::path& path, std::string_view bytes, PixelForm form) {
  return Decode(path, bytes, form, [&](const ImageHeader& header) {
    if (header.bits > 8) {
      Fail(path,
           fmt::format("has {} bits per channel, expected an image with 8 bits, grey or in colour; "
                       "if this is no depth image, it must be converted",
                       header.bits));
    }
  });
}

cv::Mat DecodeAnyBits(const std::filesystem::path& path, std::string_view bytes, PixelForm form,
                      std::optional<uint16_t> brightest) {
  if (!brightest || !IsSixteenBitPng(bytes)) {
    return Decode8Bit(path, bytes, form);
  }
  const cv::Mat image =
      To8Bits(Decode(path, bytes, PixelForm::kSixteenBit, [](const ImageHeader&) {}), *brightest);
  if (form == PixelForm::kGrey) {
    return image.channels() == 1 ? image : GreyLikePng(image, 2);
  }
  cv::Mat colour = image;
  if (image.channels() == 1) {
    cv::merge(std::vector<cv::Mat>(3, image), colour);
  }
  return colour;
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

cv::Mat ReadGreyImage(const std::filesystem::path& path, std::optional<uint16_t> brightest) {
  return DecodeAnyBits(path, ReadImageFile(path), PixelForm::kGrey, brightest);
}

cv::Mat ReadColourImage(const std::filesystem::path& path, std::optional<uint16_t> brightest) {
  return DecodeAnyBits(path, ReadImageFile(path), PixelForm::kColour, brightest);
}

uint16_t BrightestOf(std::span<const std::filesystem::path> images) {
  constexpr size_t kMostRead = 64;
  constexpr uint16_t kWhite = 65'535;
  const size_t count = std::min(images.size(), kMostRead);
  double brightest = 0.0;
  for (size_t i = 0; i < count; ++i) {
    try {
      const std::filesystem::path& path = images[i * images.size() / count];
      const std::string bytes = ReadImageFile(path);
      if (IsSixteenBitPng(bytes)) {
        double largest = 0.0;
        cv::minMaxLoc(
            Decode(path, bytes, PixelForm::kSixteenBit, [](const ImageHeader&) {}).reshape(1),
            nullptr, &largest);
        brightest = std::max(brightest, largest);
      } else if (i == 0) {
        return kWhite;
      }
    } catch (const InputError&) {
    }
  }
  return brightest > 0.0 ? static_cast<uint16_t>(brightest) : kWhite;
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
