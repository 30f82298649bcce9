// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/util/id.h"
#include "report/object_results.h"
#include "results/ply_file.h"
#include "scene/scene.h"

namespace hullslam {

// The data that the page of the report and of the live view shows (docs/live_view.md). Each part is
// independent of the others, and an empty part is not shown. Positions are in the world frame of
// the map, in its unit of length. Time stamps are in seconds.

struct ViewLandmarks {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::array<uint8_t, 3>> colours;  // red, green, blue; one per position, or empty
  std::vector<double> created;  // time stamps at which they came into the map; likewise
  size_t total = 0;             // landmarks before they were thinned
};

struct ViewKeyframes {
  std::vector<uint32_t> ids;  // one per pose
  Trajectory poses;
};

// The distance of each paired pose from the true one, after the alignment.
struct ViewErrors {
  std::vector<double> timestamps;
  std::vector<double> metres;
};

// A closed line in an image, such as the outline of a mask.
struct ViewShape {
  ObjectId object;                      // invalid if it shows no object of the map
  std::string label;                    // the class
  std::vector<Eigen::Vector2d> points;  // px of the picture
};

struct ViewPicture {
  double timestamp = 0.0;
  std::string jpeg;
  int width = 0;  // px
  int height = 0;
  std::vector<ViewShape> outlines;  // of the masks
  std::vector<ViewShape> ellipses;  // the projected ellipsoids
};

struct ViewObject {
  ObjectResult object;
  std::string reason;                // why it is not mapped; empty if it is, or if unknown
  std::vector<ViewPicture> cutouts;  // the best views, the best one first
  std::optional<SceneObject> body = std::nullopt;  // its box and its free axes
};

// Pairs of ids of keyframes.
struct ViewEdges {
  using Edge = std::array<uint32_t, 2>;
  std::vector<Edge> covisibility;
  std::vector<Edge> loops;
};

// A setting whose value differs from the standard one.
struct ViewSetting {
  std::string key;
  std::string value;
  std::string standard;
};

struct ViewSettings {
  std::vector<ViewSetting> changed;
  std::string explanation;  // a sentence for the reader: what they are compared with
};

struct ViewModel {
  std::string title;
  std::string program;
  std::string sequence;
  std::string version;
  bool is_metric = true;              // false: the unit of length is not known in metres
  std::vector<std::string> notes;     // what was left out, and why
  std::optional<Eigen::Vector3d> up;  // unit
  std::optional<PinholeCamera> camera;
  ViewLandmarks landmarks;
  PlySurface surface;
  ViewKeyframes keyframes;
  Trajectory trajectory;   // the frames with a pose
  Trajectory groundtruth;  // aligned to the map
  ViewErrors errors;
  std::vector<ViewObject> objects;
  ViewEdges edges;
  std::vector<ViewPicture> pictures;  // in order of time
  std::optional<ViewSettings> settings;
  nlohmann::json summary;  // the content of summary.json, or null
  std::vector<Relation> relations;
  std::vector<ChangedObject> changes;  // of a run that went on with a map of earlier sessions
};

}  // namespace hullslam
