// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_messages.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "map/islands.h"
#include "system/compose_trajectory.h"
#include "util/lists.h"
#include "util/text.h"
#include "view/aligned_truth.h"
#include "view/view_message.h"
#include "view/view_of_map.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

constexpr size_t kPictureBytes = 26000;  // of a JPEG file
constexpr size_t kMostTruth = 1500;      // poses of the ground truth

const char* NameOf(LivePhase phase) {
  switch (phase) {
    case LivePhase::kPaused:
      return "paused";
    case LivePhase::kFinishing:
      return "finishing";
    case LivePhase::kEnded:
      return "ended";
    default:
      return "running";
  }
}

// Whether the frame was tracked in a part of the map that is not joined to the main one yet.
bool IsElsewhere(const LiveFrame& frame) {
  const auto& reference = frame.report.tracked.from_keyframe;
  return frame.map != nullptr && reference && frame.map->islands_begun() > 1 &&
         IslandOf(*frame.map, reference->reference) != MainIsland(*frame.map);
}

// Numbers in milliseconds and per second are shown with one digit.
double Rounded(double value) { return std::round(10.0 * value) / 10.0; }

// The columns [begin, begin + count) of rows that are `width` wide.
Json PackColumns(std::span<const float> values, size_t width, size_t begin, size_t count) {
  std::vector<float> columns;
  columns.reserve(values.size() / width * count);
  for (size_t row = 0; row < values.size(); row += width) {
    const auto first = values.begin() + static_cast<ptrdiff_t>(row + begin);
    columns.insert(columns.end(), first, first + static_cast<ptrdiff_t>(count));
  }
  return PackArray(columns);
}

Json LandmarkColumns(std::span<const float> values) {
  return {{"position", PackColumns(values, LiveMap::kLandmarkWidth, 0, 3)},
          {"age", PackColumns(values, LiveMap::kLandmarkWidth, 3, 1)}};
}

Json KeyframeColumns(std::span<const float> values) {
  return {{"time", PackColumns(values, LiveMap::kKeyframeWidth, 0, 1)},
          {"pose", PackColumns(values, LiveMap::kKeyframeWidth, 1, 7)}};
}

// The entry of "patch" for a table, with its columns.
Json PatchOf(const RowChange& change, Json columns) {
  columns["count"] = change.count;
  columns["at"] = PackArray(change.at);
  return columns;
}

}  // namespace

LiveMessages::LiveMessages(LiveRun run, const LiveMapLimits& limits)
    : run_(std::move(run)),
      pictures_(run_.sensor.camera, kPictureBytes),
      map_(run_.sensor, run_.start, limits) {}

std::string LiveMessages::Parts::Format() const {
  Json message = {{"view", kViewVersion}};
  const auto put = [&message](const char* name, const Json& parts) {
    if (!parts.empty()) {
      message[name] = parts;
    }
  };
  put("set", set);
  put("add", add);
  put("patch", patch);
  return message.size() > 1 ? DumpViewMessage(message) : std::string();
}

ViewModel LiveMessages::ModelOfRun() const {
  ViewModel model;
  model.title = run_.title;
  model.program = run_.program;
  model.sequence = run_.sequence;
  model.version = run_.version;
  model.is_metric = !run_.sensor.IsMonocular();
  return model;
}

std::string LiveMessages::Frame(const LiveFrame* frame, const LiveControls& controls, double rate) {
  Parts parts;
  if (frame != nullptr) {
    const TrackedFrame& tracked = frame->report.tracked;
    const LivePicture made = pictures_.Make(*frame);
    live_ = {{"frame", frame->number},
             {"frames", run_.frame_count},
             {"time", tracked.timestamp - run_.start},
             {"state", ToString(tracked.state)},
             {"reason", frame->report.Reason().value_or("")},
             {"inliers", tracked.inliers},
             {"build_ms", Rounded(frame->build_ms)},
             {"track_ms", Rounded(frame->track_ms)}};
    if (tracked.state == TrackingState::kTracked && !IsElsewhere(*frame)) {
      const Rigid3 pose = tracked.world_from_cam();
      std::vector<double> values(pose.translation.begin(), pose.translation.end());
      const Eigen::Vector4d rotation = pose.rotation.coeffs();
      values.insert(values.end(), rotation.begin(), rotation.end());
      live_["pose"] = values;
    }
    live_["elsewhere"] = IsElsewhere(*frame);
    if (made.picture.width > 0) {
      parts.set["live_image"] = PictureJson(made.picture, run_.start);
      parts.set["live_image"]["matched"] = PackArray(made.matched);
      parts.set["live_image"]["unmatched"] = PackArray(made.unmatched);
      image_ = parts.set["live_image"];
    }
  }
  live_["rate"] = Rounded(rate);
  live_["phase"] = NameOf(controls.phase);
  live_["localising"] = controls.is_localising;
  live_["can_localise"] = run_.can_localise;
  live_["notice"] = Printable(controls.notice);
  parts.set["live"] = live_;
  return parts.Format();
}

std::optional<std::string> LiveMessages::MapChange(const LiveState& state, bool is_limited,
                                                   bool is_at_rest) {
  Parts parts;
  const LiveMapChange change = map_.Follow(*state.map, is_limited);
  if (!change.landmarks.empty()) {
    parts.patch["landmarks"] = PatchOf(change.landmarks, LandmarkColumns(change.landmarks.values));
  }
  if (!change.keyframes.empty()) {
    Json columns = KeyframeColumns(change.keyframes.values);
    columns["id"] = PackArray(change.keyframes.ids);
    parts.patch["keyframes"] = PatchOf(change.keyframes, std::move(columns));
  }
  for (const ObjectId id : change.objects) {
    bodies_.erase(id);
  }
  const bool are_all_sent = (is_at_rest && FindBoxes(state.map)) || change.were_objects_removed;
  if (are_all_sent || !change.objects.empty()) {
    Json objects = Json::array();
    for (const auto& [id, object] : map_.objects()) {
      if (are_all_sent ||
          std::find(change.objects.begin(), change.objects.end(), id) != change.objects.end()) {
        objects.push_back(ObjectJson(Shown(id, object), run_.start));
      }
    }
    (are_all_sent ? parts.set : parts.add)["objects"] = std::move(objects);
  }
  if (change.were_edges_changed) {
    parts.set["edges"] = EdgesJson(map_.edges());
  }
  FollowPath(state, is_at_rest, parts);
  FollowCounts(state, parts);
  std::string text = parts.Format();
  return text.empty() ? std::nullopt : std::optional(std::move(text));
}

// Finds the boxes of a map that rests, as the report does. False if they are known, or if there are
// none.
bool LiveMessages::FindBoxes(const std::shared_ptr<const Map>& map) {
  if (map == rested_) {
    return false;
  }
  rested_ = map;
  bodies_ = BodiesOf(*map, run_.sensor.camera,
                     run_.groundtruth.empty() ? std::nullopt : std::optional(run_.groundtruth));
  return !bodies_.empty();
}

ViewObject LiveMessages::Shown(ObjectId id, const ObjectResult& object) const {
  ViewObject shown{object, {}, {}};
  if (const auto body = bodies_.find(id); body != bodies_.end()) {
    shown.body = body->second;
  }
  return shown;
}

// New poses are added. After a correction of the map, all poses are new.
void LiveMessages::FollowPath(const LiveState& state, bool is_at_rest, Parts& parts) {
  const Trajectory path = ComposeTrajectory(*state.map, state.path);
  Trajectory changed;
  const bool is_longer = state.path_thinnings == path_thinnings_ &&
                         state.map->correction_count() == corrections_ &&
                         path.size() >= path_.size();
  for (const StampedPose& pose : path) {
    if (!is_longer || path_.empty() || pose.timestamp > path_.back().timestamp) {
      changed.push_back(pose);
    }
  }
  if (!changed.empty()) {
    (is_longer && !path_.empty() ? parts.add : parts.set)["trajectory"] =
        TrajectoryJson(changed, run_.start);
  }
  path_ = path;
  path_thinnings_ = state.path_thinnings;
  corrections_ = state.map->correction_count();
  Align(is_at_rest, parts);
}

// The ground truth is aligned again whenever the path has become a good deal longer, and once it
// grows no more.
void LiveMessages::Align(bool is_at_rest, Parts& parts) {
  constexpr double kGrowth = 1.05;
  constexpr size_t kLeastPoses = 10;
  const bool is_longer = static_cast<double>(path_.size()) >=
                         kGrowth * static_cast<double>(aligned_poses_) + kLeastPoses;
  if (!is_longer && (!is_at_rest || path_.size() == aligned_poses_)) {
    return;
  }
  aligned_poses_ = path_.size();
  aligned_ = {};
  aligned_.trajectory = path_;
  Trajectory past;
  for (const StampedPose& pose : run_.groundtruth) {
    if (pose.timestamp <= path_.back().timestamp) {
      past.push_back(pose);
    }
  }
  const bool has_truth =
      AddGroundtruth(past, run_.sensor.IsMonocular() ? AlignmentKind::kSim3 : AlignmentKind::kSe3,
                     aligned_)
          .empty();
  AddUp(has_truth ? std::optional(past) : std::nullopt, aligned_);
  aligned_.groundtruth = EveryKth(aligned_.groundtruth, kMostTruth);
  aligned_.trajectory = {};
  const Json made = ViewParts(aligned_, run_.start);
  for (const char* part : {"groundtruth", "errors", "up"}) {
    if (made.contains(part) && (has_truth || std::string_view(part) == "up")) {
      parts.set[part] = made[part];
    }
  }
}

void LiveMessages::FollowCounts(const LiveState& state, Parts& parts) {
  const bool is_lost_more = state.loss_count != loss_count_;
  const bool is_changed = is_lost_more || keyframe_count_ != state.map->keyframes().size();
  losses_ = state.losses;
  loss_count_ = state.loss_count;
  keyframe_count_ = state.map->keyframes().size();
  if (is_changed) {
    parts.set["summary"] = SummaryPart();
  }
  if (is_lost_more) {
    parts.set["losses"] = LossesJson(SummaryPart(), run_.start);
  }
}

Json LiveMessages::SummaryPart() const {
  if (!summary_.is_null()) {
    return summary_;
  }
  Json losses = Json::array();
  for (const LiveLoss& loss : losses_) {
    losses.push_back({{"first_timestamp", loss.from},
                      {"last_timestamp", loss.to},
                      {"frames", loss.frames},
                      {"reason", loss.reason}});
  }
  return {{"trajectory", {{"losses", std::move(losses)}}},
          {"map",
           {{"keyframes", keyframe_count_},
            {"landmarks", map_.landmark_total()},
            {"loops", map_.edges().loops.size()}}}};
}

std::string LiveMessages::Whole(const LiveControls& controls) const {
  ViewModel model = ModelOfRun();
  model.camera = run_.sensor.camera;
  model.up = aligned_.up;
  model.groundtruth = aligned_.groundtruth;
  model.errors = aligned_.errors;
  model.edges = map_.edges();
  model.trajectory = path_;
  model.summary = SummaryPart();
  for (const auto& [id, object] : map_.objects()) {
    model.objects.push_back(Shown(id, object));
  }
  if (map_.IsThinned()) {
    model.notes.push_back(
        "The map is large: an even choice of its landmarks and the objects "
        "that were seen last are shown.");
  }
  Parts parts;
  parts.set = ViewParts(model, run_.start);
  parts.set.erase("images");
  parts.set.erase("relations");
  parts.set["run"]["live"] = controls.phase != LivePhase::kEnded;
  Json landmarks = LandmarkColumns(map_.landmarks().values());
  landmarks["total"] = map_.landmark_total();
  parts.set["landmarks"] = std::move(landmarks);
  Json keyframes = KeyframeColumns(map_.keyframes().values());
  keyframes["id"] = PackArray(map_.keyframes().ids());
  parts.set["keyframes"] = std::move(keyframes);
  if (!live_.empty()) {
    parts.set["live"] = live_;
  }
  if (!image_.is_null()) {
    parts.set["live_image"] = image_;
  }
  return parts.Format();
}

}  // namespace hullslam
