// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/guess_camera.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <optional>
#include <utility>

#include "calibration/recorded_camera.h"
#include "features/extractor.h"
#include "hullslam/util/error.h"
#include "matching/by_descriptor.h"
#include "system/make_sensor.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kFewestPoints = 60;

// A raw point from the middle of the image, undistorted, and its derivative by the raw one.
struct Undistorted {
  Eigen::Vector3d point;  // homogeneous
  Eigen::Matrix2d by_raw;
};

class Division {
 public:
  Division(double distortion, int width, int height)
      : distortion_(distortion),
        middle_(0.5 * (width - 1), 0.5 * (height - 1)),
        half_(0.5 * std::hypot(width, height)) {}

  Undistorted Of(const Eigen::Vector2d& raw) const {
    const Eigen::Vector2d from_middle = (raw - middle_) / half_;
    const double factor = 1.0 / (1.0 + distortion_ * from_middle.squaredNorm());
    const Eigen::Vector2d point = factor * from_middle;
    return {point.homogeneous(),
            (factor * Eigen::Matrix2d::Identity() -
             2.0 * distortion_ * factor * factor * from_middle * from_middle.transpose()) /
                half_};
  }
  double half() const { return half_; }

 private:
  double distortion_;
  Eigen::Vector2d middle_;
  double half_;
};

// The fundamental matrix of undistorted points. Null if there is none.
std::optional<Eigen::Matrix3d> FundamentalMatrix(const std::vector<Undistorted>& a,
                                                 const std::vector<Undistorted>& b,
                                                 double threshold) {
  std::vector<cv::Point2d> in_a;
  std::vector<cv::Point2d> in_b;
  for (size_t i = 0; i < a.size(); ++i) {
    in_a.emplace_back(a[i].point.x(), a[i].point.y());
    in_b.emplace_back(b[i].point.x(), b[i].point.y());
  }
  cv::UsacParams params;
  params.threshold = threshold;
  params.confidence = 0.999;
  params.maxIterations = 1000;
  params.loMethod = cv::LOCAL_OPTIM_INNER_LO;
  params.score = cv::SCORE_METHOD_MSAC;
  cv::Mat mask;
  const cv::Mat found = cv::findFundamentalMat(in_a, in_b, mask, params);
  if (found.rows != 3 || found.cols != 3) {
    return std::nullopt;
  }
  Eigen::Matrix3d fundamental;
  cv::cv2eigen(found, fundamental);
  return fundamental;
}

// The mean over the points of min(e^2, 1), with the error e of each (Sampson 1982) in `kInlier` raw
// pixels.
double CostOf(const DistortedPair& pair, const Division& division) {
  constexpr double kInlier = 1.0;  // px
  std::vector<Undistorted> a;
  std::vector<Undistorted> b;
  for (size_t i = 0; i < pair.a.size(); ++i) {
    a.push_back(division.Of(pair.a[i]));
    b.push_back(division.Of(pair.b[i]));
  }
  const auto fundamental = FundamentalMatrix(a, b, kInlier / division.half());
  double cost = 0.0;
  for (size_t i = 0; i < a.size() && fundamental; ++i) {
    const Eigen::Vector3d line_in_b = *fundamental * a[i].point;
    const Eigen::Vector3d line_in_a = fundamental->transpose() * b[i].point;
    const double error = b[i].point.dot(line_in_b);
    const double variance = (a[i].by_raw.transpose() * line_in_a.head<2>()).squaredNorm() +
                            (b[i].by_raw.transpose() * line_in_b.head<2>()).squaredNorm();
    cost += std::min(1.0, error * error / (kInlier * kInlier * variance));
  }
  return fundamental ? cost / static_cast<double>(a.size()) : 1.0;
}

// The features of an image; `undistorted` has raw pixels. Empty if it cannot be read.
FrameFeatures RawFeatures(const CameraRecording& recording, size_t frame,
                          const PinholeCamera& camera, FeatureExtractor& extractor) {
  FrameFeatures features;
  try {
    ExtractedFeatures extracted = extractor.Extract(recording.load(frame, camera).grey);
    for (const RawKeypoint& one : extracted.keypoints) {
      features.keypoints.push_back({one.raw, one.angle, one.level});
    }
    features.descriptors = std::move(extracted.descriptors);
  } catch (const InputError&) {
    return {};
  }
  return features;
}

DistortedPair Matched(const FrameFeatures& a, const FrameFeatures& b) {
  std::vector<uint32_t> all(a.size());
  std::iota(all.begin(), all.end(), 0U);
  DistortedPair pair;
  for (const Match& match : MatchByDescriptor(a, all, b, {.max_distance = 50, .max_ratio = 0.8})) {
    pair.a.push_back(a.keypoints[match.query].undistorted.cast<double>());
    pair.b.push_back(b.keypoints[match.keypoint].undistorted.cast<double>());
  }
  return pair;
}

double MedianWay(const DistortedPair& pair) {
  std::vector<double> ways;
  for (size_t i = 0; i < pair.a.size(); ++i) {
    ways.push_back((pair.b[i] - pair.a[i]).norm());
  }
  return ways.empty() ? 0.0 : Median(std::move(ways));
}

// Pairs of images all over the recording, as far apart as needed for the points to move by a tenth
// of the width of the image, at most a second of video.
std::vector<DistortedPair> PairsOf(const CameraRecording& recording, const SystemOptions& options) {
  constexpr size_t kMostPairs = 32;
  constexpr size_t kStep = 4;  // frames
  constexpr std::array<size_t, 5> kGaps = {1, 2, 3, 5, 7};
  constexpr size_t kFewestMatches = 100;
  FeatureExtractor extractor(options.features);
  std::map<size_t, FrameFeatures> known;
  const auto features_of = [&](size_t step) -> const FrameFeatures& {
    if (!known.contains(step)) {
      known[step] = RawFeatures(recording, kStep * step, options.camera, extractor);
    }
    return known[step];
  };
  const size_t steps = std::max(recording.frames / kStep, kGaps.back()) - kGaps.back();
  const size_t count = std::min(kMostPairs, steps / 2);
  std::vector<DistortedPair> pairs;
  for (size_t i = 0; i < count; ++i) {
    const size_t first = i * steps / count;
    std::erase_if(known, [&](const auto& one) { return one.first < first; });
    DistortedPair widest;
    for (const size_t gap : kGaps) {
      DistortedPair pair = Matched(features_of(first), features_of(first + gap));
      if (pair.a.size() < kFewestMatches) {
        break;
      }
      widest = std::move(pair);
      if (MedianWay(widest) > 0.1 * options.camera.width) {
        break;
      }
    }
    if (!widest.a.empty()) {
      pairs.push_back(std::move(widest));
    }
  }
  return pairs;
}

// How well a map fits, and the lens that fits it best.
struct Fit {
  double score = 0.0;
  PinholeCamera camera;
};

Fit FitOf(const CalibrationProblem& problem, const CameraModel& model) {
  auto parameters =
      ParametersOf(model, {.principal_point = false, .readout = false, .disparity = false},
                   problem.has_depth, 0.0);
  ExpectNear(model, parameters);
  CameraAdjustment adjustment(problem, model, std::move(parameters));
  adjustment.Solve({});
  // A wrong camera loses landmarks, and the errors of those that are left are larger.
  return {static_cast<double>(problem.CountObservations()) /
              std::max(1e-3, adjustment.AtMinimum().variance_factor),
          adjustment.model().camera};
}

}  // namespace

std::optional<double> RadialDistortionOf(std::span<const DistortedPair> pairs, int width,
                                         int height) {
  constexpr double kStep = 0.05;
  constexpr int kValues = 24;      // from -0.8
  constexpr double kLeast = -0.8;  // nearly a fisheye lens
  std::array<double, kValues> costs{};
  bool is_known = false;
  for (const DistortedPair& pair : pairs) {
    if (pair.a.size() < kFewestPoints) {
      continue;
    }
    is_known = true;
    for (int i = 0; i < kValues; ++i) {
      costs.at(static_cast<size_t>(i)) += CostOf(pair, Division(kLeast + kStep * i, width, height));
    }
  }
  if (!is_known) {
    return std::nullopt;
  }
  // A parabola through the costs near the least one, which smooths the chance of the samples.
  constexpr int kReach = 4;
  const auto best = static_cast<int>(std::ranges::min_element(costs) - costs.begin());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = std::max(0, best - kReach); i <= std::min(kValues - 1, best + kReach); ++i) {
    const double x = i - best;
    const Eigen::Vector3d row(1.0, x, x * x);
    normal += row * row.transpose();
    right += costs.at(static_cast<size_t>(i)) * row;
  }
  const Eigen::Vector3d parabola = normal.ldlt().solve(right);
  const double shift = parabola[2] > 0.0 ? -0.5 * parabola[1] / parabola[2] : 0.0;
  return kLeast + kStep * (best + std::clamp(shift, -1.0 * kReach, 1.0 * kReach));
}

void SetDivisionModel(double distortion, PinholeCamera& camera) {
  constexpr int kPoints = 20;
  const double half = 0.5 * std::hypot(camera.width, camera.height) / camera.fx;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int i = 1; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    const double distorted = share * half;
    const double undistorted = distorted / (1.0 + distortion * share * share);
    const double cube = undistorted * undistorted * undistorted;
    const Eigen::Vector2d row(cube, cube * undistorted * undistorted);
    normal += row * row.transpose();
    right += row * (distorted - undistorted);
  }
  const Eigen::Vector2d coefficients = normal.ldlt().solve(right);
  camera.k1 = coefficients[0];
  camera.k2 = coefficients[1];
}

PinholeCamera GuessCamera(SystemOptions options, const CameraRecording& recording,
                          const RecordedCalibrationOptions& calibration) {
  constexpr size_t kFrames = 150;
  constexpr double kDegree = std::numbers::pi / 180.0;
  options.readout_time = 0.0;
  options.depth.disparity_offset = 0.0;
  options.camera = {
      .width = options.camera.width, .height = options.camera.height, .bf = options.camera.bf};
  options.camera.cx = 0.5 * (options.camera.width - 1);
  options.camera.cy = 0.5 * (options.camera.height - 1);
  double distortion = 0.0;
  if (calibration.camera.choice.distortion) {
    distortion =
        RadialDistortionOf(PairsOf(recording, options), options.camera.width, options.camera.height)
            .value_or(0.0);
  }
  const size_t frames = std::min(kFrames, recording.frames);
  size_t done = 0;
  Fit best;
  constexpr std::array kFields = {45.0, 55.0, 65.0, 75.0, 87.0, 100.0};  // degrees
  for (const double field : kFields) {
    PinholeCamera& camera = options.camera;
    camera.fx = camera.fy = 0.5 * camera.width / std::tan(0.5 * field * kDegree);
    SetDivisionModel(distortion, camera);
    if (!camera.FindFault().empty()) {
      done += frames;
      continue;
    }
    const CalibrationProblem problem =
        RecordedProblem(options, recording, frames, calibration.cancellation, [&] {
          if (calibration.on_frame) {
            calibration.on_frame(0, ++done, kFields.size() * frames);
          }
        });
    if (IsRequested(calibration.cancellation)) {
      return camera;
    }
    if (!IsEnoughToCalibrate(problem)) {
      continue;
    }
    const Fit fit = FitOf(problem, ModelOf(MakeSensor(options), options.depth));
    best = fit.score > best.score ? fit : best;
  }
  if (best.score == 0.0) {
    throw InputError(
        "no map can be made of the first images with any field of view from 45 to 100 degrees, "
        "expected a camera that moves sideways past things at different distances");
  }
  return best.camera;
}

}  // namespace hullslam
