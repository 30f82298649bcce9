// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hullslam {

// Images of 16 bits use as many of them as the camera has: 10, 12, 14 or 16, which the largest
// value of all images of the camera tells. The highest of these become the 8 bits that are read;
// what is brighter is white. An image of 8 bits is returned as it is.
cv::Mat To8Bits(const cv::Mat& image, uint16_t brightest);

// The luma of an image in colour, CV_8UC3 or CV_8UC4, as libpng computes it when OpenCV reads a PNG
// in grey: in units of 1 / 32768, rounded down. cv::cvtColor rounds in another way, so that a
// recording would give another trajectory than the PNG files of the same images. `red` is the
// channel of red, 0 or 2.
cv::Mat GreyLikePng(const cv::Mat& image, int red);

constexpr uint64_t kMostImagePixels = 64'000'000;
constexpr uint64_t kMostImageSide = 65'535;  // px, as in a JPEG; each row has a cost of its own

// All functions throw InputError with the file and the reason if the file is missing, empty, cut
// off, neither PNG nor JPEG, larger than 512 MB or than these limits, or cannot be decoded.
// (Flipped bits inside a JPEG cannot be detected.)

// The luma of a PNG or JPEG image, CV_8UC1. An orientation in the EXIF data is ignored, because the
// calibration of the camera refers to the pixels as stored. Images with 16 bits per channel are
// errors too: they may be depth images. With `brightest`, for data sets without depth, they become
// 8 bits by To8Bits().
cv::Mat ReadGreyImage(const std::filesystem::path& path,
                      std::optional<uint16_t> brightest = std::nullopt);

// A PNG or JPEG image in colour, CV_8UC3 with blue first; a grey image has three equal channels.
// Images with 16 bits per channel are as above.
cv::Mat ReadColourImage(const std::filesystem::path& path,
                        std::optional<uint16_t> brightest = std::nullopt);

// The largest value in the images of a camera, from up to 64 of them that lie evenly in the list.
// Only images of 16 bits are read; the result is 65535 if the first one has 8. Images that cannot
// be read are left out: they are reported when they are loaded.
uint16_t BrightestOf(std::span<const std::filesystem::path> images);

// A depth image with unchanged values, CV_16UC1. It is an error if the image does not have 16 bits
// or has several channels.
cv::Mat ReadDepthImage(const std::filesystem::path& path);

// A label image, with the number of an instance in each pixel. Read and checked like a depth image.
cv::Mat ReadLabelImage(const std::filesystem::path& path);

// The same for the bytes of an image that is a part of a file, such as a message of a bag. `name`
// stands for the file in messages.
cv::Mat DecodeGreyImage(const std::filesystem::path& name, std::string_view bytes);
cv::Mat DecodeColourImage(const std::filesystem::path& name, std::string_view bytes);
cv::Mat DecodeDepthImage(const std::filesystem::path& name, std::string_view bytes);

// The bytes of a file with this image. `extension` is ".png", ".jpg" or ".jpeg".
std::string EncodeImage(const cv::Mat& image, const std::string& extension);

}  // namespace hullslam
