// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/image_file.h"

#include <gtest/gtest.h>

#include <boost/crc.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

cv::Mat Values(const std::vector<uint16_t>& values) { return cv::Mat(values, true).reshape(1, 1); }

TEST(EightBits, TheHighestBitsOfTheCameraAreTaken) {
  struct Case {
    uint16_t brightest;
    int shift;
  };
  for (const Case& one : {Case{255, 0}, Case{900, 2}, Case{1023, 2}, Case{1024, 4}, Case{4095, 4},
                          Case{16383, 6}, Case{16384, 8}, Case{65535, 8}}) {
    const cv::Mat image = Values({0, one.brightest, static_cast<uint16_t>(7 << one.shift)});
    const cv::Mat scaled = To8Bits(image, one.brightest);
    ASSERT_EQ(scaled.type(), CV_8UC1);
    EXPECT_EQ(scaled.at<uint8_t>(0), 0);
    EXPECT_NEAR(scaled.at<uint8_t>(1), one.brightest >> one.shift, 1) << one.brightest;
    EXPECT_EQ(scaled.at<uint8_t>(2), 7) << one.brightest;
  }
}

TEST(EightBits, BrighterPixelsAreWhiteAndEightBitsStay) {
  EXPECT_EQ(To8Bits(Values({5000}), 1023).at<uint8_t>(0), 255);
  const cv::Mat image(3, 4, CV_8UC3, cv::Scalar(1, 2, 3));
  EXPECT_EQ(cv::norm(To8Bits(image, 1023), image, cv::NORM_INF), 0.0);
}

TEST(EightBits, GreyIsThatOfAPngInColour) {
  cv::Mat image(31, 47, CV_8UC3);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  std::vector<uint8_t> png;
  cv::imencode(".png", image, png);
  EXPECT_EQ(cv::norm(GreyLikePng(image, 2), cv::imdecode(png, cv::IMREAD_GRAYSCALE), cv::NORM_INF),
            0.0);
}

cv::Mat Ramp(int type) {
  cv::Mat image(48, 64, type);
  for (int y = 0; y < image.rows; ++y) {
    image.row(y).setTo(cv::Scalar::all(5 * y));
  }
  return image;
}

TEST(ImageFile, DepthIsReadExactly) {
  const TemporaryFolder folder;
  cv::Mat depth = Ramp(CV_16UC1);
  depth.at<uint16_t>(3, 4) = 65535;
  const cv::Mat read = ReadDepthImage(folder.Write("d.png", EncodeImage(depth, ".png")));
  ASSERT_EQ(read.type(), CV_16UC1);
  EXPECT_EQ(cv::norm(read, depth, cv::NORM_INF), 0.0);
}

TEST(ImageFile, ColourBecomesLuma) {
  const TemporaryFolder folder;
  const cv::Mat green(48, 64, CV_8UC3, cv::Scalar(0, 255, 0));
  for (const char* const extension : {".png", ".jpg"}) {
    const cv::Mat grey =
        ReadGreyImage(folder.Write(std::string("g") + extension, EncodeImage(green, extension)));
    ASSERT_EQ(grey.type(), CV_8UC1);
    EXPECT_NEAR(grey.at<uint8_t>(20, 20), 0.587 * 255.0, 2.0) << extension;
  }
}

TEST(ImageFile, ColourIsKept) {
  const TemporaryFolder folder;
  const cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(10, 200, 90));
  const cv::Mat read = ReadColourImage(folder.Write("c.png", EncodeImage(colour, ".png")));
  ASSERT_EQ(read.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(read, colour, cv::NORM_INF), 0.0);
  const cv::Mat grey = ReadColourImage(folder.Write("g.png", EncodeImage(Ramp(CV_8UC1), ".png")));
  EXPECT_EQ(grey.at<cv::Vec3b>(10, 5), cv::Vec3b(50, 50, 50));
  ExpectInputError(
      [&] { ReadColourImage(folder.Write("16.png", EncodeImage(Ramp(CV_16UC3), ".png"))); },
      {"16.png", "16 bits per channel"});
}

TEST(ImageFile, OnlySixteenBitDepthIsAccepted) {
  const TemporaryFolder folder;
  const auto eight = folder.Write("8.png", EncodeImage(Ramp(CV_8UC1), ".png"));
  ExpectInputError([&] { ReadDepthImage(eight); },
                   {"8.png", "1 channel(s) of 8 bits", "one channel of 16 bits"});
  const auto colour = folder.Write("c.png", EncodeImage(Ramp(CV_16UC3), ".png"));
  ExpectInputError([&] { ReadDepthImage(colour); }, {"c.png", "3 channel(s) of 16 bits"});
}

TEST(ImageFile, APaletteIsNamed) {
  const TemporaryFolder folder;
  const std::string png(
      "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00"
      "\x00\x01\x01\x03\x00\x00\x00\xce\xec\xed\xc9\x00\x00\x00\x06\x50\x4c\x54\x45\x00\x00\x00"
      "\xff\x00\x00\x1b\xff\x8d\x22\x00\x00\x00\x0a\x49\x44\x41\x54\x78\x9c\x63\x70\x00\x00\x00"
      "\x42\x00\x41\x29\x37\xf4\xef\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
      85);
  ExpectInputError([&] { ReadDepthImage(folder.Write("p.png", png)); },
                   {"p.png: is a PNG with a palette of colours, expected a depth image"});
}

TEST(ImageFile, GreyImagesHave8Bits) {
  const TemporaryFolder folder;
  const auto write = [&](int type) {
    return folder.Write("a.png", EncodeImage(cv::Mat(2, 3, type, cv::Scalar::all(90)), ".png"));
  };
  EXPECT_EQ(ReadGreyImage(write(CV_8UC1)).at<uint8_t>(1, 2), 90);
  EXPECT_EQ(ReadGreyImage(write(CV_8UC3)).at<uint8_t>(1, 2), 90);
  for (const int type : {CV_16UC1, CV_16UC3}) {
    const auto path = write(type);
    ExpectInputError([&] { ReadGreyImage(path); }, {"a.png: has 16 bits per channel", "8 bits"});
  }
}

TEST(ImageFile, EveryTruncationIsFound) {
  const TemporaryFolder folder;
  const cv::Mat noise(48, 64, CV_8UC1);
  cv::randu(noise, 0, 255);
  for (const char* const extension : {".png", ".jpg"}) {
    const std::string bytes = EncodeImage(noise, extension);
    const std::string_view whole = bytes;
    for (size_t size = 4; size < whole.size(); size += 97) {
      const auto path = folder.Write("cut", whole.substr(0, size));
      EXPECT_THROW(ReadGreyImage(path), InputError) << extension << ' ' << size;
    }
    const auto path = folder.Write("cut", whole.substr(0, whole.size() - 1));
    ExpectInputError([&] { ReadGreyImage(path); }, {"cut: is cut off"});
  }
}

// Motion photos of phones have a film behind the image.
TEST(ImageFile, AJpegMayHaveAnythingBehindItsEnd) {
  const TemporaryFolder folder;
  const std::string jpeg = EncodeImage(Ramp(CV_8UC1), ".jpg");
  const auto path = folder.Write("film.jpg", jpeg + "\xff ftypmp42" + std::string(200'000, 'x'));
  EXPECT_EQ(ReadGreyImage(path).size(), cv::Size(64, 48));
}

// Cameras of 10 to 14 bits write their values into 16 bits. The upper 8 of these are nearly black.
TEST(ImageFile, TheBitsOfTheCameraAreReadIfItsBrightestValueIsKnown) {
  const TemporaryFolder folder;
  cv::Mat image = Ramp(CV_8UC1);
  cv::Mat twelve;
  image.convertTo(twelve, CV_16U, 16.0);
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{twelve, twelve / 2, twelve / 4}, colour);
  const auto grey_file = folder.Write("grey.png", EncodeImage(twelve, ".png"));
  const auto colour_file = folder.Write("colour.png", EncodeImage(colour, ".png"));
  EXPECT_EQ(cv::norm(ReadGreyImage(grey_file, 4095), image, cv::NORM_INF), 0.0);
  std::vector<cv::Mat> channels;
  cv::split(ReadColourImage(grey_file, 4095), channels);
  EXPECT_EQ(cv::norm(channels[2], image, cv::NORM_INF), 0.0);
  cv::split(ReadColourImage(colour_file, 4095), channels);
  EXPECT_EQ(cv::norm(channels[0], image, cv::NORM_INF), 0.0);
  EXPECT_LE(cv::norm(channels[2], image / 4, cv::NORM_INF), 1.0);
  EXPECT_EQ(ReadGreyImage(colour_file, 4095).type(), CV_8UC1);
  const auto eight = folder.Write("eight.png", EncodeImage(image, ".png"));
  EXPECT_EQ(cv::norm(ReadGreyImage(eight, 4095), image, cv::NORM_INF), 0.0);
}

TEST(ImageFile, TheBrightestValueIsThatOfAllImages) {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> images;
  for (int i = 0; i < 200; ++i) {
    cv::Mat image(4, 5, CV_16UC1, cv::Scalar(100));
    image.at<uint16_t>(2, 3) = static_cast<uint16_t>(500 + i);
    images.push_back(folder.Write(std::to_string(i) + ".png", EncodeImage(image, ".png")));
  }
  const int brightest = BrightestOf(images);
  EXPECT_GT(brightest, 500 + 190) << "images at the end are read too";
  EXPECT_EQ(BrightestOf(std::span(images).subspan(7, 3)), 509);
  folder.Write("8.png", "broken");
  EXPECT_EQ(BrightestOf(std::span(images).subspan(7, 3)), 509);
  folder.Write("7.png", EncodeImage(Ramp(CV_8UC1), ".png"));
  EXPECT_EQ(BrightestOf(std::span(images).subspan(7, 3)), 65'535) << "images of 8 bits";
  EXPECT_EQ(BrightestOf(std::span<const std::filesystem::path>()), 65'535);
}

// A cut image may have a thumbnail with an end marker of its own.
TEST(ImageFile, TheEndOfAThumbnailIsNotThatOfTheJpeg) {
  const TemporaryFolder folder;
  const std::string jpeg = EncodeImage(Ramp(CV_8UC1), ".jpg");
  std::string cut = jpeg.substr(0, jpeg.size() - 2);
  cut.insert(2, "\xff\xe1" + std::string("\0\x08", 2) + "Exi\xff\xd9!");
  ExpectInputError([&] { ReadGreyImage(folder.Write("cut.jpg", cut)); }, {"cut.jpg: is cut off"});
}

TEST(ImageFile, BrokenFilesAreReportedByName) {
  const TemporaryFolder folder;
  ExpectInputError([&] { ReadGreyImage(folder.Write("empty.png", "")); },
                   {"empty.png", "is empty"});
  ExpectInputError([&] { ReadGreyImage(folder.Write("text.png", "hello")); },
                   {"text.png", "neither a PNG nor a JPEG"});
  ExpectInputError([&] { ReadDepthImage(folder.path() / "none.png"); }, {"none.png", "No such"});
  std::string flipped = EncodeImage(Ramp(CV_16UC1), ".png");
  flipped[flipped.size() / 2] = static_cast<char>(~flipped[flipped.size() / 2]);
  ExpectInputError([&] { ReadDepthImage(folder.Write("flipped.png", flipped)); },
                   {"flipped.png", "is broken"});
}

TEST(ImageFile, AHugeSizeIsRefusedBeforeMemoryIsAllocated) {
  const TemporaryFolder folder;
  std::string png = EncodeImage(Ramp(CV_8UC1), ".png");
  png[16] = 0x7f;  // the highest byte of the width
  boost::crc_32_type checksum;
  checksum.process_bytes(png.data() + 12, 17);
  for (size_t i = 0; i < 4; ++i) {
    png[29 + i] = static_cast<char>(checksum.checksum() >> (24 - 8 * i));
  }
  ExpectInputError([&] { ReadGreyImage(folder.Write("huge.png", png)); },
                   {"huge.png", "million px"});
  std::string jpeg = EncodeImage(Ramp(CV_8UC1), ".jpg");
  const size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, "\xea\x60\xea\x60");
  ExpectInputError([&] { ReadGreyImage(folder.Write("huge.jpg", jpeg)); },
                   {"huge.jpg", "60000x60000 px"});
}

TEST(ImageFile, ALongRowOrColumnIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.Write("a.png", EncodeImage(cv::Mat(70'000, 1, CV_8UC1), ".png"));
  ExpectInputError([&] { ReadGreyImage(path); },
                   {"a.png: has a size of 1x70000 px, expected up to 64 million px, and up to "
                    "65535 on a side"});
}

// The size of the file is checked before its content is read.
TEST(ImageFile, AHugeFileIsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  const auto path = folder.Write("sparse.png", "\x89PNG");
  std::filesystem::resize_file(path, 100'000'000'000);
  ExpectInputError([&] { ReadGreyImage(path); },
                   {"sparse.png: 100000000000 bytes, expected at most 512 MB"});
}

TEST(ImageFile, FillBytesBeforeTheMarkersOfAJpegAreAccepted) {
  const TemporaryFolder folder;
  std::string jpeg = EncodeImage(Ramp(CV_8UC1), ".jpg");
  const size_t frame = jpeg.find("\xff\xc0");
  jpeg.insert(frame, 3, '\xff');
  jpeg.insert(2, 2, '\xff');
  EXPECT_EQ(ReadGreyImage(folder.Write("fill.jpg", jpeg)).size(), cv::Size(64, 48));
}

// Bytes that the decoder skips may look like a header; the size that is checked is that of the
// image.
TEST(ImageFile, TheSizeOfAJpegIsTheOneThatIsDecoded) {
  const TemporaryFolder folder;
  std::string jpeg = EncodeImage(Ramp(CV_8UC1), ".jpg");
  const size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  const std::string decoy("\x01\xc0\x00\x0b\x08\x00\x10\x00\x10\x01\x01\x11\x00", 13);
  jpeg.replace(frame + 5, 4, "\x7f\xff\x7f\xff");
  jpeg.insert(frame, decoy);
  ExpectInputError([&] { ReadGreyImage(folder.Write("decoy.jpg", jpeg)); },
                   {"decoy.jpg", "32767x32767 px"});
}

TEST(ImageFile, APngWithoutHeaderIsRefused) {
  const TemporaryFolder folder;
  const std::string png = EncodeImage(Ramp(CV_8UC1), ".png");
  const std::string end = png.substr(png.size() - 12);
  ExpectInputError([&] { ReadGreyImage(folder.Write("end.png", png.substr(0, 8) + end)); },
                   {"end.png", "is broken"});
}

}  // namespace

}  // namespace hullslam
