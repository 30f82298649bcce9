// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/input_check.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "features/extractor.h"
#include "hullslam/util/error.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr int kMostBits = 50;        // of a match that counts here
constexpr double kSecondBest = 0.8;  // a match has at most this share of the bits of the next one
constexpr double kMostRows = 0.08;   // of the height; a pair that is set up badly is off by less
constexpr double kSame = 0.05;       // px; two copies of one image differ by less
// Calibrated pairs are off by a few tenths of a pixel. Matches are sought in rows that are two
// pixels away, so a pair that is off by more loses most of them.
constexpr double kMostRowDifference = 1.5;  // px
constexpr double kDoubtfulRows = 0.5;       // px

double MedianOf(std::vector<double> values) { return Median(std::move(values)); }

}  // namespace

PairCheck::PairRows PairCheck::Add(const cv::Mat& left, const cv::Mat& right) {
  FeatureExtractor extractor{FeatureOptions()};
  const ExtractedFeatures of_left = extractor.Extract(left);
  return Add(of_left, extractor.Extract(right), left.rows);
}

PairCheck::PairRows PairCheck::Add(const ExtractedFeatures& a, const ExtractedFeatures& b,
                                   int height) {
  const double most_rows = kMostRows * height;
  PairRows counts;
  for (size_t i = 0; i < a.keypoints.size(); ++i) {
    int best = kMostBits + 1;
    int second = 256;
    size_t found = 0;
    for (size_t k = 0; k < b.keypoints.size(); ++k) {
      const double rows = static_cast<double>(a.keypoints[i].raw.y() - b.keypoints[k].raw.y());
      if (std::abs(a.keypoints[i].level - b.keypoints[k].level) > 1 || std::abs(rows) > most_rows) {
        continue;
      }
      const int bits = HammingDistance(a.descriptors[i], b.descriptors[k]);
      if (bits < best) {
        second = best;
        best = bits;
        found = k;
      } else if (bits < second) {
        second = bits;
      }
    }
    if (best <= kMostBits && best <= kSecondBest * second) {
      const Eigen::Vector2d moved = (a.keypoints[i].raw - b.keypoints[found].raw).cast<double>();
      columns_.push_back(moved.x());
      rows_.push_back(moved.y());
      places_.emplace_back(a.keypoints[i].raw.x(), a.keypoints[i].raw.y(), 1.0);
      ++counts.matches;
      counts.off += std::abs(moved.y()) > kMostRowDifference ? 1 : 0;
    }
  }
  return counts;
}

std::optional<std::string> PairCheck::FindFault(bool need_rows) const {
  if (rows_.size() < kFewestMatches) {
    return std::nullopt;
  }
  const double column = MedianOf(columns_);
  const double row = MedianOf(rows_);
  if (std::abs(column) < kSame && std::abs(row) < kSame) {
    return "left and right show the same image, expected those of two cameras";
  }
  const auto to_the_right = static_cast<size_t>(
      std::count_if(columns_.begin(), columns_.end(), [](double moved) { return moved < -kSame; }));
  if (2 * to_the_right > columns_.size()) {
    return fmt::format(
        "{} of {} points lie farther right in the right image than in the left one: left and right "
        "are swapped",
        to_the_right, columns_.size());
  }
  if (need_rows && std::abs(row) > kMostRowDifference) {
    return fmt::format(
        "points lie {:.1f} px {} in the right image than in the left one (median of {}), expected "
        "equal rows: the calibration does not fit (`hullslam calibrate` finds how the right camera "
        "is turned), or the images are not rectified",
        std::abs(row), row > 0.0 ? "higher" : "lower", rows_.size());
  }
  return std::nullopt;
}

std::optional<std::string> PairCheck::FindDoubt() const {
  constexpr size_t kFewest = 100;
  constexpr int kIterations = 10;
  if (rows_.size() < kFewest) {
    return std::nullopt;
  }
  // Least squares with the loss of Cauchy, whose scale follows the errors.
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  std::vector<double> errors = rows_;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::vector<double> lengths;
    for (const double error : errors) {
      lengths.push_back(std::abs(error));
    }
    const double scale = 3.5 * std::max(kSame, MedianOf(std::move(lengths)));
    Eigen::Matrix3d hessian = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < rows_.size(); ++i) {
      const double weight = 1.0 / (1.0 + errors[i] * errors[i] / (scale * scale));
      hessian += weight * places_[i] * places_[i].transpose();
      gradient += weight * rows_[i] * places_[i];
    }
    plane = hessian.ldlt().solve(gradient);
    for (size_t i = 0; i < rows_.size(); ++i) {
      errors[i] = rows_[i] - plane.dot(places_[i]);
    }
  }
  std::vector<double> off;
  for (const Eigen::Vector3d& place : places_) {
    off.push_back(std::abs(plane.dot(place)));
  }
  const double median = MedianOf(std::move(off));
  return median < kDoubtfulRows
             ? std::nullopt
             : std::optional(fmt::format(
                   "the rows of points in the right image are wrong by {:.1f} px (median of {}); "
                   "`hullslam calibrate` finds how the right camera is turned",
                   median, rows_.size()));
}

namespace {

// ---- depth images

// The usual range of indoor sensors, m.
constexpr double kUsuallyNearest = 0.3;
constexpr double kUsuallyFarthest = 5.0;
// m. Hardly any depth camera sees so far, but values in mm or in units of 1/5000 m are larger.
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
