// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/wide_matches.h"

#include "matching/by_descriptor.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

// With ten keyframes of each kind a frame takes some tenths of a second.
constexpr size_t kNearInTime = 10;
constexpr size_t kSimilar = 10;
// Between images that are far apart descriptors differ more than from one image of a video to the
// next. Geometry sorts out the matches that are wrong.
constexpr int kMaxWideDistance = 64;
constexpr double kMaxWideRatio = 0.8;

}  // namespace

std::vector<KeyframeId> KeyframesForWideMatches(const Map& map, const Frame& frame,
                                                IslandId left_out) {
  std::vector<KeyframeId> chosen;
  IdSet<KeyframeId> known;
  const auto add = [&](KeyframeId id, size_t most) {
    const Keyframe* const keyframe = map.keyframes().Find(id);
    const bool is_wanted = keyframe != nullptr && keyframe->island != left_out;
    if (chosen.size() < most && is_wanted && known.Insert(id)) {
      chosen.push_back(id);
    }
  };
  const CowTable<FrameId, KeyframeId>& by_frame = map.keyframes_by_frame();
  FrameId before = by_frame.Before(frame.id);
  FrameId after = by_frame.After(frame.id);
  while (chosen.size() < kNearInTime && (before.IsValid() || after.IsValid())) {
    if (before.IsValid()) {
      add(by_frame.At(before), kNearInTime);
      before = by_frame.Before(before);
    }
    if (after.IsValid()) {
      add(by_frame.At(after), kNearInTime);
      after = by_frame.After(after);
    }
  }
  if (map.vocabulary() != nullptr && !frame.words.empty()) {
    const size_t most = chosen.size() + kSimilar;
    for (const SimilarKeyframe& similar : map.index().Query(map.VectorOf(frame))) {
      add(similar.keyframe, most);
    }
  }
  return chosen;
}

std::vector<Match> MatchWidely(const FrameFeatures& queries, std::span<const uint32_t> indices,
                               const FrameFeatures& features) {
  return MatchByDescriptor(queries, indices, features,
                           {.max_distance = kMaxWideDistance, .max_ratio = kMaxWideRatio});
}

std::vector<FoundLandmark> MatchLandmarksOf(const Map& map, const Frame& frame, KeyframeId id) {
  const Keyframe& keyframe = map.keyframes().At(id);
  std::vector<FoundLandmark> found;
  for (const Match& match :
       MatchWidely(keyframe.frame->features, IndicesOfValid(keyframe.landmarks), frame.features)) {
    found.push_back({match.keypoint, keyframe.landmarks[match.query]});
  }
  return found;
}

}  // namespace hullslam
