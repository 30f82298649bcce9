// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "map/islands.h"
#include "places/landmark_search.h"
#include "tracking/sources/confirmed_pose.h"
#include "tracking/sources/pose_source.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

// A pose with so many times the inliers of a relocalised frame is not compared with others.
constexpr int kEnough = 4;

// The poses that the matches of single keyframes and of all keyframes of an island give.
class WidePoses {
 public:
  WidePoses(const Frame& frame, const Map& map, const TrackingContext& context)
      : frame_(frame), map_(map), context_(context) {}

  void TryKeyframe(KeyframeId keyframe) {
    std::vector<FoundLandmark> matches = MatchLandmarksOf(map_, frame_, keyframe);
    Try(keyframe, matches);
    Pool& pool = pools_[IslandOf(map_, keyframe)];
    pool.nearest = pool.nearest.IsValid() ? pool.nearest : keyframe;
    pool.keyframes += matches.empty() ? 0 : 1;
    for (const FoundLandmark& match : matches) {
      if (pool.known.Insert(match.landmark)) {
        pool.matches.push_back(match);
      }
    }
  }
  // Where several images show a place from elsewhere, each of them gives few right matches, but all
  // of these agree, while wrong matches do not.
  void TryPlaces() {
    for (const auto& [island, pool] : pools_) {
      if (pool.keyframes > 1) {
        Try(pool.nearest, pool.matches);
      }
    }
  }
  bool IsSure() const {
    return best_ && best_->inliers >= kEnough * context_.min_relocalisation_inliers();
  }
  std::optional<PoseEstimate> TakeBest() { return std::move(best_); }

 private:
  struct Pool {
    KeyframeId nearest;
    size_t keyframes = 0;
    IdSet<LandmarkId> known;
    std::vector<FoundLandmark> matches;
  };

  void Try(KeyframeId keyframe, const std::vector<FoundLandmark>& matches) {
    const auto least = static_cast<int>(context_.min_reference_matches());
    std::optional<PoseEstimate> estimate = PoseOfMatches(
        frame_, map_, context_, matches, context_.min_reference_matches(), "wide matches");
    if (estimate && estimate->inliers >= least && (!best_ || estimate->inliers > best_->inliers)) {
      best_ = std::move(estimate);
      best_->keyframe_of_place = keyframe;
    }
  }

  const Frame& frame_;
  const Map& map_;
  const TrackingContext& context_;
  std::map<IslandId, Pool> pools_;
  std::optional<PoseEstimate> best_;
};

}  // namespace

std::optional<PoseEstimate> PoseByWideMatches(const Frame& frame, const Map& map,
                                              const TrackingContext& context,
                                              const LastFrame& /*last*/) {
  WidePoses poses(frame, map, context);
  for (const KeyframeId keyframe : KeyframesForWideMatches(map, frame)) {
    poses.TryKeyframe(keyframe);
    if (poses.IsSure()) {
      return poses.TakeBest();
    }
  }
  poses.TryPlaces();
  return poses.TakeBest();
}

}  // namespace hullslam
