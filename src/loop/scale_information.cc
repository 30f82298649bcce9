// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/scale_information.h"

#include <Eigen/Core>
#include <algorithm>

namespace hullslam {
namespace {

constexpr double kLeastInformation = 1e-6;  // radians^2: that of one landmark with 1 mrad parallax
constexpr double kLeastVariance = 1e-9;

// The sum of the squared deviations of the rays of a group of keyframes from their mean.
class SumOfSquaredDeviations {
 public:
  void Add(const Eigen::Vector3d& ray) {
    sum_ += ray;
    ++count_;
  }
  double Get() const {
    return count_ > 0.0 ? std::max(0.0, count_ - sum_.squaredNorm() / count_) : 0.0;
  }

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double count_ = 0.0;
};

// The information of a landmark about the ratio of two scales: the scale of the keyframes up to
// `before` over that of the keyframes from `after` on.
double InformationOf(const Map& map, const Landmark& landmark, KeyframeId before,
                     KeyframeId after) {
  SumOfSquaredDeviations older;
  SumOfSquaredDeviations newer;
  for (const Observation& seen : landmark.observations) {
    const Rigid3& pose = map.keyframes().At(seen.keyframe).cam_from_world;
    const Eigen::Vector3d ray = (landmark.position - Inverse(pose).translation).normalized();
    if (seen.keyframe <= before) {
      older.Add(ray);
    }
    if (seen.keyframe >= after) {
      newer.Add(ray);
    }
  }
  const double sum = older.Get() + newer.Get();
  return sum > 0.0 ? older.Get() * newer.Get() / sum : 0.0;
}

bool IsSeenBy(const Landmark& landmark, KeyframeId keyframe) {
  return std::any_of(landmark.observations.begin(), landmark.observations.end(),
                     [&](const Observation& seen) { return seen.keyframe == keyframe; });
}

}  // namespace

// The information of the landmarks that both keyframes show.
double ScaleInformation::Shared(KeyframeId older, KeyframeId newer) const {
  double information = 0.0;
  for (const LandmarkId id : map_.keyframes().At(older).landmarks) {
    if (id.IsValid() && IsSeenBy(map_.landmarks().At(id), newer)) {
      information += InformationOf(map_, map_.landmarks().At(id), older, newer);
    }
  }
  return information;
}

ScaleInformation::ScaleInformation(const Map& map, const std::vector<KeyframeId>& keyframes)
    : map_(map), keyframes_(keyframes) {
  double sum = 0.0;
  for (size_t i = 0; i < keyframes.size(); ++i) {
    // The first and the last keyframe have no parallax on one side.
    const bool is_inside = i > 0 && i + 1 < keyframes.size();
    const double half =
        is_inside ? 0.5 / std::max(Shared(keyframes[i], keyframes[i]), kLeastInformation) : 0.0;
    variances_.push_back(sum + half);
    sum += 2.0 * half;
  }
}

double ScaleInformation::Between(size_t older, size_t newer) const {
  const double chain = 1.0 / std::max(variances_[newer] - variances_[older], kLeastVariance);
  return std::max(chain, Shared(keyframes_[older], keyframes_[newer]));
}

}  // namespace hullslam
