// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map.h"

#include <algorithm>
#include <utility>

#include "hullslam/util/check.h"
#include "map/keyframe_graph.h"

namespace hullslam {
namespace {

// The position of the observation by `keyframe`, or where it would be inserted.
auto LowerBoundOfObservation(auto& observations, KeyframeId keyframe) {
  return std::ranges::lower_bound(observations, keyframe, {},
                                  [](const auto& observation) { return observation.keyframe; });
}

auto FindObservation(auto& observations, KeyframeId keyframe) {
  const auto it = LowerBoundOfObservation(observations, keyframe);
  return it != observations.end() && it->keyframe == keyframe ? it : observations.end();
}

void InsertLoop(Keyframe& keyframe, KeyframeId other) {
  const auto it = std::lower_bound(keyframe.loops.begin(), keyframe.loops.end(), other);
  if (it == keyframe.loops.end() || *it != other) {
    keyframe.loops.insert(it, other);
  }
}

// Moves each loop edge of `id` to the keyframe that is nearest to the other end, of the parent of
// `id` and those that are covisible with it. The parents of parents could be far away.
void HandOverLoops(Map& map, KeyframeId id, const Keyframe& keyframe) {
  for (const KeyframeId other : keyframe.loops) {
    std::erase(map.MutableKeyframe(other).loops, id);
    const Eigen::Vector3d end = Inverse(map.CamFromWorld(other)).translation;
    const auto distance = [&](KeyframeId heir) {
      return (Inverse(map.CamFromWorld(heir)).translation - end).norm();
    };
    KeyframeId heir = keyframe.parent;
    for (const Covisible& near : keyframe.covisible) {
      if (near.keyframe != other && (heir == other || distance(near.keyframe) < distance(heir))) {
        heir = near.keyframe;
      }
    }
    if (heir != other) {
      map.AddLoop(heir, other);
    }
  }
}

}  // namespace

Map::Map(MapTables tables, std::shared_ptr<const Vocabulary> vocabulary)
    : keyframes_(std::move(tables.keyframes)),
      landmarks_(std::move(tables.landmarks)),
      objects_(std::move(tables.objects)),
      vocabulary_(std::move(vocabulary)),
      culled_(std::move(tables.culled)),
      sessions_(std::move(tables.sessions)),
      correction_count_(tables.correction_count) {
  for (const auto& [id, keyframe] : keyframes_) {
    index_.Add(id, VectorOf(*keyframe.frame));
    NoteFrame(keyframe.frame->id, id);
    CountInIsland(keyframe.island);
  }
  for (const auto& [id, culled] : culled_) {
    NoteFrame(culled.frame, id);
  }
}

Map Map::Snapshot() {
  ++revision_;
  Map copy;
  copy.keyframes_ = keyframes_.Snapshot();
  copy.landmarks_ = landmarks_.Snapshot();
  copy.objects_ = objects_.Snapshot();
  copy.vocabulary_ = vocabulary_;
  copy.index_ = index_.Snapshot();
  copy.replaced_landmarks_ = replaced_landmarks_;
  copy.replaced_objects_ = replaced_objects_;
  copy.objects_of_session_ = objects_of_session_;
  copy.culled_ = culled_.Snapshot();
  copy.keyframe_of_frame_ = keyframe_of_frame_.Snapshot();
  copy.sessions_ = sessions_;
  copy.island_sizes_ = island_sizes_;
  copy.islands_joined_ = islands_joined_;
  copy.correction_count_ = correction_count_;
  copy.revision_ = revision_;
  return copy;
}

BowVector Map::VectorOf(const Frame& frame) const {
  return vocabulary_ != nullptr ? vocabulary_->VectorOf(frame.words.get()) : BowVector();
}

void Map::BeginSession(Session session) {
  Check(session.first_frame.IsValid() && !(session.first_frame < NextFrame()) &&
            (sessions_.empty() || sessions_.back().first_frame < session.first_frame),
        "a session begins after all others");
  sessions_.push_back(std::move(session));
  objects_of_session_ = objects_.NextId();
}

FrameId Map::NextFrame() const { return keyframe_of_frame_.NextId(); }

int Map::ObservationWeight(const Frame& frame, uint32_t keypoint) {
  return frame.features.depth[keypoint] > 0.0f ? 2 : 1;
}

KeyframeId Map::AddKeyframe(std::shared_ptr<const Frame> frame, const Rigid3& cam_from_world,
                            IslandId island) {
  Check(island.IsValid(), "a keyframe belongs to an island");
  Check(frame != nullptr, "a keyframe needs a frame");
  Check(frame->words.empty() || frame->words.get().size() == frame->features.size(),
        "the frame does not have one word per keypoint");
  Keyframe keyframe;
  keyframe.landmarks.resize(frame->features.size());
  keyframe.objects.resize(frame->detections.size());
  keyframe.frame = std::move(frame);
  keyframe.cam_from_world = cam_from_world;
  keyframe.island = island;
  CountInIsland(island);
  NoteFrame(keyframe.frame->id, keyframes_.NextId());
  index_.Add(keyframes_.NextId(), VectorOf(*keyframe.frame));
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
  Check(keypoint < observer.landmarks.size(), "the keyframe has no keypoint with this index");
  const Landmark& observed = landmarks_.At(landmark);
  if (observer.landmarks[keypoint].IsValid() ||
      FindObservation(observed.observations, keyframe) != observed.observations.end()) {
    return false;
  }
  Landmark& changed = landmarks_.Mutable(landmark);
  changed.observations.insert(LowerBoundOfObservation(changed.observations, keyframe),
                              {keyframe, keypoint});
  changed.observation_weight += ObservationWeight(*observer.frame, keypoint);
  keyframes_.Mutable(keyframe).landmarks[keypoint] = landmark;
  return true;
}

void Map::RemoveObservation(LandmarkId landmark, KeyframeId keyframe) {
  Landmark& changed = landmarks_.Mutable(landmark);
  const auto it = FindObservation(changed.observations, keyframe);
  Check(it != changed.observations.end(), "the keyframe does not observe the landmark");
  Keyframe& observer = keyframes_.Mutable(keyframe);
  observer.landmarks[it->keypoint] = LandmarkId();
  changed.observation_weight -= ObservationWeight(*observer.frame, it->keypoint);
  changed.observations.erase(it);
  if (changed.observation_weight <= 2) {
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
  replaced_landmarks_.Add(landmark, by, revision_);
}

LandmarkId Map::Resolve(LandmarkId landmark) const {
  return replaced_landmarks_.Resolve(landmarks_, landmark);
}

ObjectId Map::AddObject() { return objects_.Insert(ObjectLandmark()); }

bool Map::AddObservation(ObjectId object, KeyframeId keyframe, uint32_t detection) {
  const Keyframe& observer = keyframes_.At(keyframe);
  Check(detection < observer.objects.size(), "the keyframe has no detection with this index");
  const ObjectLandmark& observed = objects_.At(object);
  if (observer.objects[detection].IsValid() ||
      FindObservation(observed.observations, keyframe) != observed.observations.end()) {
    return false;
  }
  ObjectLandmark& changed = objects_.Mutable(object);
  changed.observations.insert(LowerBoundOfObservation(changed.observations, keyframe),
                              {keyframe, detection});
  changed.reference = changed.observations.front().keyframe;
  const Detection& seen = observer.frame->detections[detection];
  changed.votes[seen.label] += seen.score;
  keyframes_.Mutable(keyframe).objects[detection] = object;
  return true;
}

void Map::RemoveObservation(ObjectId object, KeyframeId keyframe) {
  ObjectLandmark& changed = objects_.Mutable(object);
  const auto it = FindObservation(changed.observations, keyframe);
  Check(it != changed.observations.end(), "the keyframe does not observe the object");
  Keyframe& observer = keyframes_.Mutable(keyframe);
  observer.objects[it->detection] = ObjectId();
  changed.observations.erase(it);
  if (changed.observations.empty()) {
    changed.state = ObjectState::kCandidate;
  } else {
    changed.reference = changed.observations.front().keyframe;
  }
  // Counted again, because subtracting the score would leave a rounding error.
  changed.votes.clear();
  for (const ObjectObservation& left : changed.observations) {
    const Detection& seen = keyframes_.At(left.keyframe).frame->detections[left.detection];
    changed.votes[seen.label] += seen.score;
  }
}

void Map::EraseObject(ObjectId object) {
  for (const ObjectObservation& observation : objects_.At(object).observations) {
    keyframes_.Mutable(observation.keyframe).objects[observation.detection] = ObjectId();
  }
  objects_.Erase(object);
}

void Map::ReplaceObject(ObjectId object, ObjectId by) {
  Check(object != by, "an object cannot replace itself");
  const ObjectLandmark old = objects_.At(object);
  EraseObject(object);
  for (const ObjectObservation& observation : old.observations) {
    AddObservation(by, observation.keyframe, observation.detection);
  }
  ObjectLandmark& changed = objects_.Mutable(by);
  changed.visible += old.visible;
  changed.found += old.found;
  changed.name = changed.name.empty() ? old.name : changed.name;
  changed.is_locked |= old.is_locked;
  changed.known_size = changed.known_size > 0.0 ? changed.known_size : old.known_size;
  replaced_objects_.Add(object, by, revision_);
}

ObjectId Map::Resolve(ObjectId object) const { return replaced_objects_.Resolve(objects_, object); }

void Map::ForgetReplaced(uint32_t revision) {
  replaced_landmarks_.Forget(revision);
  replaced_objects_.Forget(revision, objects_of_session_);
}

void Map::ReplaceFrame(KeyframeId id, std::shared_ptr<const Frame> frame) {
  Keyframe& keyframe = keyframes_.Mutable(id);
  index_.Remove(id, VectorOf(*keyframe.frame));
  keyframe.frame = std::move(frame);
  index_.Add(id, VectorOf(*keyframe.frame));
}

void Map::AddLoop(KeyframeId a, KeyframeId b) {
  Check(a != b && keyframes_.Contains(a) && keyframes_.Contains(b),
        "a loop edge joins two keyframes of the map");
  InsertLoop(keyframes_.Mutable(a), b);
  InsertLoop(keyframes_.Mutable(b), a);
}

void Map::CullKeyframe(KeyframeId id) {
  const Keyframe keyframe = keyframes_.At(id);
  Check(keyframe.parent.IsValid(), "the root of the spanning tree cannot be culled");
  for (const LandmarkId landmark : keyframe.landmarks) {
    if (landmark.IsValid()) {
      RemoveObservation(landmark, id);
    }
  }
  for (const ObjectId object : keyframe.objects) {
    if (object.IsValid()) {
      RemoveObservation(object, id);
    }
  }
  HandOverLoops(*this, id, keyframe);
  DetachFromTree(*this, id);
  DetachCovisibility(*this, id);
  Erase(id, RelativeTo(keyframe.parent, keyframe.cam_from_world));
}

void Map::RemoveKeyframe(KeyframeId id) { Erase(id, RelativePose()); }

void Map::Erase(KeyframeId id, const RelativePose& kept) {
  const Keyframe keyframe = keyframes_.At(id);
  index_.Remove(id, VectorOf(*keyframe.frame));
  --island_sizes_.at(keyframe.island.value);
  keyframes_.Erase(id);
  culled_.Put(id, {.frame = keyframe.frame->id, .pose = kept, .scale = keyframe.scale});
}

IslandId Map::BeginIsland() {
  island_sizes_.push_back(0);
  return IslandId(static_cast<uint32_t>(island_sizes_.size() - 1));
}

size_t Map::IslandSize(IslandId island) const {
  return island.value < island_sizes_.size() ? island_sizes_[island.value] : 0;
}

void Map::MoveToIsland(KeyframeId keyframe, IslandId island) {
  --island_sizes_.at(keyframes_.At(keyframe).island.value);
  keyframes_.Mutable(keyframe).island = island;
  CountInIsland(island);
}

void Map::NoteFrame(FrameId frame, KeyframeId keyframe) {
  if (frame.IsValid()) {
    keyframe_of_frame_.Put(frame, keyframe);
  }
}

void Map::CountInIsland(IslandId island) {
  if (island.value >= island_sizes_.size()) {
    island_sizes_.resize(island.value + 1, 0);
  }
  ++island_sizes_[island.value];
}

Rigid3 Map::CamFromWorld(KeyframeId keyframe) const {
  Rigid3 cam_from_ancestor;
  while (const CulledKeyframe* culled = culled_.Find(keyframe)) {
    cam_from_ancestor = cam_from_ancestor * AtCurrentScale(culled->pose);
    keyframe = culled->pose.reference;
  }
  return cam_from_ancestor * keyframes_.At(keyframe).cam_from_world;
}

Rigid3 Map::CamFromWorld(const RelativePose& pose) const {
  return AtCurrentScale(pose) * CamFromWorld(pose.reference);
}

Rigid3 Map::AtCurrentScale(const RelativePose& pose) const {
  Rigid3 cam_from_reference = pose.cam_from_reference;
  cam_from_reference.translation *= ScaleOf(pose.reference) / pose.reference_scale;
  return cam_from_reference;
}

RelativePose Map::RelativeTo(KeyframeId reference, const Rigid3& cam_from_world) const {
  return {.reference = reference,
          .cam_from_reference = cam_from_world * Inverse(CamFromWorld(reference)),
          .reference_scale = ScaleOf(reference)};
}

double Map::ScaleOf(KeyframeId keyframe) const {
  double scale_since_culled = 1.0;
  while (const CulledKeyframe* culled = culled_.Find(keyframe)) {
    scale_since_culled *= culled->scale / culled->pose.reference_scale;
    keyframe = culled->pose.reference;
  }
  return scale_since_culled * keyframes_.At(keyframe).scale;
}

std::optional<KeyframeId> Map::KeyframeOfFrame(FrameId frame) const {
  const KeyframeId* const keyframe = keyframe_of_frame_.Find(frame);
  return keyframe != nullptr ? std::optional(*keyframe) : std::nullopt;
}

KeyframeId Map::NearestAlive(KeyframeId keyframe) const {
  while (const CulledKeyframe* culled = culled_.Find(keyframe)) {
    keyframe = culled->pose.reference;
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
