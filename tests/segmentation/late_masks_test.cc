// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/segmentation/late_masks.h"

#include <gtest/gtest.h>

#include <vector>

#include "hullslam/segmentation/network_masks.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "support/made_network.h"
#include "support/plane_sequence.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

// A run whose images in colour show a red thing. The network sees them a fifth as large, so a cell
// has 160 px.
class LateMasksTest : public testing::Test {
 protected:
  LateMasksTest()
      : sequence_(OpenTumSequence(plane_.path())),
        options_(ReadSettings(plane_.path() / "camera.yaml")),
        network_(folder_.Write("network.onnx", MadeNetwork{.overflows_on_white = true}.Bytes()), {},
                 0, sequence_, options_.camera),
        system_(options_, PipelineKind::kSequential) {
    PaintBlob({180, 180, 120, 120}, true, colour_);
  }

  TrackedFrame Track(size_t frame) {
    return system_.Track(LoadFrame(sequence_.frames.at(frame), options_.camera));
  }

  size_t DetectionsOfFirstKeyframe() const {
    return system_.map()->keyframes().At(KeyframeId(0)).frame->detections.size();
  }

  const PlaneSequence plane_{4};
  const TemporaryFolder folder_;
  const ImageSequence sequence_;
  const SystemOptions options_;
  const NetworkMasks network_;
  const LateMasks::Maker make_ = [this](const cv::Mat& image) { return network_.Make(image); };
  System system_;
  cv::Mat colour_ = GreyImage(640, 480);
};

TEST_F(LateMasksTest, AKeyframeGetsThemAtOnceIfTheRunWaits) {
  LateMasks masks(LateMasks::Pace::kWait, make_, system_);
  masks.AfterFrame(Track(0), colour_);
  EXPECT_EQ(DetectionsOfFirstKeyframe(), 1U);
  masks.AfterFrame(Track(1), cv::Mat());  // its masks were made before
  masks.Finish();
  EXPECT_EQ(system_.object_counts().frames_with_masks, 1U);
}

TEST_F(LateMasksTest, AKeyframeGetsThemWhenTheyAreReadyInRealTime) {
  LateMasks masks(LateMasks::Pace::kNeverWait, make_, system_);
  masks.AfterFrame(Track(0), colour_);
  EXPECT_EQ(DetectionsOfFirstKeyframe(), 0U);
  masks.AfterFrame(Track(1), colour_);  // no keyframe
  masks.Finish();
  EXPECT_EQ(DetectionsOfFirstKeyframe(), 1U);
  EXPECT_EQ(system_.object_counts().frames_with_masks, 1U);
}

// Else the keyframe would say that there are no objects.
TEST_F(LateMasksTest, AKeyframeThatTheNetworkFailsOnGoesOnAwaitingMasks) {
  const cv::Mat white(480, 640, CV_8UC3, cv::Scalar::all(255));
  for (const auto pace : {LateMasks::Pace::kWait, LateMasks::Pace::kNeverWait}) {
    system_.Reset();
    LateMasks masks(pace, make_, system_);
    const TrackedFrame first = Track(0);
    masks.AfterFrame(first, white);
    masks.Finish();
    EXPECT_EQ(system_.object_counts().frames_with_masks, 0U);
    EXPECT_TRUE(system_.AddMasks(first.frame, network_.Make(colour_).value()));
    EXPECT_EQ(DetectionsOfFirstKeyframe(), 1U);
  }
  EXPECT_EQ(network_.work().failures, 2U);
}

// Masks that come more than two seconds late are of no use.
TEST_F(LateMasksTest, PicturesAreForgottenAfterTwoSeconds) {
  LateMasks masks(LateMasks::Pace::kNeverWait, make_, system_);
  const auto add = [&](uint32_t number, double timestamp, const cv::Mat& image) {
    TrackedFrame frame;  // no keyframe, so its picture waits
    frame.frame = FrameId(number);
    frame.timestamp = timestamp;
    masks.AfterFrame(frame, image);
  };
  std::vector<cv::Mat> images;
  for (uint32_t i = 0; i < 40; ++i) {
    images.push_back(colour_.clone());
    add(100 + i, 0.125 * i, images.back());
  }
  for (size_t i = 0; i < images.size(); ++i) {
    const bool is_kept = images[i].u->refcount > 1;
    EXPECT_EQ(is_kept, i >= 23) << i;  // the last one came at 4.875 s
  }
}

}  // namespace
}  // namespace hullslam
