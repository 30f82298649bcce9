// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/bow/bow_vector.h"
#include "hullslam/features/feature_grid.h"
#include "hullslam/frame/depth_grid.h"
#include "hullslam/frame/detection.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/util/id.h"

namespace hullslam {

struct ShutterMotion;

// The words of the keypoints of a frame. They may be found when they are first asked for, because
// only keyframes and lost frames need them. Copies share them. All functions may be called by any
// number of threads.
class FrameWords {
 public:
  FrameWords() = default;  // none
  FrameWords(std::vector<WordId> words)
      : state_(words.empty() ? nullptr : std::make_shared<State>(std::move(words))) {}
  // `find` is called at most once, and its result is kept in place of what it captures.
  explicit FrameWords(std::function<std::vector<WordId>()> find)
      : state_(std::make_shared<State>(std::move(find))) {}

  const std::vector<WordId>& get() const {
    static const std::vector<WordId> kNone;
    if (state_ == nullptr) {
      return kNone;
    }
    std::call_once(state_->once, [this] {
      if (state_->find) {
        state_->words = std::exchange(state_->find, nullptr)();
      }
    });
    return state_->words;
  }
  bool empty() const { return get().empty(); }
  // The same as empty() for a frame with keypoints, but looks for no words.
  bool is_absent() const { return state_ == nullptr; }

 private:
  struct State {
    explicit State(std::vector<WordId> known) : words(std::move(known)) {}
    explicit State(std::function<std::vector<WordId>()> finder) : find(std::move(finder)) {}
    std::once_flag once;
    std::function<std::vector<WordId>()> find;
    std::vector<WordId> words;
  };
  std::shared_ptr<State> state_;
};

// The data extracted from one image. A frame does not change after it is built; the stages share
// it.
struct Frame {
  FrameId id;
  double timestamp = 0.0;  // seconds
  FrameFeatures features;
  FrameWords words;  // one per keypoint; empty without a vocabulary
  std::vector<Detection> detections;
  DepthGrid depth;           // empty without depth
  double depth_delay = 0.0;  // s, as in ImageInput
  std::optional<MotionPrior> motion;
  // How the keypoints were corrected for a rolling shutter (frame/rolling_shutter.h), for
  // detections that come later and for calibration. Null if they were not, and once there are
  // detections.
  std::shared_ptr<const ShutterMotion> shutter;
};

}  // namespace hullslam
