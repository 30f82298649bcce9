// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "live/live_inbox.h"
#include "live/live_map.h"
#include "live/live_picture.h"
#include "view/view_model.h"

namespace hullslam {

// The facts that stay the same during a run.
struct LiveRun {
  std::string title;
  std::string program;
  std::string sequence;
  std::string version;
  Sensor sensor;
  double start = 0.0;        // time stamp of the first frame, s
  size_t frame_count = 0;    // frames of the run
  Trajectory groundtruth;    // may be empty
  bool can_localise = true;  // whether the run may be switched to localisation only
};

// The present activity of the run.
enum class LivePhase { kRunning, kPaused, kFinishing, kEnded };

// The state of the controls on the page.
struct LiveControls {
  LivePhase phase = LivePhase::kRunning;
  bool is_localising = false;  // the map is fixed
  std::string notice = {};     // the result of the last command of a browser
};

// Makes the messages of the live view (docs/live_view.md) as JSON in one line each.
class LiveMessages {
 public:
  LiveMessages(LiveRun run, const LiveMapLimits& limits);

  // The state of the run, and the current frame with its image if there is one.
  std::string Frame(const LiveFrame* frame, const LiveControls& controls, double rate);
  // Follows the map and the path. Returns what has changed since the last call; nothing if there is
  // no difference. Without `is_limited`, all changes are made at once. If the run `is_at_rest`, in
  // a pause or at its end, objects get their boxes, and the errors are of the whole path; else they
  // follow it with some delay. The map of the state must not be null.
  std::optional<std::string> MapChange(const LiveState& state, bool is_limited,
                                       bool is_at_rest = false);
  // All that the calls of MapChange() have given so far.
  std::string Whole(const LiveControls& controls) const;
  // The content of summary.json, once the run has it.
  void SetSummary(nlohmann::json summary) { summary_ = std::move(summary); }

 private:
  // The parts of a message that is to be made.
  struct Parts {
    nlohmann::json set = nlohmann::json::object();
    nlohmann::json add = nlohmann::json::object();
    nlohmann::json patch = nlohmann::json::object();

    std::string Format() const;  // empty if there are none
  };

  bool FindBoxes(const std::shared_ptr<const Map>& map);
  ViewObject Shown(ObjectId id, const ObjectResult& object) const;
  void FollowPath(const LiveState& state, bool is_at_rest, Parts& parts);
  void FollowCounts(const LiveState& state, Parts& parts);
  void Align(bool is_at_rest, Parts& parts);
  ViewModel ModelOfRun() const;
  nlohmann::json SummaryPart() const;

  const LiveRun run_;
  LivePictures pictures_;
  LiveMap map_;
  std::shared_ptr<const Map> rested_;               // of which the boxes are
  std::map<ObjectId, SceneObject> bodies_ = {};     // without objects that were changed since
  nlohmann::json live_ = nlohmann::json::object();  // the parts of the last frame
  nlohmann::json image_;
  Trajectory path_;    // as the browsers have it
  ViewModel aligned_;  // ground truth, errors and the direction up, aligned to the path
  size_t path_thinnings_ = 0;
  uint32_t corrections_ = 0;
  size_t aligned_poses_ = 0;
  std::vector<LiveLoss> losses_;
  size_t loss_count_ = 0;
  size_t keyframe_count_ = 0;  // in the whole map
  nlohmann::json summary_;     // null until the run has it
};

}  // namespace hullslam
