// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/iteration_callback.h>

#include "hullslam/util/cancellation.h"

namespace hullslam::internal {

// Reports the progress of an optimisation by Ceres to the caller, and ends it when a cancellation
// is requested.
class Supervision final : public ceres::IterationCallback {
 public:
  // `cancellation` and `on_progress` may be null. `most`: the largest number of iterations.
  Supervision(const Cancellation* cancellation, const ProgressCallback& on_progress, int most)
      : cancellation_(cancellation), on_progress_(on_progress), most_(most) {}

  bool IsCancelled() const { return IsRequested(cancellation_); }
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (on_progress_ && summary.iteration > 0) {  // number 0 is the start
      on_progress_(++done_, most_);
    }
    return IsCancelled() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const Cancellation* cancellation_;
  const ProgressCallback& on_progress_;
  int most_;
  int done_ = 0;
};

}  // namespace hullslam::internal
