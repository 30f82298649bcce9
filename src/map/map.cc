// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map.h"

#include <algorithm>
#include <utility>

#include "hullslam/map/covisibility.h"
#include "hullslam/map/spanning_tree.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// With depth an observation holds a landmark in all three dimensions, as two views without do.
int SupportOf(const Keyframe& keyframe, uint32_t keypoint) {
  return keyframe.frame->features.right_u[keypoint] >= 0.0f ? 2 : 1;
}

auto FindObservation(auto& observations, KeyframeId keyframe) {
  const auto it = std::lower_bound(
      observations.begin(), observations.end(), keyframe,
      [](const Observation& observation, KeyframeId id) { return observation.keyframe < id; });
  return it != observations.end() && it->keyframe == keyframe ? it : observations.end();
}

}  // namespace

Map Map::Snapshot() {
  Map copy;
  copy.keyframes_ = keyframes_.Snapshot();
  copy.landmarks_ = landmarks_.Snapshot();
  copy.replaced_by_ = replaced_by_.Snapshot();
  copy.culled_ = culled_.Snapshot();
  return copy;
}

KeyframeId Map::AddKeyframe(std::shared_ptr<const Frame> frame, const Rigid3& cam_from_world) {
  Check(frame != nullptr, "a keyframe needs a frame");
  Keyframe keyframe;
  keyframe.landmarks.resize(frame->features.size());
  keyframe.frame = std::move(frame);
  keyframe.cam_from_world = cam_from_world;
  return keyframes_.Insert(std::move(keyframe));
}

LandmarkId Map::AddLandmark(const Eigen::Vector3d& position, KeyframeId created_by) {
  Landmark landmark;
  landmark.position = position;
  landmark.created_by = created_by;
  landmark.reference = created_by;
  return landmarks_.Insert(std::move(landmark));
}

bool Map::AddObservation(LandmarkId landmark, KeyframeId keyframe, uint32_t keypoint) {
  const Keyframe& observer = keyframes_.At(keyframe);
  Check(keypoint < observer.landmarks.size(), "no keypoint with this index");
  const Landmark& observed = landmarks_.At(landmark);
  if (observer.landmarks[keypoint].IsValid() ||
      FindObservation(observed.observations, keyframe) != observed.observations.end()) {
    return false;
  }
  Landmark& changed = landmarks_.Mutable(landmark);
  const auto place = std::upper_bound(
      changed.observations.begin(), changed.observations.end(), keyframe,
      [](KeyframeId id, const Observation& observation) { return id < observation.keyframe; });
  changed.observations.insert(place, {keyframe, keypoint});
  changed.support += SupportOf(observer, keypoint);
  keyframes_.Mutable(keyframe).landmarks[keypoint] = landmark;
  return true;
}

void Map::RemoveObservation(LandmarkId landmark, KeyframeId keyframe) {
  Landmark& changed = landmarks_.Mutable(landmark);
  const auto it = FindObservation(changed.observations, keyframe);
  Check(it != changed.observations.end(), "the keyframe does not observe the landmark");
  Keyframe& observer = keyframes_.Mutable(keyframe);
  observer.landmarks[it->keypoint] = LandmarkId();
  changed.support -= SupportOf(observer, it->keypoint);
  changed.observations.erase(it);
  if (changed.support <= 2) {
    EraseLandmark(landmark);
  } else if (changed.reference == keyframe) {
    changed.reference = changed.observations.front().keyframe;
  }
}

void Map::EraseLandmark(LandmarkId landmark) {
  for (const Observation& observation : landmarks_.At(landmark).observations) {
    keyframes_.Mutable(observation.keyframe).landmarks[observation.keypoint] = LandmarkId();
  }
  landmarks_.Erase(landmark);
}

void Map::ReplaceLandmark(LandmarkId landmark, LandmarkId by) {
  Check(landmark != by, "a landmark cannot replace itself");
  const Landmark old = landmarks_.At(landmark);
  EraseLandmark(landmark);
  for (const Observation& observation : old.observations) {
    AddObservation(by, observation.keyframe, observation.keypoint);
  }
  CountSightings(by, old.visible, old.found);
  replaced_by_.Put(landmark, by);
}

LandmarkId Map::Resolve(LandmarkId landmark) const {
  while (landmark.IsValid() && !landmarks_.Contains(landmark)) {
    const LandmarkId* next = replaced_by_.Find(landmark);
    landmark = next != nullptr ? *next : LandmarkId();
  }
  return landmark;
}

void Map::CullKeyframe(KeyframeId id) {
  const Keyframe keyframe = keyframes_.At(id);
  Check(keyframe.parent.IsValid(), "the root of the spanning tree cannot be culled");
  for (const LandmarkId landmark : keyframe.landmarks) {
    if (landmark.IsValid()) {
      RemoveObservation(landmark, id);
    }
  }
  DetachFromTree(*this, id);
  DetachCovisibility(*this, id);
  keyframes_.Erase(id);
  const Rigid3 world_from_parent = Inverse(keyframes_.At(keyframe.parent).cam_from_world);
  culled_.Put(id,
              {keyframe.frame->id, keyframe.parent, keyframe.cam_from_world * world_from_parent});
}

Rigid3 Map::CamFromWorld(KeyframeId keyframe) const {
  Rigid3 cam_from_ancestor;
  while (const CulledKeyframe* culled = culled_.Find(keyframe)) {
    cam_from_ancestor = cam_from_ancestor * culled->cam_from_parent;
    keyframe = culled->parent;
  }
  return cam_from_ancestor * keyframes_.At(keyframe).cam_from_world;
}

std::optional<KeyframeId> Map::KeyframeOfFrame(FrameId frame) const {
  // Keyframes are made in the order of their frames; the newest are asked for most.
  for (uint32_t number = keyframes_.NextId().value; number-- > 0;) {
    const KeyframeId id(number);
    const Keyframe* keyframe = keyframes_.Find(id);
    const FrameId candidate = keyframe != nullptr ? keyframe->frame->id : culled_.At(id).frame;
    if (candidate == frame) {
      return id;
    }
    if (candidate < frame) {
      break;
    }
  }
  return std::nullopt;
}

KeyframeId Map::NearestAlive(KeyframeId keyframe) const {
  while (const CulledKeyframe* culled = culled_.Find(keyframe)) {
    keyframe = culled->parent;
  }
  return keyframe;
}

void Map::SetPose(KeyframeId keyframe, const Rigid3& cam_from_world) {
  keyframes_.Mutable(keyframe).cam_from_world = cam_from_world;
}

void Map::SetPosition(LandmarkId landmark, const Eigen::Vector3d& position) {
  landmarks_.Mutable(landmark).position = position;
}

void Map::CountSightings(LandmarkId landmark, int visible, int found) {
  Landmark& changed = landmarks_.Mutable(landmark);
  changed.visible += visible;
  changed.found += found;
}

}  // namespace hullslam
