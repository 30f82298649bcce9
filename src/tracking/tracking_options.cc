// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/tracking/tracking_options.h"

namespace hullslam {

void TrackingOptions::Bind(OptionTable& options) {
  options.Add("tracking.lost_after_frames", &lost_after_frames, Range::AtLeast(1),
              "frames without a pose after which a run is given up");
}

}  // namespace hullslam
