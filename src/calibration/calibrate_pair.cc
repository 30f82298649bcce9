// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/calibrate_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "calibration/determined.h"
#include "features/extractor.h"
#include "hullslam/util/error.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kMostMatchedPairs = 60;
constexpr int kMostBits = 50;
constexpr double kSecondBest = 0.8;
constexpr double kSigmasOfYaw = 4.0;  // by which it is certainly not 0

// The most similar of several descriptors, and how similar the next one is.
struct Best {
  int bits = std::numeric_limits<int>::max();
  int second = std::numeric_limits<int>::max();
  size_t index = 0;

  void Add(int other, size_t i) {
    if (other < bits) {
      second = bits;
      bits = other;
      index = i;
    } else {
      second = std::min(second, other);
    }
  }
  bool IsClear() const { return bits <= kMostBits && bits <= kSecondBest * second; }
};

// Matches of points that move by left - right from `least` to `most`, px.
std::vector<PairMatch> MatchFeatures(const ExtractedFeatures& left, const ExtractedFeatures& right,
                                     const ScaleLevels& levels, const Eigen::Vector2f& least,
                                     const Eigen::Vector2f& most) {
  std::vector<Best> of_left(left.keypoints.size());
  std::vector<Best> of_right(right.keypoints.size());
  for (size_t i = 0; i < of_left.size(); ++i) {
    const RawKeypoint& a = left.keypoints[i];
    for (size_t k = 0; k < of_right.size(); ++k) {
      const RawKeypoint& b = right.keypoints[k];
      const Eigen::Vector2f moved = a.raw - b.raw;
      if (std::abs(a.level - b.level) <= 1 && (moved.array() >= least.array()).all() &&
          (moved.array() <= most.array()).all()) {
        const int bits = HammingDistance(left.descriptors[i], right.descriptors[k]);
        of_left[i].Add(bits, k);
        of_right[k].Add(bits, i);
      }
    }
  }
  std::vector<PairMatch> matches;
  for (size_t i = 0; i < of_left.size(); ++i) {
    const Best& best = of_left[i];
    if (best.IsClear() && of_right[best.index].index == i) {
      const RawKeypoint& a = left.keypoints[i];
      const RawKeypoint& b = right.keypoints[best.index];
      const auto level = static_cast<size_t>(std::max(a.level, b.level));
      matches.push_back(
          {a.raw.cast<double>(), b.raw.cast<double>(), static_cast<double>(levels.scale[level])});
    }
  }
  return matches;
}

// Finds the features of the images of a pair and of the next left image.
class Matcher {
 public:
  explicit Matcher(const PinholeCamera& camera) : camera_(camera), extractor_(OptionsFor(camera)) {}

  std::vector<PairMatch> MatchPair(const cv::Mat& left, const cv::Mat& right) {
    constexpr double kMostAngle = 3.0 * std::numbers::pi / 180.0;
    constexpr double kMostRows = 20.0;
    const auto reach =
        static_cast<float>(kMostRows + kMostAngle * (camera_.fx + 0.5 * camera_.width));
    left_ = extractor_.Extract(left, runner_);
    // Things nearer than the baseline are not looked for.
    return MatchFeatures(left_, extractor_.Extract(right, runner_), extractor_.levels(),
                         {-reach, -reach}, {static_cast<float>(camera_.fx) + reach, reach});
  }

  // How much lower the points of the last left image are in the next one; null if few are found.
  std::optional<double> MovedDown(const cv::Mat& next) {
    constexpr size_t kFewest = 20;
    const float reach = 0.25F * static_cast<float>(camera_.width);
    std::vector<double> rows;
    for (const PairMatch& match :
         MatchFeatures(left_, extractor_.Extract(next, runner_), extractor_.levels(),
                       {-reach, -reach}, {reach, reach})) {
      rows.push_back(match.right.y() - match.left.y());
    }
    return rows.size() < kFewest ? std::nullopt : std::optional(Median(std::move(rows)));
  }

 private:
  static FeatureOptions OptionsFor(const PinholeCamera& camera) {
    FeatureOptions options;
    options.level_count = options.LevelsFor(camera.width, camera.height);
    options.feature_count = options.FeaturesFor(camera.width, camera.height);
    return options;
  }

  PinholeCamera camera_;
  FeatureExtractor extractor_;
  ParallelRunner runner_{0};
  ExtractedFeatures left_;
};

// The recordings with their images rectified; null: as they are.
std::vector<CameraRecording> Rectified(std::span<const CameraRecording> recordings,
                                       const std::shared_ptr<const StereoRectifier>& rectifier) {
  std::vector<CameraRecording> rectified(recordings.begin(), recordings.end());
  for (CameraRecording& one : rectified) {
    if (rectifier != nullptr) {
      one.load = [load = one.load, rectifier](size_t frame, const PinholeCamera& camera) {
        ImageInput pair = load(frame, camera);
        pair.grey = rectifier->Rectify(pair.grey, ImageSide::kLeft);
        pair.right = rectifier->Rectify(pair.right, ImageSide::kRight);
        return pair;
      };
    }
  }
  return rectified;
}

void RefuseLatePairs(const PairRows& rows) {
  if (rows.is_late) {
    throw InputError(
        fmt::format("the images of a pair do not belong together in time: the right ones seem to "
                    "be {:.2f} +- {:.2f} frames {} than the left ones, because their rows are "
                    "wrong by as much as the image moves; expected pairs taken at the same moment",
                    std::abs(rows.frames_late), rows.frames_late_sigma,
                    rows.frames_late > 0.0 ? "later" : "earlier"));
  }
}

// The calibration with other intrinsics of the rectified camera: both cameras as read change like
// it.
void ChangeLike(const PinholeCamera& before, const PinholeCamera& after, PinholeCamera& read) {
  const double x = read.fx / before.fx;
  const double y = read.fy / before.fy;
  read.cx += x * (after.cx - before.cx);
  read.cy += y * (after.cy - before.cy);
  read.fx = x * after.fx;
  read.fy = y * after.fy;
}

}  // namespace

std::vector<PairMatch> MatchAnywhere(const cv::Mat& left, const cv::Mat& right,
                                     const PinholeCamera& camera) {
  return Matcher(camera).MatchPair(left, right);
}

std::vector<MatchedPair> MatchPairs(std::span<const CameraRecording> recordings,
                                    const PinholeCamera& camera, const Cancellation* cancellation) {
  std::vector<MatchedPair> pairs;
  Matcher matcher(camera);
  for (const CameraRecording& recording : recordings) {
    const size_t count =
        std::min(std::max<size_t>(1, kMostMatchedPairs / recordings.size()), recording.frames);
    for (size_t i = 0; i < count && !IsRequested(cancellation); ++i) {
      const size_t frame = i * recording.frames / count;
      try {
        const ImageInput pair = recording.load(frame, camera);
        MatchedPair& matched = pairs.emplace_back();
        matched.matches = matcher.MatchPair(pair.grey, pair.right);
        if (frame + 1 < recording.frames) {
          matched.moved_down = matcher.MovedDown(recording.load(frame + 1, camera).grey);
        }
      } catch (const InputError&) {
        continue;  // as in a run
      }
    }
  }
  return IsRequested(cancellation) ? std::vector<MatchedPair>() : pairs;
}

PairEvidence TakeYaw(CameraCalibrationResult& result) {
  constexpr const char* kName = "disparity_offset";
  PairEvidence yaw;
  if (const ParameterEvidence* const offset = result.evidence.Find(kName)) {
    const PinholeCamera& camera = result.model.camera;
    yaw = {.value = YawOf(offset->value, camera),
           .sigma = std::abs(YawOf(offset->sigma, camera)),
           .is_determined =
               offset->IsDetermined() || std::abs(offset->value) > kSigmasOfYaw * offset->sigma};
  }
  std::erase_if(result.evidence.parameters,
                [](const ParameterEvidence& one) { return one.parameter.name == kName; });
  std::erase(result.calibrated, kName);
  result.model.disparity_offset = 0.0;
  return yaw;
}

StereoCalibration PairCalibration::Cameras(const StereoRectifier& rectifier) const {
  StereoCalibration cameras = deviation.AppliedTo(rectifier.calibration(), rectifier, given);
  const PinholeCamera& after = recorded.result.model.camera;
  ChangeLike(rectified, after, cameras.left);
  ChangeLike(rectified, after, cameras.right);
  cameras.left.bf = cameras.right_from_left.translation.norm() * cameras.left.fx;
  return cameras;
}

StereoCalibration RectifiedPair(const PinholeCamera& camera) {
  return {camera, camera, {Eigen::Quaterniond::Identity(), {-camera.bf / camera.fx, 0.0, 0.0}}};
}

PairCalibration CalibratePair(SystemOptions options, std::span<const CameraRecording> recordings,
                              RecordedCalibrationOptions calibration) {
  constexpr int kMostRounds = 4;
  constexpr double kLeastOffset = 0.1;  // px of disparity
  PairCalibration pair;
  pair.given = options.camera;
  calibration.camera.choice.disparity = true;
  const std::vector<MatchedPair> matched =
      MatchPairs(recordings, pair.given, calibration.cancellation);
  const StereoRectifier as_given(RectifiedPair(pair.given), "the pair");
  double yaw = 0.0;
  for (int round = 1; !IsRequested(calibration.cancellation); ++round) {
    pair.rows = FitPairRows(matched, pair.given, yaw);
    RefuseLatePairs(pair.rows);
    pair.deviation =
        pair.rows.is_changed ? pair.rows.found : PairDeviation{.turn = {0.0, yaw, 0.0}};
    pair.is_changed = pair.rows.is_changed || yaw != 0.0;
    std::shared_ptr<const StereoRectifier> rectifier;
    if (pair.is_changed) {
      rectifier = std::make_shared<const StereoRectifier>(
          pair.deviation.AppliedTo(as_given.calibration(), as_given, pair.given), "the pair");
    }
    options.camera = rectifier ? rectifier->camera() : pair.given;
    pair.rectified = options.camera;
    pair.recorded = CalibrateFromRecordings(options, Rectified(recordings, rectifier), calibration);
    if (IsRequested(calibration.cancellation)) {
      break;
    }
    const PairEvidence more = TakeYaw(pair.recorded.result);
    pair.yaw = {yaw + more.value, more.sigma, more.is_determined};
    const double least = kLeastOffset / pair.given.fx;
    // After the first change, what is left is followed until it is no more than chance.
    const double most = yaw == 0.0 ? std::max(least, kSigmasOfYaw * more.sigma) : more.sigma;
    if (!more.is_determined || std::abs(more.value) <= most || round == kMostRounds) {
      break;
    }
    yaw += more.value;
  }
  return pair;
}

}  // namespace hullslam
