// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/segmentation/late_masks.h"

#include <utility>

#include "util/latest_worker.h"
#include "util/task_runner.h"

namespace hullslam {

LateMasks::LateMasks(Pace pace, Maker make, System& system)
    : pace_(pace), make_(std::move(make)), system_(system) {
  system_.AwaitMasks(true);
  if (pace_ == Pace::kNeverWait) {
    worker_ = std::make_unique<LatestMaker<Picture, Made>>([this](const Picture& picture) {
      RunInBackground();  // tracking comes first
      return Made{picture.frame, make_(picture.image)};
    });
  }
}

LateMasks::~LateMasks() = default;

void LateMasks::AfterFrame(const TrackedFrame& frame, const cv::Mat& image) {
  if (image.empty()) {
    system_.AddMasks(frame.frame, {});  // if the network has found nothing
    return;
  }
  if (pace_ == Pace::kWait) {
    if (auto masks = IsKeyframe(frame.frame) ? make_(image) : std::nullopt) {
      system_.AddMasks(frame.frame, *std::move(masks));
    }
    return;
  }
  pictures_.push_back({frame.frame, frame.timestamp, image});
  while (frame.timestamp - pictures_.front().timestamp > System::kMaskPatience) {
    pictures_.pop_front();
  }
  AddMade();
  if (!worker_->IsBusy()) {
    BeginNext();
  }
}

void LateMasks::Finish() {
  if (worker_ != nullptr) {
    worker_->WaitUntilIdle();
    AddMade();
  }
}

bool LateMasks::IsKeyframe(FrameId frame) const {
  const auto map = system_.map();
  if (map == nullptr) {
    return false;
  }
  const auto keyframe = map->KeyframeOfFrame(frame);
  return keyframe && map->keyframes().Contains(*keyframe);
}

void LateMasks::AddMade() {
  for (Made& made : worker_->TakeResults()) {
    if (made.masks) {
      system_.AddMasks(made.frame, *std::move(made.masks));
    }
  }
}

void LateMasks::BeginNext() {
  for (auto picture = pictures_.rbegin(); picture != pictures_.rend(); ++picture) {
    if (IsKeyframe(picture->frame)) {
      worker_->Post(std::move(*picture));
      pictures_.erase(std::next(picture).base());
      return;
    }
  }
}

}  // namespace hullslam
