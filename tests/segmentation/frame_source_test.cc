// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/frame_source.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "support/expect_error.h"
#include "support/made_network.h"
#include "support/plane_sequence.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr int kSourceFrames = 5;
constexpr int kBadFrame = 3;

// Frames with masks in files that change after they were checked.
class FrameSourceTest : public testing::Test {
 protected:
  FrameSourceTest()
      : sequence_(OpenTumSequence(plane_.path())),
        options_(ReadSettings(plane_.path() / "camera.yaml")),
        system_(options_, PipelineKind::kSequential) {}

  // Writes the masks of all frames; `name` has a place for the number of the frame.
  void WriteMasks(const std::string& name, const std::string& content) const {
    for (int i = 0; i < kSourceFrames; ++i) {
      folder_.Write("masks/" + fmt::format(fmt::runtime(name), i), content);
    }
  }

  SequenceMasks Open(const std::string& format, const std::string& file = "") const {
    return {{folder_.path() / "masks" / file, format, 640, 480}, MaskFrames(sequence_)};
  }

  // Expects the frames before the bad one with a detection each, then an error with these parts.
  void ExpectErrorAfterFrames(const SequenceMasks& masks, const std::vector<std::string>& parts) {
    FrameSource source(Pace::kFast, sequence_, options_.camera, masks, system_);
    for (int i = 0; i < kBadFrame; ++i) {
      const std::optional<LoadedFrame> loaded = source.Next();
      ASSERT_TRUE(loaded && loaded->frame);
      EXPECT_EQ(loaded->frame->frame->detections.size(), 1U);
    }
    ExpectInputError([&] { source.Next(); }, parts);
  }

  const PlaneSequence plane_{kSourceFrames};
  const TemporaryFolder folder_;
  const ImageSequence sequence_;
  const SystemOptions options_;
  System system_;
};

TEST_F(FrameSourceTest, MasksThatBecomeUnreadableAreAnErrorAfterTheFramesBefore) {
  cv::Mat labels(480, 640, CV_8UC1, cv::Scalar(0));
  labels(cv::Rect(200, 200, 100, 100)).setTo(1);
  std::vector<uchar> png;
  cv::imencode(".png", labels, png);
  const std::string shapes =
      R"({"imageWidth": 640, "imageHeight": 480, "shapes": [{"label": "cup", "shape_type":
      "polygon", "points": [[200, 200], [300, 200], [300, 300], [200, 300]]}]})";
  for (const auto& [format, name, content] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"yolo-seg", "{:02}.txt", "41 0.3 0.4 0.5 0.4 0.5 0.6 0.3 0.6 0.9\n"},
           {"boxes", "{:02}.txt", "41 200 200 100 100 0.9\n"},
           {"paper", "{:06}.txt", "0 1 41 0.9 200 200 300 200 300 300 200 300\n"},
           {"json", "{:02}.json", shapes},
           {"label-png", "{:02}.png", std::string(png.begin(), png.end())}}) {
    std::filesystem::remove_all(folder_.path() / "masks");
    WriteMasks(name, content);
    if (format == "label-png") {
      folder_.Write("masks/classes.json", R"({"1": "cup"})");
    }
    const SequenceMasks masks = Open(format);
    const std::string bad = fmt::format(fmt::runtime(name), kBadFrame);
    folder_.Write("masks/" + bad, "broken");
    ExpectErrorAfterFrames(masks, {bad});
  }
}

TEST_F(FrameSourceTest, VectorsThatBecomeUnreadableAreAnError) {
  WriteMasks("{:02}.txt", "41 0.3 0.4 0.5 0.4 0.5 0.6 0.3 0.6 0.9\n");
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }";
  header.resize(117, ' ');
  const float values[] = {1.0F, 2.0F};
  std::string npy = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + '\n';
  npy.append(reinterpret_cast<const char*>(values), sizeof(values));
  WriteMasks("{:02}.npy", npy);
  const SequenceMasks masks = Open("yolo-seg");
  folder_.Write("masks/03.npy", "broken");
  ExpectErrorAfterFrames(masks, {"03.npy"});
}

// These files are read as a whole before the first frame.
TEST_F(FrameSourceTest, AFileWithAllMasksMayChangeLater) {
  nlohmann::json coco = nlohmann::json::array();
  nlohmann::json boxes = nlohmann::json::array();
  for (int i = 0; i < kSourceFrames; ++i) {
    const std::string name = fmt::format("{:02}.png", i);
    coco.push_back({{"image_id", fmt::format("{:02}", i)},
                    {"category_id", 47},
                    {"score", 0.9},
                    {"segmentation", {{200, 200, 300, 200, 300, 300, 200, 300}}}});
    boxes.push_back(
        {{"file_name", name},
         {"detections",
          {{{"category_id", 41}, {"detection_score", 0.9}, {"bbox", {200, 200, 300, 300}}}}}});
  }
  for (const auto& [format, content] :
       {std::pair("coco", coco.dump()), std::pair("oa-slam", boxes.dump())}) {
    folder_.Write("masks/all.json", content);
    const SequenceMasks masks = Open(format, "all.json");
    folder_.Write("masks/all.json", "broken");
    FrameSource source(Pace::kFast, sequence_, options_.camera, masks, system_);
    for (int i = 0; i < kSourceFrames; ++i) {
      const std::optional<LoadedFrame> loaded = source.Next();
      ASSERT_TRUE(loaded && loaded->frame);
      EXPECT_EQ(loaded->frame->frame->detections.size(), 1U) << format;
    }
    EXPECT_FALSE(source.Next());
  }
}

TEST_F(FrameSourceTest, AFrameThatTheNetworkFailsOnSaysSoAndOthersGoOn) {
  const cv::Mat white(480, 640, CV_8UC3, cv::Scalar::all(255));
  cv::imwrite((plane_.path() / "rgb/03.png").string(), white);
  const auto network =
      folder_.Write("network.onnx", MadeNetwork{.overflows_on_white = true}.Bytes());
  for (const size_t every : {1, 2}) {
    const SequenceMasks masks(std::make_unique<NetworkMasks>(network, SegmenterOptions(), every,
                                                             sequence_, options_.camera),
                              MaskFrames(sequence_));
    FrameSource source(Pace::kFast, sequence_, options_.camera, masks, system_);
    for (int i = 0; i < kSourceFrames; ++i) {
      const std::optional<LoadedFrame> loaded = source.Next();
      ASSERT_TRUE(loaded && loaded->frame);
      EXPECT_EQ(loaded->has_unknown_masks, every == 1 && i == kBadFrame);
      EXPECT_EQ(loaded->colour.empty(), every == 1 || i % 2 == 0);
    }
    EXPECT_EQ(masks.network()->work().failures, every == 1 ? 1U : 0U);
  }
}

TEST_F(FrameSourceTest, AnImageThatCannotBeReadIsReportedInItsPlace) {
  folder_.Write("network.onnx", MadeNetwork().Bytes());
  std::ofstream(plane_.path() / "depth/03.png") << "broken";
  for (const bool has_network : {false, true}) {
    const SequenceMasks masks =
        has_network ? SequenceMasks(std::make_unique<NetworkMasks>(folder_.path() / "network.onnx",
                                                                   SegmenterOptions(), 0, sequence_,
                                                                   options_.camera),
                                    MaskFrames(sequence_))
                    : SequenceMasks(MaskRequest(), MaskFrames(sequence_));
    FrameSource source(Pace::kFast, sequence_, options_.camera, masks, system_);
    for (int i = 0; i < kSourceFrames; ++i) {
      const std::optional<LoadedFrame> loaded = source.Next();
      ASSERT_TRUE(loaded);
      EXPECT_EQ(loaded->frame.has_value(), i != kBadFrame);
      EXPECT_EQ(loaded->error.find("depth/03.png") != std::string::npos, i == kBadFrame);
    }
  }
}

}  // namespace
}  // namespace hullslam
