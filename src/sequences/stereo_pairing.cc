// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/stereo_pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hullslam/util/error.h"
#include "util/order_statistics.h"

namespace hullslam {
namespace {

// The camera may move by a twentieth of its way between two images, a pixel or two.
constexpr double kMostShare = 0.05;
constexpr double kMilliseconds = 1e3;  // per s

// The median of how much later the nearest right image is, s, over some of the left images.
double Delay(std::span<const double> left, std::span<const double> right) {
  std::vector<double> delays;
  for (const double stamp : left) {
    delays.push_back(right[NearestStamp(right, stamp)] - stamp);
  }
  return Median(std::move(delays));
}

// Two clocks with different rates: the delay changes from the begin to the end. It is only told
// from single late images by the median of several.
void CheckDrift(const std::string& origin, const StampedCamera& left, const StampedCamera& right,
                double most) {
  constexpr size_t kFewest = 10;
  const size_t count = std::max(kFewest, left.stamps.size() / 10);
  if (left.stamps.size() < 2 * count || right.stamps.empty()) {
    return;
  }
  const double at_begin = Delay(left.stamps.first(count), right.stamps);
  const double at_end = Delay(left.stamps.last(count), right.stamps);
  if (std::abs(at_end - at_begin) > most) {
    throw InputError(fmt::format(
        "{}: the stamps of {} and {} drift apart: the right images are {:.1f} ms later at the "
        "begin "
        "and {:.1f} ms later at the end, expected synchronised cameras",
        origin, left.name, right.name, kMilliseconds * at_begin, kMilliseconds * at_end));
  }
}

}  // namespace

std::vector<IndexPair> PairStereoStamps(const std::string& origin, const StampedCamera& left,
                                        const StampedCamera& right, double frames_per_second,
                                        std::vector<std::string>& warnings) {
  const double most = kMostShare / frames_per_second;
  CheckDrift(origin, left, right, most);
  const std::vector<IndexPair> pairs = PairStampsGreedily(left.stamps, right.stamps, most);
  const size_t count = left.stamps.size();
  if (2 * pairs.size() < count) {
    throw InputError(fmt::format(
        "{}: {} of {} images of {} have one of {} within {:.1f} ms, the smallest gap is {:.1f} ms; "
        "expected synchronised cameras",
        origin, pairs.size(), count, left.name, right.name, kMilliseconds * most,
        kMilliseconds * SmallestGap(left.stamps, right.stamps)));
  }
  if (pairs.size() < count || pairs.size() < right.stamps.size()) {
    warnings.push_back(fmt::format(
        "{}: {} of {} images of {} and {} of {} of {} have no partner within {:.1f} ms and are "
        "left "
        "out",
        origin, count - pairs.size(), count, left.name, right.stamps.size() - pairs.size(),
        right.stamps.size(), right.name, kMilliseconds * most));
  }
  return pairs;
}

}  // namespace hullslam
