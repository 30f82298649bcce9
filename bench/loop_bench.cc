// SPDX-License-Identifier: GPL-3.0-or-later
// Precision and recall of loop detection, judged by true poses. Prints one line.
//
//   loop_bench SEQUENCE MAP
//
// MAP is of a run of SEQUENCE without loops: rgbd_tum --set loop.closing=false --save-map MAP.
// At each keyframe, from the last one to the first, a loop to the older ones is sought as in a run;
// then the keyframe is culled. There is something to find at a keyframe if an older one, to which
// covisibility does not connect it, was in truth at most 1 m and 30 degrees away. A loop is right
// if it places the two keyframes to each other as they were, to 0.1 m.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/eval/ate.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "loop/loop_candidates.h"
#include "loop/loop_closer.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

struct Counts {
  size_t keyframes = 0;
  size_t revisits = 0;        // keyframes at which there is something to find
  size_t found_revisits = 0;  // those of them at which a loop was found
  size_t found = 0;
  size_t right = 0;
};

std::optional<Rigid3> TruePose(const Map& map, KeyframeId keyframe, const Trajectory& truth) {
  constexpr double kMaxGap = 0.1;  // s
  return InterpolatePose(truth, map.keyframes().At(keyframe).frame->timestamp, kMaxGap);
}

bool AreNear(const Rigid3& a, const Rigid3& b) {
  return (a.translation - b.translation).norm() < 1.0 &&
         a.rotation.angularDistance(b.rotation) < 30.0 * std::numbers::pi / 180.0;
}

bool IsRevisit(const Map& map, KeyframeId query, const Trajectory& truth) {
  const std::optional<Rigid3> here = TruePose(map, query, truth);
  const IdSet<KeyframeId> connected = ConnectedTo(map, query);
  for (const auto& [id, keyframe] : map.keyframes()) {
    const std::optional<Rigid3> there = TruePose(map, id, truth);
    if (!connected.Contains(id) && here && there && AreNear(*here, *there)) {
      return true;
    }
  }
  return false;
}

Sim3 CorrectedPose(const MapCorrection& correction, KeyframeId keyframe) {
  return std::find_if(correction.poses.begin(), correction.poses.end(),
                      [&](const auto& pose) { return pose.keyframe == keyframe; })
      ->corrected_cam_from_world;
}

bool IsRight(const Map& map, const MapCorrection& correction, const Trajectory& truth) {
  const auto [a, b] = correction.loop.value();
  const Rigid3 true_a_from_b =
      Inverse(TruePose(map, a, truth).value()) * TruePose(map, b, truth).value();
  const Sim3 a_from_b = CorrectedPose(correction, a) * Inverse(CorrectedPose(correction, b));
  return (a_from_b.translation - true_a_from_b.translation).norm() < 0.1;
}

Counts Judge(Map map, const SystemOptions& options, const Trajectory& truth) {
  const Sensor sensor = MakeSensor(options);
  std::vector<KeyframeId> keyframes;
  for (const auto& [id, keyframe] : map.keyframes()) {
    keyframes.push_back(id);
  }
  Counts counts;
  for (const KeyframeId query : std::views::reverse(keyframes)) {
    const bool is_revisit = IsRevisit(map, query, truth);
    LoopCloser closer(sensor, options.loop, options.objects, options.seed);
    const std::optional<MapCorrection> correction = closer.Process({map.Snapshot(), query});
    ++counts.keyframes;
    counts.revisits += is_revisit ? 1 : 0;
    if (correction) {
      ++counts.found;
      counts.found_revisits += is_revisit ? 1 : 0;
      counts.right += IsRight(map, *correction, truth) ? 1 : 0;
    }
    if (query != keyframes.front()) {
      map.CullKeyframe(query);
    }
  }
  return counts;
}

int Run(const std::string& folder, const std::string& map_file) {
  const ImageSequence sequence = OpenTumSequence(folder);
  SystemOptions options = ReadSettings(FindDefaultSettings(folder, FindConfigFolder()), {});
  options.vocabulary = std::make_shared<const Vocabulary>(ReadVocabulary(FindDefaultVocabulary()));
  Map map = ReadMap(map_file, options);
  const Counts counts = Judge(std::move(map), options, ReadGroundtruth(sequence).value());
  const auto percent = [](size_t part, size_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<size_t>(whole, 1));
  };
  fmt::print("{}: {} keyframes, {} revisits; {} loops found, precision {:.0f} %, recall {:.0f} %\n",
             folder, counts.keyframes, counts.revisits, counts.found,
             percent(counts.right, counts.found), percent(counts.found_revisits, counts.revisits));
  return 0;
}

}  // namespace
}  // namespace hullslam

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: loop_bench SEQUENCE MAP\n");
    return 2;
  }
  try {
    return hullslam::Run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
