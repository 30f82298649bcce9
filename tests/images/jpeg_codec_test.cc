// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "images/image_codecs.h"

extern "C" {
#include <jpeglib.h>
}

#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace hullslam {
namespace {

void AcceptHeader(const ImageHeader& /*header*/) {}

// Noise at half the size of the image, so that its colours have edges that are worth upsampling.
cv::Mat Blots(int type) {
  cv::Mat small(20, 31, type);
  cv::RNG(3).fill(small, cv::RNG::UNIFORM, 0, 256);
  cv::Mat image;
  cv::resize(small, image, {61, 39}, 0, 0, cv::INTER_LINEAR);
  return image;
}

std::string JpegOfOpencv(const cv::Mat& image, const std::vector<int>& parameters) {
  std::vector<uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

void ExpectValuesOfOpencv(const std::string& jpeg) {
  const std::vector<uint8_t> bytes(jpeg.begin(), jpeg.end());
  const cv::Mat grey = DecodeJpeg(jpeg, PixelForm::kGrey, AcceptHeader);
  const cv::Mat colour = DecodeJpeg(jpeg, PixelForm::kColour, AcceptHeader);
  ASSERT_EQ(grey.type(), CV_8UC1);
  ASSERT_EQ(colour.type(), CV_8UC3);
  const int as_stored = cv::IMREAD_IGNORE_ORIENTATION;
  EXPECT_EQ(cv::norm(grey, cv::imdecode(bytes, cv::IMREAD_GRAYSCALE | as_stored), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(colour, cv::imdecode(bytes, cv::IMREAD_COLOR | as_stored), cv::NORM_INF), 0);
}

TEST(JpegCodec, ValuesAreThoseOfOpencv) {
  const std::vector<std::vector<int>> settings = {
      {},
      {cv::IMWRITE_JPEG_QUALITY, 40},
      {cv::IMWRITE_JPEG_QUALITY, 100},
      {cv::IMWRITE_JPEG_PROGRESSIVE, 1},
      {cv::IMWRITE_JPEG_OPTIMIZE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 2}};
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const std::vector<int>& parameters : settings) {
      ExpectValuesOfOpencv(JpegOfOpencv(Blots(type), parameters));
    }
  }
}

TEST(JpegCodec, TheOrientationIsIgnored) {
  std::string jpeg = EncodeJpeg(Blots(CV_8UC3), 90);
  // EXIF data, big-endian, with one entry: the orientation (0x0112, one short) is 6
  const std::string exif(
      "\xff\xe1\x00\x22"
      "Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0",
      36);
  jpeg.insert(2, exif);
  ExpectValuesOfOpencv(jpeg);
  EXPECT_EQ(DecodeJpeg(jpeg, PixelForm::kGrey, AcceptHeader).size(), cv::Size(61, 39));
}

TEST(JpegCodec, FilesAreThoseOfOpencv) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const int quality : {0, 80, 95, 100}) {
      EXPECT_EQ(EncodeJpeg(Blots(type), quality),
                JpegOfOpencv(Blots(type), {cv::IMWRITE_JPEG_QUALITY, quality}))
          << type << ' ' << quality;
    }
  }
}

TEST(JpegCodec, AJpegOfHigherQualityIsLargerAndMoreExact) {
  const cv::Mat image = Blots(CV_8UC1);
  const std::string coarse = EncodeJpeg(image, 30);
  const std::string fine = EncodeJpeg(image, 95);
  EXPECT_LT(coarse.size(), fine.size());
  EXPECT_LT(cv::norm(DecodeJpeg(fine, PixelForm::kGrey, AcceptHeader), image),
            cv::norm(DecodeJpeg(coarse, PixelForm::kGrey, AcceptHeader), image));
}

// A JPEG for a printer, which OpenCV cannot write.
std::string CmykJpeg() {
  jpeg_error_mgr errors;
  jpeg_compress_struct jpeg = {};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = 1;
  jpeg.image_height = 1;
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::array<uint8_t, 4> pixel = {1, 2, 3, 4};
  JSAMPROW row = pixel.data();
  jpeg_write_scanlines(&jpeg, &row, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string bytes(reinterpret_cast<char*>(data), size);
  std::free(data);
  return bytes;
}

TEST(JpegCodec, FourChannelsAreRefused) {
  try {
    DecodeJpeg(CmykJpeg(), PixelForm::kGrey, AcceptHeader);
    FAIL();
  } catch (const DecodeError& error) {
    EXPECT_NE(std::string(error.what()).find("4 channels"), std::string::npos) << error.what();
  }
}

TEST(JpegCodec, EveryMissingEndIsFound) {
  for (const int progressive : {0, 1}) {
    const std::string whole =
        JpegOfOpencv(Blots(CV_8UC3), {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
    for (size_t size = 3; size < whole.size(); ++size) {
      EXPECT_THROW(DecodeJpeg(whole.substr(0, size), PixelForm::kGrey, AcceptHeader), DecodeError)
          << progressive << ' ' << size;
    }
  }
}

std::string Segment(char marker, const std::string& data) {
  const size_t size = data.size() + 2;
  return std::string{'\xff', marker, static_cast<char>(size >> 8), static_cast<char>(size)} + data;
}

// A progressive JPEG of 8x8 px in grey whose scans after the first one say that a block is zero.
std::string JpegOfScans(int scans) {
  std::string jpeg = "\xff\xd8" + Segment('\xdb', '\0' + std::string(64, '\x10')) +
                     Segment('\xc2', std::string("\x08\0\x08\0\x08\x01\x01\x11\0", 9));
  std::string lengths(16, '\0');
  lengths[0] = 1;  // one code of one bit, for the symbol 0
  jpeg += Segment('\xc4', '\0' + lengths + '\0') + Segment('\xc4', '\x10' + lengths + '\0');
  const std::string bit = "\x7f";  // the code, and ones to the end of the byte
  jpeg += Segment('\xda', std::string("\x01\x01\0\0\0\0", 6)) + bit;
  for (int i = 1; i < scans; ++i) {
    jpeg += Segment('\xda', std::string("\x01\x01\0\x01\x3f\0", 6)) + bit;
  }
  return jpeg + "\xff\xd9";
}

// A scan of a few bytes goes through all pixels.
TEST(JpegCodec, TooManyScansAreRefused) {
  for (const int scans : {1, 10, 50}) {
    const cv::Mat image = DecodeJpeg(JpegOfScans(scans), PixelForm::kGrey, AcceptHeader);
    EXPECT_EQ(cv::norm(image, cv::Mat(8, 8, CV_8UC1, cv::Scalar(128)), cv::NORM_INF), 0.0) << scans;
  }
  for (const int scans : {51, 5000}) {
    try {
      DecodeJpeg(JpegOfScans(scans), PixelForm::kGrey, AcceptHeader);
      ADD_FAILURE() << scans;
    } catch (const DecodeError& error) {
      EXPECT_STREQ(error.what(),
                   "has more than 50 scans, expected a JPEG of a camera, which has 1 to 20");
    }
  }
}

}  // namespace
}  // namespace hullslam
