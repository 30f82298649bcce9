// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <zlib.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "images/image_codecs.h"

namespace hullslam {
namespace {

const HeaderCheck kAnyHeader = [](const ImageHeader&) {};

cv::Mat Noise(int type) {
  cv::Mat image(31, 47, type);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, image.elemSize1() == 1 ? 256 : 65536);
  return image;
}

std::string EncodedByOpencv(const cv::Mat& image, const std::vector<int>& parameters = {}) {
  std::vector<uint8_t> bytes;
  cv::imencode(".png", image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

cv::Mat DecodedByOpencv(const std::string& bytes, int flags) {
  return cv::imdecode(std::vector<uint8_t>(bytes.begin(), bytes.end()), flags);
}

void ExpectEqual(const cv::Mat& image, const cv::Mat& expected) {
  ASSERT_EQ(image.type(), expected.type());
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0.0);
}

void ExpectSameValues(const std::string& bytes) {
  ExpectEqual(DecodePng(bytes, PixelForm::kGrey, kAnyHeader),
              DecodedByOpencv(bytes, cv::IMREAD_GRAYSCALE));
  ExpectEqual(DecodePng(bytes, PixelForm::kColour, kAnyHeader),
              DecodedByOpencv(bytes, cv::IMREAD_COLOR));
}

TEST(PngCodec, ValuesAreThoseOfOpencv) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4}) {
    SCOPED_TRACE(type);
    ExpectSameValues(EncodedByOpencv(Noise(type)));
  }
}

TEST(PngCodec, PalettesAndSingleBitsAreThoseOfOpencv) {
  ExpectSameValues(EncodedByOpencv(Noise(CV_8UC1), {cv::IMWRITE_PNG_BILEVEL, 1}));
  // 2x1 px with a palette of black and red
  ExpectSameValues(std::string(
      "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00"
      "\x00\x01\x01\x03\x00\x00\x00\xce\xec\xed\xc9\x00\x00\x00\x06\x50\x4c\x54\x45\x00\x00\x00"
      "\xff\x00\x00\x1b\xff\x8d\x22\x00\x00\x00\x0a\x49\x44\x41\x54\x78\x9c\x63\x70\x00\x00\x00"
      "\x42\x00\x41\x29\x37\xf4\xef\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
      85));
}

TEST(PngCodec, SixteenBitsComeBack) {
  const cv::Mat depth = Noise(CV_16UC1);
  ExpectEqual(DecodePng(EncodePng(depth), PixelForm::kSixteenBit, kAnyHeader), depth);
}

TEST(PngCodec, FilesAreThoseOfOpencv) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    EXPECT_EQ(EncodePng(Noise(type)), EncodedByOpencv(Noise(type))) << type;
  }
}

TEST(PngCodec, SixteenBitsOfColourComeBack) {
  const cv::Mat image = Noise(CV_16UC3);
  ExpectEqual(DecodePng(EncodePng(image), PixelForm::kSixteenBit, kAnyHeader), image);
}

std::string Number(size_t number) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) {
    bytes += static_cast<char>(number >> shift & 255u);
  }
  return bytes;
}

std::string Chunk(const std::string& name, const std::string& data) {
  const std::string summed = name + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size()));
  return Number(data.size()) + summed + Number(sum);
}

std::string Deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 9);
  packed.resize(size);
  return packed;
}

constexpr size_t kFirstChunkEnds = 8 + 25;

// Ten gigabytes of text in ten megabytes.
TEST(PngCodec, TextIsNotDecompressed) {
  const std::string zeros = Deflated(std::string(7'900'000, '\0'));
  std::string text;
  for (int i = 0; i < 600; ++i) {
    text += Chunk("zTXt", std::string("k\0\0", 3) + zeros);
    text += Chunk("iTXt", std::string("k\0\1\0\0\0", 6) + zeros);
  }
  const cv::Mat image = Noise(CV_8UC1);
  std::string png = EncodePng(image);
  png.insert(kFirstChunkEnds, text);
  ExpectEqual(DecodePng(png, PixelForm::kGrey, kAnyHeader), image);
}

TEST(PngCodec, TheHeaderIsShownBeforeThePixelsAreRead) {
  const std::string whole = EncodePng(Noise(CV_16UC3));
  ImageHeader seen;
  const auto take = [&](const ImageHeader& header) {
    seen = header;
    throw DecodeError("refused");
  };
  constexpr size_t kHeader = 8 + 25 + 8;  // the signature, the header, the begin of the next chunk
  EXPECT_THROW(DecodePng(whole.substr(0, kHeader), PixelForm::kColour, take), DecodeError);
  EXPECT_EQ(seen.width, 47U);
  EXPECT_EQ(seen.height, 31U);
  EXPECT_EQ(seen.channels, 3);
  EXPECT_EQ(seen.bits, 16);
}

TEST(PngCodec, EveryFlippedByteIsFound) {
  const std::string whole = EncodePng(Noise(CV_8UC1));
  for (size_t i = 0; i < whole.size(); ++i) {
    std::string flipped = whole;
    flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
    EXPECT_THROW(DecodePng(flipped, PixelForm::kGrey, kAnyHeader), DecodeError) << i;
  }
}

TEST(PngCodec, EveryMissingEndIsFound) {
  const std::string whole = EncodePng(Noise(CV_8UC1));
  for (size_t size = 8; size < whole.size(); ++size) {
    EXPECT_THROW(DecodePng(whole.substr(0, size), PixelForm::kGrey, kAnyHeader), DecodeError)
        << size;
  }
}

}  // namespace
}  // namespace hullslam
