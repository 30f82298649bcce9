// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/segmentation/late_masks.h"
#include "hullslam/system/system.h"

namespace hullslam::python {

// Throws InputError for a time stamp that is not finite, or too large to be in seconds.
void CheckStamp(double timestamp);

// A System for callers of any order: threads take turns, and a call that comes at the wrong time is
// an InputError. All functions are called without the GIL, unless they say otherwise.
// What a frame has beside its image; empty images are not given.
struct SecondImage {
  const cv::Mat& depth;
  const cv::Mat& right;
};

class LiveSystem {
 public:
  // Throws as System does.
  LiveSystem(const SystemOptions& options, PipelineKind kind, SystemStart start);
  ~LiveSystem();
  LiveSystem(const LiveSystem&) = delete;
  LiveSystem& operator=(const LiveSystem&) = delete;

  // Throws InputError after Finish() and for a time stamp that is not after the last one, and
  // otherwise as System::Track does. A refused frame changes nothing. `motion` is that from the
  // last frame, whose stamp is set here.
  FrameReport Track(double timestamp, const cv::Mat& image, const SecondImage& second,
                    std::vector<InstanceMask> masks, std::vector<InstanceMask> right_masks,
                    std::optional<MotionPrior> motion);
  // The warnings of the system that this function has not returned yet.
  std::vector<std::string> TakeWarnings();
  // `is_over` is asked from time to time whether to end early, see System::Finish.
  void Finish(const std::function<bool()>& is_over);
  void Reset();
  // Begins a new run, which goes on with another map.
  void Restart(SystemStart start);
  void SetLocalizationOnly(bool is_on);

  void AwaitMasks(bool is_on);
  // From now on `make` makes the masks of keyframes that are tracked without masks, up to Reset()
  // or Restart().
  void MakeMasks(LateMasks::Pace pace, LateMasks::Maker make);
  // Throws InputError after Finish(), and otherwise as System::AddMasks does.
  bool AddMasks(int64_t frame, std::vector<InstanceMask> masks);

  // Calls `edit(System&, ObjectId)`. Throws InputError after Finish() and for an id that is none.
  template <typename Function>
  void EditObject(int64_t object, const Function& edit) {
    const std::lock_guard lock(mutex_);
    System& system = Open();
    edit(system, IdOfObject(object));
  }

  // Calls `read(const System&)`.
  template <typename Read>
  auto Get(const Read& read) const {
    const std::lock_guard lock(mutex_);
    return read(const_cast<const System&>(Open()));
  }
  const SystemOptions& options() const { return options_; }

  // Ends the threads of all systems, which cannot be used any more. To be called with the GIL while
  // no other call runs.
  static void CloseAll();

 private:
  System& Open() const;
  ObjectId IdOfObject(int64_t object) const;
  void Begin(SystemStart start);

  const SystemOptions options_;
  const PipelineKind kind_;
  mutable std::mutex mutex_;        // guards the members below
  std::unique_ptr<System> system_;  // null after CloseAll()
  std::unique_ptr<LateMasks> late_masks_;
  FrameReport report_;  // of the frame that is being tracked
  std::optional<double> last_stamp_;
  size_t taken_warnings_ = 0;
  bool is_finished_ = false;
};

}  // namespace hullslam::python
