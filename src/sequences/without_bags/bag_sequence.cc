// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/bag_sequence.h"

#include "util/components.h"

namespace hullslam {

BagSequence OpenBagSequence(const std::filesystem::path& path, const BagSequenceOptions&) {
  RequireComponent("BAGS", path.string() + " is a recording");
  return {};
}

std::vector<SensorKind> FindBagSensors(const std::filesystem::path& path) {
  RequireComponent("BAGS", path.string() + " is a recording");
  return {};
}

BagPairs OpenBagPairs(const std::filesystem::path& path, const BagSequenceOptions&,
                      std::shared_ptr<const StereoRectifier>) {
  RequireComponent("BAGS", path.string() + " is a recording");
  return {};
}

}  // namespace hullslam
