// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/segmentation/segmenter.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>

#include "support/expect_error.h"
#include "support/made_network.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

// Two blobs, each inside a cell of 32 px.
cv::Mat TwoBlobs() {
  cv::Mat image = GreyImage(128, 96);
  PaintBlob({36, 36, 24, 24}, true, image);
  PaintBlob({100, 4, 20, 24}, false, image);
  return image;
}

// Expects the outline to have the edges of the rectangle, in pixels with integer centres.
void ExpectRectangle(const InstanceMask& mask, const cv::Rect& expected, double tolerance) {
  ASSERT_EQ(mask.outlines.size(), 1U);
  Eigen::AlignedBox<double, 2> box;
  for (const Eigen::Vector2d& point : mask.outlines.front()) {
    box.extend(point);
  }
  EXPECT_NEAR(box.min().x(), expected.x - 0.5, tolerance);
  EXPECT_NEAR(box.min().y(), expected.y - 0.5, tolerance);
  EXPECT_NEAR(box.max().x(), expected.x + expected.width - 0.5, tolerance);
  EXPECT_NEAR(box.max().y(), expected.y + expected.height - 0.5, tolerance);
}

class SegmenterTest : public testing::Test {
 protected:
  std::filesystem::path Write(const MadeNetwork& network) const {
    return folder_.Write("network.onnx", network.Bytes());
  }

  TemporaryFolder folder_;
};

TEST_F(SegmenterTest, FindsTheColouredBlobsWithTheirOutlines) {
  Segmenter segmenter(Write({}));
  const std::vector<InstanceMask> masks = segmenter.Segment(TwoBlobs());
  ASSERT_EQ(masks.size(), 2U);
  EXPECT_EQ(masks[0].label, "red");  // the larger one has the higher score
  EXPECT_EQ(masks[1].label, "blue");
  EXPECT_GT(masks[0].score, masks[1].score);
  ExpectRectangle(masks[0], {36, 36, 24, 24}, 1e-9);
  ExpectRectangle(masks[1], {100, 4, 20, 24}, 1e-9);
  EXPECT_TRUE(segmenter.Segment(GreyImage(128, 96)).empty());
}

TEST_F(SegmenterTest, OutlinesAreThoseOfTheStoredPixelsForImagesOfAnySize) {
  Segmenter segmenter(Write({.size = {0, 0}}), {.size = 128});
  cv::Mat large;
  cv::resize(TwoBlobs()(cv::Rect(0, 0, 128, 75)), large, {512, 300}, 0, 0, cv::INTER_NEAREST);
  const std::vector<InstanceMask> masks = segmenter.Segment(large);
  ASSERT_EQ(masks.size(), 2U);
  // The input has 96 rows for 75, so the image is 10 rows lower in it than here and its cells are
  // others. A prototype has 16 px of this image.
  ExpectRectangle(masks[0], {144, 144, 96, 96}, 6.0);
}

TEST_F(SegmenterTest, TheSameImageGivesTheSameBitsWithAnyNumberOfThreads) {
  const auto network = Write({});
  const int threads = cv::getNumThreads();
  const std::vector<InstanceMask> one = Segmenter(network, {.threads = 1}).Segment(TwoBlobs());
  const std::vector<InstanceMask> two = Segmenter(network, {.threads = 2}).Segment(TwoBlobs());
  cv::setNumThreads(threads);
  ASSERT_EQ(one.size(), two.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].score, two[i].score);
    EXPECT_EQ(one[i].outlines, two[i].outlines);
  }
}

TEST_F(SegmenterTest, GivesOnlyTheInstancesThatAreAskedFor) {
  const auto network = Write({});
  const std::vector<InstanceMask> blue =
      Segmenter(network, {.classes = {"blue"}}).Segment(TwoBlobs());
  ASSERT_EQ(blue.size(), 1U);
  EXPECT_EQ(blue[0].label, "blue");
  const std::vector<InstanceMask> sure =
      Segmenter(network, {.min_score = 0.995}).Segment(TwoBlobs());
  ASSERT_EQ(sure.size(), 1U);
  EXPECT_EQ(sure[0].label, "red");
  ExpectInputError([&] { Segmenter(network, {.classes = {"blu"}}); },
                   {"--classes", "'blu'", "did you mean 'blue'?"});
  ExpectInputError([&] { Segmenter(network, {.min_score = std::nan("")}); }, {"--min-score"});
}

TEST_F(SegmenterTest, NamesAreThoseOfTheUserOrOfTheFile) {
  const auto unnamed = Write({.names = ""});
  ExpectInputError([&] { Segmenter segmenter(unnamed); },
                   {"network.onnx", "2 classes without names", "--names"});
  const auto names = folder_.Write("names.txt", "cup\ntv\n");
  EXPECT_EQ(Segmenter(unnamed, {.names = names}).class_names(),
            (std::vector<std::string>{"cup", "tv"}));
  const auto three = folder_.Write("three.txt", "cup\ntv\nbook\n");
  ExpectInputError([&] { Segmenter(unnamed, {.names = three}); },
                   {"2 classes", "3 names of classes"});
}

TEST_F(SegmenterTest, BoxesAreUsedOnlyIfAsked) {
  const auto network = Write({.has_masks = false});
  ExpectInputError([&] { Segmenter segmenter(network); }, {"finds boxes, no masks", "--boxes"});
  const std::vector<InstanceMask> boxes =
      Segmenter(network, {.use_boxes = true}).Segment(TwoBlobs());
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[0].shape, MaskShape::kBox);
  ExpectRectangle(boxes[0], {16, 16, 64, 64}, 1e-3);
  ExpectRectangle(boxes[1], {80, 0, 48, 48}, 1e-3);  // cut at the border
}

TEST_F(SegmenterTest, AnImageThatTheNetworkFailsOnDoesNotChangeOthers) {
  // The images have not the size of the input, which is what a network may refuse.
  const cv::Mat image = TwoBlobs()(cv::Rect(0, 0, 128, 64)).clone();
  const std::vector<InstanceMask> expected = Segmenter(Write({})).Segment(image);
  ASSERT_EQ(expected.size(), 2U);
  Segmenter segmenter(Write({.overflows_on_white = true}));
  const cv::Mat white(64, 128, CV_8UC3, cv::Scalar::all(255));
  for (int i = 0; i < 2; ++i) {
    ExpectInputError([&] { segmenter.Segment(white); }, {"network.onnx", "'head0'", "not finite"});
    const std::vector<InstanceMask> masks = segmenter.Segment(image);
    ASSERT_EQ(masks.size(), expected.size());
    for (size_t k = 0; k < masks.size(); ++k) {
      EXPECT_EQ(masks[k].outlines, expected[k].outlines);
    }
  }
}

TEST_F(SegmenterTest, RefusesWhatIsNoNetworkForSegmentation) {
  const std::string bytes = MadeNetwork().Bytes();
  ExpectInputError([&] { Segmenter segmenter(folder_.path() / "none.onnx"); }, {"none.onnx"});
  for (const auto& [content, fault] : std::vector<std::pair<std::string, std::string>>{
           {"", "is empty"},
           {"layers: 3\n", "is a text"},
           {"PK\3\4weights", "PyTorch"},
           {bytes.substr(0, bytes.size() / 2), "cut off"},
           {MadeNetwork{.is_classifier = true}.Bytes(), "classify whole images"},
           {MadeNetwork{.bias = std::numeric_limits<float>::quiet_NaN()}.Bytes(), "not finite"},
           {MadeNetwork{.weights_file = "weights.bin"}.Bytes(), "weights.bin"}}) {
    const auto file = folder_.Write("bad.onnx", content);
    ExpectInputError([&] { Segmenter segmenter(file); }, {"bad.onnx", fault, "expected"});
  }
}

// The processes that run networks for this one.
std::vector<pid_t> NetworkProcesses() {
  std::vector<pid_t> processes;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream stream(entry.path() / "stat");
    std::string name;
    char state = 0;
    pid_t process = 0;
    pid_t parent = 0;
    if (stream >> process >> name >> state >> parent && parent == ::getpid() &&
        name.starts_with("(hullslam_net")) {
      processes.push_back(process);
    }
  }
  return processes;
}

TEST_F(SegmenterTest, AnImageWithWhichOpencvCrashesIsAnErrorAndOthersGoOn) {
  Segmenter segmenter(Write({}));
  const std::vector<InstanceMask> expected = segmenter.Segment(TwoBlobs());
  const std::vector<pid_t> processes = NetworkProcesses();
  ASSERT_EQ(processes.size(), 1U);
  ::kill(processes[0], SIGABRT);  // AddressSanitizer would catch SIGSEGV
  ExpectInputError([&] { segmenter.Segment(TwoBlobs()); },
                   {"network.onnx", "OpenCV", "crashed (Aborted)", "expected"});
  const std::vector<InstanceMask> again = segmenter.Segment(TwoBlobs());
  ASSERT_EQ(again.size(), expected.size());
  EXPECT_EQ(again[0].outlines, expected[0].outlines);
}

TEST_F(SegmenterTest, TheProcessOfANetworkEndsWithIt) {
  { const Segmenter segmenter(Write({})); }
  EXPECT_TRUE(NetworkProcesses().empty());
  EXPECT_THROW(Segmenter(Write({.is_classifier = true})), InputError);
  EXPECT_TRUE(NetworkProcesses().empty());
}

// OpenCV writes over its own memory with some of these; that is no reason to end this process.
TEST_F(SegmenterTest, HostileNetworksAreErrors) {
  for (const int axis : {4, 5, 6, 7, -5, -8}) {
    const auto file = folder_.Write("bad.onnx", MadeNetwork{.gather_axis = axis}.Bytes());
    ExpectInputError([&] { Segmenter segmenter(file); }, {"bad.onnx", "expected"});
  }
}

TEST_F(SegmenterTest, TheHashIsThatOfTheFile) {
  const std::string first = Segmenter(Write({})).network_hash();
  EXPECT_EQ(first.size(), 16U);
  EXPECT_EQ(Segmenter(folder_.Write("other.onnx", MadeNetwork().Bytes())).network_hash(), first);
  EXPECT_NE(Segmenter(Write({.bias = 1.0F})).network_hash(), first);
}

TEST_F(SegmenterTest, NamesThatWouldShiftOthersAreRefused) {
  for (const char* const names : {"{0: 'cup\\nbook', 1: 'tv'}", "{0: 'cup\xff', 1: 'tv'}",
                                  "{0: 'cup', 1: 'cup'}", "red and blue"}) {
    const auto network = Write({.names = names});
    ExpectInputError([&] { Segmenter segmenter(network); }, {"network.onnx", "names", "--names"});
    EXPECT_EQ(Segmenter(network, {.names = folder_.Write("n.txt", "cup\ntv\n")}).class_names()[1],
              "tv");
  }
}

// Runs the network whose weights may not be shipped.
TEST(RealNetwork, FindsTheDeskOfFreiburg1) {
  const auto network = FindTestData("models/yolov8n-seg_raw_640x480.onnx");
  if (!network) {
    GTEST_SKIP() << "the network is not here";
  }
  Segmenter segmenter(*network, {.min_score = 0.5});
  EXPECT_EQ(segmenter.class_names().size(), 80U);
  EXPECT_TRUE(segmenter.Segment(GreyImage(640, 480)).empty());
  EXPECT_TRUE(segmenter.Segment(GreyImage(1226, 370)).empty());  // another shape
}

}  // namespace
}  // namespace hullslam
