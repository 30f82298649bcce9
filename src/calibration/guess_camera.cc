// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/guess_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "calibration/distorted_pairs.h"
#include "calibration/map_problem.h"
#include "features/extractor.h"
#include "hullslam/util/error.h"
#include "matching/by_descriptor.h"
#include "system/make_sensor.h"
#include "util/median.h"

namespace hullslam {
namespace {

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
    if (!IsEnoughToCalibrate(problem) || IsRequested(calibration.cancellation)) {
      continue;
    }
    const Fit fit = FitOf(problem, ModelOf(MakeSensor(options), 0.0));
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
