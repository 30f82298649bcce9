// SPDX-License-Identifier: GPL-3.0-or-later
#include "places/landmark_search.h"

#include <optional>

#include "frame/measure_point.h"
#include "map/landmark_projection.h"
#include "matching/by_descriptor.h"
#include "matching/by_projection.h"
#include "util/id_set.h"

namespace hullslam {
namespace {

constexpr float kRadius = 8.0f;    // px at level 0
constexpr int kMaxDistance = 100;  // Hamming
// The level of the vocabulary at which keypoints are compared. In a vocabulary with ten branches, a
// node of this level has about a hundred words; with fewer words, too many matches are lost.
constexpr int kNodeLevel = 2;

// With ten keyframes of each kind a frame takes some tenths of a second.
constexpr size_t kNearInTime = 10;
constexpr size_t kSimilar = 10;
// Between images that are far apart descriptors differ more than from one image of a video to the
// next. Geometry sorts out the matches that are wrong.
constexpr int kMaxWideDistance = 64;
constexpr double kMaxWideRatio = 0.8;

}  // namespace

std::vector<FoundLandmark> FindLandmarks(const Map& map, const Sensor& sensor, const Frame& frame,
                                         const Rigid3& cam_from_world,
                                         const std::vector<LandmarkId>& landmarks) {
  std::vector<Projection> projections;
  std::vector<LandmarkId> ids;
  std::vector<Eigen::Vector3d> points_in_cam;
  for (const LandmarkId id : landmarks) {
    const Landmark& landmark = map.landmarks().At(id);
    const std::optional<LandmarkProjection> view =
        ProjectLandmark(sensor, cam_from_world, landmark);
    if (!view) {
      continue;
    }
    Projection& projection = projections.emplace_back();
    projection.pixel = view->raw_pixel.cast<float>();
    projection.radius = kRadius * sensor.levels.scale[static_cast<size_t>(view->level)];
    projection.min_level = view->level - 1;
    projection.max_level = view->level;
    projection.descriptor = landmark.descriptor;
    ids.push_back(id);
    points_in_cam.push_back(view->point_in_cam);
  }
  const auto reprojects = [&](uint32_t query, uint32_t keypoint) {
    return IsInlier(sensor.camera,
                    MeasurePoint(sensor, frame.features, keypoint, sensor.depth_error),
                    points_in_cam[query]);
  };
  std::vector<FoundLandmark> found;
  for (const Match& match :
       MatchByProjection(frame.features, projections, {},
                         {.max_distance = kMaxDistance, .may_match = reprojects})) {
    found.push_back({match.keypoint, ids[match.query]});
  }
  return found;
}

std::vector<FoundLandmark> MatchLandmarksByWords(const Map& map, const Frame& frame,
                                                 KeyframeId keyframe,
                                                 const std::vector<uint8_t>& is_asked) {
  const Vocabulary& vocabulary = *map.vocabulary();
  const Keyframe& known = map.keyframes().At(keyframe);
  std::vector<VocabularyNodeId> asked = vocabulary.NodesOf(frame.words.get(), kNodeLevel);
  for (size_t i = 0; i < is_asked.size(); ++i) {
    if (is_asked[i] == 0) {
      asked[i] = VocabularyNodeId();
    }
  }
  std::vector<VocabularyNodeId> nodes = vocabulary.NodesOf(known.frame->words.get(), kNodeLevel);
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (!known.landmarks[i].IsValid()) {
      nodes[i] = VocabularyNodeId();
    }
  }
  std::vector<FoundLandmark> found;
  for (const Match& match : MatchByWords(frame.features, asked, known.frame->features, nodes, {})) {
    found.push_back({match.query, known.landmarks[match.keypoint]});
  }
  return found;
}

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
  if (map.vocabulary() != nullptr && !frame.words.is_absent()) {
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
