// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/stage_timer.h"
#include "loop/loop_closer.h"
#include "mapping/mapper.h"
#include "util/latest_worker.h"

namespace hullslam {

// The stages that follow the mapper. A pipeline runs them at once or in threads of their own. A
// stage that has found a correction sends it to the mapper as the next message.
class LoopStages {
 public:
  virtual ~LoopStages() = default;

  // Searches a loop at a new keyframe.
  virtual void Seek(LoopQuery query) = 0;
  // Adjusts the whole map. To be called with the map in which a loop was closed.
  virtual void Adjust(std::shared_ptr<const Map> corrected) = 0;
};

// Starts the stage that follows a message. To be called when the mapper has processed the message;
// `is_applied` is the result of Mapper::Process, and `published` is the newest published map. After
// a new keyframe a loop is sought (loop.enabled, and a vocabulary is needed). After a loop the
// whole map is adjusted (loop.global_adjustment). A loop that was dropped is sought again at the
// newest keyframe.
void StartNextStage(const MapMessage& message, bool is_applied, const SystemOptions& options,
                    Mapper& mapper, const std::shared_ptr<const Map>& published,
                    LoopStages& stages);

// Searches loops in one thread, and adjusts the whole map after a loop in another one.
class LoopThreads final : public LoopStages {
 public:
  // `sensor` must outlive this object. Both threads call `send` with corrections for the mapper.
  LoopThreads(const Sensor& sensor, const SystemOptions& options,
              std::function<void(MapCorrection)> send);
  ~LoopThreads() override;

  // A query that still waits is dropped.
  void Seek(LoopQuery query) override;
  // If the next loop is found before the end, the adjustment is cancelled.
  void Adjust(std::shared_ptr<const Map> corrected) override;

  // Waits until all queries are done. Also waits for the adjustment, or cancels it with
  // `give_up_adjustment`. Returns whether a correction was sent since the last call.
  bool Settle(bool give_up_adjustment);

  int busy_threads() const;
  StageTimes times() const;
  // Rethrows the exception of one of the threads, if there was one.
  void RethrowFailure() const;

 private:
  struct Adjustment {
    std::shared_ptr<const Map> map;
    std::shared_ptr<const Cancellation> cancellation;
  };
  void SeekNow(LoopQuery query);
  void AdjustNow(const Adjustment& adjustment);
  void Send(MapCorrection correction);
  void GiveUpAdjustment();

  const Sensor& sensor_;
  const SystemOptions options_;
  const std::function<void(MapCorrection)> send_;
  LoopCloser closer_;  // used by the first thread only

  mutable std::mutex mutex_;                    // guards the next three members
  std::shared_ptr<Cancellation> cancellation_;  // cancels the newest adjustment
  StageTimes times_;
  bool has_sent_ = false;

  LatestWorker<LoopQuery> seeker_;  // the last two members, because their threads use the others
  LatestWorker<Adjustment> adjuster_;
};

}  // namespace hullslam
