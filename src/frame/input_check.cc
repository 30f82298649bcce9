// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/input_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "hullslam/util/error.h"
#include "util/order_statistics.h"

namespace hullslam {
namespace {

// ---- depth images

// The usual range of indoor sensors, m.
constexpr double kUsuallyNearest = 0.3;
constexpr double kUsuallyFarthest = 5.0;
// m. Hardly any depth camera sees so far, but values in millimetres or in units of 1/5000 m are
// larger.
constexpr double kBeyondAll = 200.0;
constexpr double kNearShare = 0.1;  // this share of the values is nearer than any sky behind

// The value below which this share of the known values of a depth image are; 0 if none is known.
template <typename Value>
double Quantile(const cv::Mat& depth, double share) {
  std::vector<Value> known;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* const row = depth.ptr<Value>(y);
    std::copy_if(row, row + depth.cols, std::back_inserter(known), [](Value value) {
      return value > Value(0) && std::isfinite(static_cast<double>(value));
    });
  }
  if (known.empty()) {
    return 0.0;
  }
  const auto place =
      known.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(known.size() - 1));
  std::nth_element(known.begin(), place, known.end());
  return static_cast<double>(*place);
}

// ---- pairs

constexpr size_t kFirstPairs = 3;     // that are all compared, and whose faults end the run
constexpr size_t kStride = 5;         // of the later ones one in five is compared,
constexpr size_t kMostCompared = 60;  // up to this number: a minute of a slow camera
// Depths that a pair can measure at all: those of endoscopes, and of ships and aircraft.
constexpr double kNearestPair = 0.03;    // m
constexpr double kFarthestPair = 500.0;  // m
// Baselines that cameras have, m: those of endoscopes, and of cars.
constexpr double kShortest = 0.01;
constexpr double kLongest = 3.0;
// Pairs in which most points are in other rows, while the median of all pairs is right: so many of
// them, and at least so large a share, are no chance.
constexpr size_t kFewestOff = 4;
constexpr double kShareOff = 0.2;

// Of the size of an image. Lenses are mounted better than that, but images of half the size with
// the calibration of the whole ones have it at their border.
constexpr double kMostFromMiddle = 0.3;

}  // namespace

InputCheck::InputCheck(const Sensor& sensor, const DepthOptions& depth)
    : sensor_(sensor), depth_(depth) {
  const double baseline = sensor.camera.bf / sensor.camera.fx;
  if (sensor.kind == SensorKind::kStereo && (baseline < kShortest || baseline > kLongest)) {
    Warn(fmt::format(
        "the baseline is {:.3g} m, expected {} to {} m; Camera.bf is the baseline in metres times "
        "Camera.fx, and the translation between two cameras is in metres",
        baseline, kShortest, kLongest));
  }
  const PinholeCamera& camera = sensor.camera;
  const auto is_central = [](double place, int size) {
    return std::abs(place / size - 0.5) <= kMostFromMiddle;
  };
  if (camera.width > 0 && camera.height > 0 &&
      !(is_central(camera.cx, camera.width) && is_central(camera.cy, camera.height))) {
    Warn(fmt::format(
        "the principal point ({:.0f}, {:.0f}) is far from the middle of images of {}x{} px; were "
        "the images resized after the calibration?",
        camera.cx, camera.cy, camera.width, camera.height));
  }
}

void InputCheck::CheckDepth(const cv::Mat& depth) {
  const bool is_in_metres = depth.type() == CV_32FC1;
  if (has_depth_ || depth.empty() || (!is_in_metres && depth.type() != CV_16UC1)) {
    return;
  }
  constexpr double kHalf = 0.5;
  const double unit = is_in_metres ? 1.0 : depth_.units_per_metre;
  const auto quantile = [&](double share) {
    return (is_in_metres ? Quantile<float>(depth, share) : Quantile<uint16_t>(depth, share)) / unit;
  };
  const double median = quantile(kHalf);
  if (median == 0.0) {
    return;  // the camera may see nothing yet
  }
  if (is_in_metres && quantile(kNearShare) > kBeyondAll) {
    throw InputError(fmt::format(
        "the depth image is float32, which is in metres, but its median is {:g}; expected metres: "
        "divide it by its units per metre (--float-units of a recording), or give 16 bits, which "
        "are in units of 1 / DepthMapFactor",
        median));
  }
  has_depth_ = true;
  if (median < kUsuallyNearest || median > kUsuallyFarthest) {
    Warn(
        fmt::format("the median depth of the first depth image is {:.3g} m {}, expected {} to {} "
                    "m; is {} right?",
                    median,
                    is_in_metres ? std::string("in its own unit")
                                 : fmt::format("with DepthMapFactor {:g}", unit),
                    kUsuallyNearest, kUsuallyFarthest,
                    is_in_metres ? "its unit (--float-units of a recording)" : "DepthMapFactor"));
  }
}

void InputCheck::CheckPair(const ExtractedFeatures& left, const ExtractedFeatures& right,
                           std::span<const float> depths) {
  const size_t number = pairs_++;
  if (compared_ >= kMostCompared || (useful_ >= kFirstPairs && number % kStride != 0)) {
    return;
  }
  ++compared_;
  const PairCheck::PairRows rows = pair_check_.Add(left, right, sensor_.camera.height);
  if (rows.matches < PairCheck::kFewestMatches) {
    return;
  }
  if (++useful_ <= kFirstPairs) {
    if (const auto fault = pair_check_.FindFault()) {
      --useful_;  // a refused frame changes nothing: the next one is refused, too
      throw InputError(*fault);
    }
    std::copy_if(depths.begin(), depths.end(), std::back_inserter(depths_),
                 [](float depth) { return depth > 0.0F; });
    if (useful_ == kFirstPairs) {
      CheckDepthsOfPairs();
    }
  }
  off_ += 2 * rows.off > rows.matches ? 1 : 0;
  if (!is_late_ && off_ >= kFewestOff &&
      static_cast<double>(off_) >= kShareOff * static_cast<double>(useful_)) {
    is_late_ = true;
    Warn(fmt::format(
        "in {} of {} pairs most points are in other rows of the right image than of the left one, "
        "though not in all pairs: are both images taken at the same time? A right image that is "
        "earlier or later makes depths wrong while the camera moves",
        off_, useful_));
  }
}

// Depths are proportional to the baseline.
void InputCheck::CheckDepthsOfPairs() {
  if (depths_.empty()) {
    return;
  }
  const double median = static_cast<double>(Median(std::move(depths_)));
  depths_.clear();
  if (median < kNearestPair || median > kFarthestPair) {
    Warn(fmt::format(
        "the median depth of the first pairs is {:.3g} m, with a baseline of {:.3g} m; is the "
        "baseline right?",
        median, sensor_.camera.bf / sensor_.camera.fx));
  }
}

std::vector<std::string> InputCheck::warnings() const {
  const std::lock_guard lock(mutex_);
  return warnings_;
}

void InputCheck::Warn(std::string warning) {
  const std::lock_guard lock(mutex_);
  warnings_.push_back(std::move(warning));
}

}  // namespace hullslam
