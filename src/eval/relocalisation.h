// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/geometry/alignment.h"
#include "hullslam/geometry/rigid3.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/system/relocaliser.h"

namespace hullslam {

// Chooses up to `count` of the frames at random, each at most once. The result is increasing.
std::vector<size_t> ChooseQueries(std::vector<size_t> frames, size_t count, uint64_t seed);

// A frame that was looked for in a map.
struct QueryResult {
  std::optional<RelocalisedPose> found;
  double error = 0.0;         // m, of the position
  double turn_error = 0.0;    // degrees, of the rotation
  double view_angle = 0.0;    // degrees, from the nearest viewing direction of a keyframe
  double milliseconds = 0.0;  // without building the frame
};

// The queries with one outcome. The shares are those of all queries.
struct QuerySummary {
  std::string name;  // the method, "not found" or "all"
  size_t queries = 0;
  double near_percent = 0.0;  // found with an error of at most 5 cm
  double far_percent = 0.0;   // at most 10 cm
  size_t wrong = 0;           // found with a larger error
  double median_ms = 0.0;     // 0 without queries
  double max_ms = 0.0;
};

// One entry for each method, for the frames that were not found, and for all.
std::vector<QuerySummary> SummarizeQueries(std::span<const QueryResult> results);

// The transform from the world of a map to that of the true poses, with the scale of `by_points`.
// On a short way the positions leave a turn about the way open, so rotations count too: an error of
// one radian as one of 1 m.
PointAlignment AlignWithRotations(const Trajectory& truth, const Trajectory& estimate,
                                  const PointAlignment& by_points);

// Looks for a frame in the map of the relocaliser, whose world has this transform to that of the
// true pose.
QueryResult Relocalise(const Relocaliser& relocaliser, const Map& map, const Frame& frame,
                       const PointAlignment& truth_from_map, const Rigid3& true_world_from_cam);

// A query as a line of text, and two tables of all of them: by method, and by the angle from which
// the frame shows the scene (Zins et al. 2022, section 6.3). A pose within 10 cm and 5 degrees is
// right in the second one.
std::string DescribeQuery(const QueryResult& result);
std::string DescribeQueries(std::span<const QueryResult> results);

}  // namespace hullslam
