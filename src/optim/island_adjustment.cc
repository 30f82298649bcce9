// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/island_adjustment.h"

#include <utility>

#include "optim/bundle_adjustment.h"

namespace hullslam {

IslandAdjustment AdjustIsland(const Map& map, IslandId island, const Sensor& sensor,
                              const ObjectOptions& options, const Cancellation* cancellation,
                              const ProgressCallback& on_progress) {
  BundleWindow window = GlobalWindow(map, island, ObjectsToAdjust(options));
  BundleResult result =
      AdjustBundle(map, sensor, window, BundleOptions{.objects = options.bundle}.ForWholeMap(),
                   cancellation, on_progress);
  return {.result = std::move(result), .objects = std::move(window.objects)};
}

}  // namespace hullslam
