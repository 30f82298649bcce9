// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_mapper.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "map/islands.h"
#include "map/keyframe_order.h"
#include "objects/association.h"
#include "objects/constraint/misfit.h"
#include "objects/constraint/point_statistics.h"
#include "objects/fusion.h"
#include "objects/initialisation.h"
#include "objects/refinement.h"
#include "objects/resolved_observation.h"
#include "objects/start_method.h"
#include "objects/visibility.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr size_t kFewPoints = 20;  // number of points that are averaged for the centre of an object

// Whether the shape should be computed again. The more observations there are, the less a new
// observation changes, so this is done when the number of observations has grown by an eighth.
// (Bundle adjustment improves the shape with every keyframe.)
bool IsDue(const ObjectLandmark& object) {
  const size_t observations = object.observations.size();
  return observations < object.shaped_views ||
         observations > object.shaped_views + object.shaped_views / 8;
}

// The spheres that an object without depth can start from.
struct StartSpheres {
  std::optional<Ellipsoid> by_landmarks;
  std::optional<Ellipsoid> by_rays;

  const std::optional<Ellipsoid>& Better() const { return by_landmarks ? by_landmarks : by_rays; }
};

StartSpheres FindStartSpheres(const PinholeCamera& camera,
                              std::span<const ResolvedObservation> observations,
                              const StartOptions& options) {
  return {.by_landmarks = StartFromLandmarks(camera, observations, options),
          .by_rays = StartFromRays(camera, observations, options)};
}

struct RefinedStart {
  Ellipsoid start;
  Refinement refinement;
};

// Refines every start and returns the one with the least cost. Its refinement is not usable if the
// solver failed for all of them.
RefinedStart RefineBest(std::span<const Ellipsoid> starts, const Sensor& sensor,
                        std::span<const ResolvedObservation> observations,
                        const ObjectRefinementOptions& options) {
  RefinedStart best;
  best.refinement.cost = std::numeric_limits<double>::infinity();
  for (const Ellipsoid& start : starts) {
    const Refinement refined =
        RefineEllipsoid(start, start, sensor, observations, options.max_misfit_px, options);
    if (refined.is_usable && refined.cost < best.refinement.cost) {
      best = {.start = start, .refinement = refined};
    }
  }
  return best;
}

// The reason not to map a candidate with this shape; nothing if there is none.
std::optional<Objection> ObjectionToStart(const Map& map, const Sensor& sensor, ObjectId id,
                                          std::span<const ResolvedObservation> observations,
                                          const ObjectOptions& options) {
  if (auto objection =
          FindObjection(map.objects().At(id).ellipsoid, sensor, observations, options.validity)) {
    return objection;
  }
  if (const auto whole = FindWhole(map, sensor, id)) {
    return Objection{ObjectRejection::kPart,
                     fmt::format("near object {} but never seen together with it", whole->value)};
  }
  return std::nullopt;
}

// The object that is kept takes the shape of the duplicate if that has more observations.
void ReplaceDuplicate(Map& map, ObjectId duplicate, ObjectId kept) {
  const ObjectLandmark before = map.objects().At(duplicate);
  const ObjectLandmark& other = map.objects().At(kept);
  const bool is_better = before.has_shape && !other.IsFixed() &&
                         before.observations.size() > other.observations.size();
  map.ReplaceObject(duplicate, kept);
  if (is_better) {
    ObjectLandmark& changed = map.MutableObject(kept);
    changed.state = before.state;
    changed.has_shape = true;
    changed.ellipsoid = before.ellipsoid;
    changed.start = before.start;
    changed.shaped_views = before.shaped_views;
    changed.misfit_px = before.misfit_px;
    changed.compensated_px = before.compensated_px;
    changed.misfit_samples = before.misfit_samples;
  }
}

}  // namespace

ObjectMapper::ObjectMapper(const Sensor& sensor, const ObjectOptions& options)
    : sensor_(sensor), options_(options) {}

void ObjectMapper::Process(Map& map, KeyframeId keyframe) {
  const ObjectIndex index(map, sensor_.camera);
  Observe(map, index, keyframe);
  CountVisible(map, index, keyframe);
  const std::vector<ObjectId> observed = map.keyframes().At(keyframe).objects;
  for (const ObjectId id : observed) {
    if (id.IsValid()) {
      Update(map, id);
    }
  }
  FuseDuplicates(map, keyframe);
  Cull(map, keyframe);
}

// Adds an observation for each detection of the keyframe. A detection of no known object gives a
// new object.
void ObjectMapper::Observe(Map& map, const ObjectIndex& index, KeyframeId keyframe) {
  const Keyframe& observer = map.keyframes().At(keyframe);
  std::vector<ObjectId> objects = AssociateDetections({.map = map,
                                                       .index = index,
                                                       .sensor = sensor_,
                                                       .frame = *observer.frame,
                                                       .cam_from_world = observer.cam_from_world,
                                                       .island = observer.island,
                                                       .landmarks = observer.landmarks},
                                                      options_.association);
  for (uint32_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].IsValid()) {
      objects[i] = map.AddObject();
    }
    map.AddObservation(objects[i], keyframe, i);
  }
}

// Counts in how many keyframes each mapped object should be seen, and in how many it is found.
void ObjectMapper::CountVisible(Map& map, const ObjectIndex& index, KeyframeId keyframe) const {
  const Keyframe& observer = map.keyframes().At(keyframe);
  const std::vector<ObjectId>& observed = observer.objects;
  std::vector<ObjectId> candidates =
      index.FindVisible(sensor_, observer.cam_from_world, observer.island);
  candidates.insert(candidates.end(), observed.begin(), observed.end());
  SortUnique(candidates);
  std::vector<std::pair<ObjectId, bool>> visible;  // and whether it is found
  for (const ObjectId id : candidates) {
    const ObjectLandmark* object = map.objects().Find(id);
    if (object == nullptr || object->state != ObjectState::kMapped) {
      continue;
    }
    const bool is_found = std::find(observed.begin(), observed.end(), id) != observed.end();
    if (is_found ||
        FindVisibility(map, sensor_, keyframe, *object, options_) == LocationVisibility::kVisible) {
      visible.emplace_back(id, is_found);
    }
  }
  for (const auto& [id, is_found] : visible) {
    ObjectLandmark& object = map.MutableObject(id);
    ++object.visible;
    object.found += is_found ? 1 : 0;
  }
}

// The observations that an object needs to be mapped or to stay mapped. Keyframes are culled, so a
// mapped object need not keep as many observations as its start takes, if this is more than the
// usual number.
size_t ObjectMapper::NeededKeyframes(const ObjectLandmark& object) const {
  constexpr int kToStay = 3;
  const int needed = options_.start.min_views;
  return static_cast<size_t>(object.state == ObjectState::kMapped ? std::min(needed, kToStay)
                                                                  : needed);
}

Objection ObjectMapper::FewKeyframes(const ObjectLandmark& object) const {
  return {ObjectRejection::kFewKeyframes,
          fmt::format("{} keyframes, expected at least {}", object.observations.size(),
                      NeededKeyframes(object))};
}

void ObjectMapper::Update(Map& map, ObjectId id, Copies copies) {
  changed_.push_back(id);
  const ObjectLandmark& object = map.objects().At(id);
  if (!object.IsFixed() && object.observations.size() < NeededKeyframes(object)) {
    Reject(map, id, FewKeyframes(object));
    return;
  }
  if (object.IsFixed() || !IsDue(object)) {
    return;
  }
  map.MutableObject(id).shaped_views = object.observations.size();
  std::vector<ResolvedObservation> observations =
      ResolveObservations(map, object, static_cast<size_t>(options_.refinement.max_views));
  AddSurfaceLandmarks(map, observations);
  if (object.state == ObjectState::kMapped) {
    Refine(map, id, observations);
  } else {
    Start(map, id, observations, copies);
  }
}

// Computes the shape of a candidate: refines several starts and takes the best result.
void ObjectMapper::Start(Map& map, ObjectId id, std::span<const ResolvedObservation> observations,
                         Copies copies) {
  const bool has_depth = HasDepth(observations);
  const StartSpheres spheres =
      has_depth ? StartSpheres{} : FindStartSpheres(sensor_.camera, observations, options_.start);
  const std::optional<Ellipsoid>& sphere = spheres.Better();
  if (!has_depth && !sphere) {
    Reject(map, id, {ObjectRejection::kNoStart, "the rays to the object do not meet"});
    return;
  }
  const Eigen::Vector3d center = sphere ? sphere->world_from_object.translation
                                        : MeanOf(CollectPoints(observations, kFewPoints));
  const double parallax = Parallax(observations, center);
  const double min_parallax = has_depth || spheres.by_landmarks
                                  ? options_.start.min_parallax
                                  : options_.start.min_parallax_without_depth;
  if (parallax < min_parallax) {
    Reject(
        map, id,
        {ObjectRejection::kLittleParallax,
         fmt::format("parallax {:.1f} degrees, expected at least {:.1f}", parallax, min_parallax)});
    return;
  }
  const std::vector<Ellipsoid> starts =
      MethodOf(options_.start.method)({.camera = sensor_.camera,
                                       .observations = observations,
                                       .center = center,
                                       .has_depth = has_depth,
                                       .options = options_.start});
  if (starts.empty()) {
    Reject(map, id, {ObjectRejection::kNoStart, "too few points or observations for a start"});
    return;
  }
  const RefinedStart best = RefineBest(starts, sensor_, observations, options_.refinement);
  if (!best.refinement.is_usable) {
    Reject(map, id, {ObjectRejection::kNotRefined, "the solver failed"});
    return;
  }
  ObjectLandmark& object = map.MutableObject(id);
  object.has_shape = true;
  object.ellipsoid = best.refinement.ellipsoid;
  object.start = best.start;
  const auto doubled =
      copies == Copies::kFuse ? FindDoubled(map, sensor_, id, options_.fusion) : std::nullopt;
  if (doubled) {
    Fuse(map, id, *doubled);
    return;
  }
  if (const auto objection = ObjectionToStart(map, sensor_, id, observations, options_)) {
    Reject(map, id, *objection);
    return;
  }
  object.state = ObjectState::kMapped;
  Accept(map, id, observations);
  spdlog::debug("object {} ({}): mapped from {} keyframes with {:.1f} degrees of parallax",
                id.value, object.Label(), object.observations.size(), parallax);
}

void ObjectMapper::Refine(Map& map, ObjectId id,
                          std::span<const ResolvedObservation> observations) {
  const ObjectLandmark& object = map.objects().At(id);
  const Refinement refined = RefineEllipsoid(object.ellipsoid, object.start, sensor_, observations,
                                             object.misfit_px, options_.refinement);
  if (!refined.is_usable) {
    Reject(map, id, {ObjectRejection::kNotRefined, "the solver failed"});
    return;
  }
  if (const auto objection =
          FindObjection(refined.ellipsoid, sensor_, observations, options_.validity)) {
    Reject(map, id, *objection);
    return;
  }
  map.MutableObject(id).ellipsoid = refined.ellipsoid;
  Accept(map, id, observations);
}

// Measures the misfit of a valid quadric.
void ObjectMapper::Accept(Map& map, ObjectId id,
                          std::span<const ResolvedObservation> observations) const {
  const std::vector<ResolvedObservation> latest =
      LatestObservations(map, map.objects().At(id), static_cast<size_t>(options_.misfit.views));
  ObjectLandmark& object = map.MutableObject(id);
  object.misfit_samples = MeasureMisfit(sensor_.camera, object.ellipsoid, latest);
  const MisfitSpread spread = MeasureSpread(sensor_.camera, object, observations, options_.misfit);
  object.misfit_px = spread.plain_px;
  object.compensated_px = spread.compensated_px;
}

void ObjectMapper::Recheck(Map& map, std::span<const ObjectId> objects) {
  changed_.insert(changed_.end(), objects.begin(), objects.end());
  for (const ObjectId id : objects) {
    const ObjectLandmark* object = map.objects().Find(id);
    if (object == nullptr || object->state != ObjectState::kMapped || object->IsFixed()) {
      continue;
    }
    if (object->observations.size() < NeededKeyframes(*object)) {
      Reject(map, id, FewKeyframes(*object));  // keyframes that observed it were culled
      continue;
    }
    const std::vector<ResolvedObservation> observations =
        ResolveObservations(map, *object, static_cast<size_t>(options_.refinement.max_views));
    if (const auto objection =
            FindObjection(object->ellipsoid, sensor_, observations, options_.validity)) {
      Reject(map, id, *objection);
      map.MutableObject(id).shaped_views = 0;  // compute the shape again with the next observation
    } else {
      Accept(map, id, observations);
    }
  }
}

void ObjectMapper::RefineMerged(Map& map, std::span<const ObjectId> objects) {
  may_all_have_changed_ = true;
  for (const ObjectId id : objects) {
    if (map.objects().Contains(id) && !map.objects().At(id).observations.empty()) {
      Update(map, id);
    }
  }
}

bool ObjectMapper::SplitOff(Map& map, ObjectId object, const ObjectLandmark& former,
                            FrameId session) {
  std::vector<ObjectObservation> others;
  for (const ObjectObservation& observation : map.objects().At(object).observations) {
    const Frame& frame = *map.keyframes().At(observation.keyframe).frame;
    if (frame.id >= session &&
        !former.votes.contains(frame.detections[observation.detection].label)) {
      others.push_back(observation);
    }
  }
  if (others.empty()) {
    return false;
  }
  const ObjectId other = map.AddObject();
  for (const ObjectObservation& observation : others) {
    map.RemoveObservation(object, observation.keyframe);
    map.AddObservation(other, observation.keyframe, observation.detection);
  }
  Update(map, other, Copies::kKeep);
  return true;
}

// The objects that may have changed since the last call: those that this class changed, and those
// of the neighbourhood, where local bundle adjustment moves keyframes. By increasing id.
std::vector<ObjectId> ObjectMapper::TakeChanged(const Map& map, KeyframeId keyframe) {
  std::vector<ObjectId> changed = std::exchange(changed_, {});
  if (std::exchange(may_all_have_changed_, false)) {
    map.objects().ForEach([&](ObjectId id, const ObjectLandmark&) { changed.push_back(id); });
  }
  const auto add_objects_of = [&](const Keyframe& observer) {
    std::copy_if(observer.objects.begin(), observer.objects.end(), std::back_inserter(changed),
                 [](ObjectId id) { return id.IsValid(); });
  };
  add_objects_of(map.keyframes().At(keyframe));
  for (const Covisible& neighbour : map.keyframes().At(keyframe).covisible) {
    add_objects_of(map.keyframes().At(neighbour.keyframe));
  }
  SortUnique(changed);
  return changed;
}

void ObjectMapper::FuseDuplicates(Map& map, KeyframeId keyframe) {
  const std::vector<ObjectId> changed = TakeChanged(map, keyframe);
  for (const auto& [kept, duplicate] : FindDuplicates(map, changed, options_.fusion)) {
    Fuse(map, duplicate, kept);
  }
}

void ObjectMapper::Fuse(Map& map, ObjectId duplicate, ObjectId kept) {
  spdlog::debug("object {} fused into object {}", duplicate.value, kept.value);
  ++rejections_[ObjectRejection::kFused];
  ReplaceDuplicate(map, duplicate, kept);
  if (!map.objects().At(kept).observations.empty()) {
    Update(map, kept);
  }
}

// The reason to remove an object that the camera could see; null if there is none.
std::optional<Objection> ObjectMapper::ReasonToCull(const Map& map, KeyframeId keyframe,
                                                    ObjectId id) {
  const CullingOptions& culling = options_.culling;
  const ObjectLandmark& object = map.objects().At(id);
  if (object.IsFixed()) {
    return std::nullopt;
  }
  const auto seldom = [](std::string why) {
    return Objection{ObjectRejection::kSeldomSeen, std::move(why)};
  };
  if (object.observations.empty()) {
    return seldom("no keyframe observes the object any more");
  }
  const bool is_kept = std::binary_search(kept_.begin(), kept_.end(), id);
  const auto patience = static_cast<uint32_t>(culling.candidate_keyframes);
  if (!is_kept && object.state == ObjectState::kCandidate &&
      AgeOf(map, LastObserver(map, object.observations), keyframe, patience + 1) > patience) {
    return seldom(
        fmt::format("not mapped yet, and not seen for {} keyframes", culling.candidate_keyframes));
  }
  if (!is_kept && object.visible >= culling.min_visible &&
      object.found < culling.min_found_ratio * object.visible) {
    return seldom(fmt::format("found in {} of the {} keyframes that should show it", object.found,
                              object.visible));
  }
  if (object.state == ObjectState::kMapped &&
      IsContradicted(map, sensor_, keyframe, id, options_.changes, contradictions_)) {
    return Objection{ObjectRejection::kContradicted, "later depth images show what is behind it"};
  }
  return std::nullopt;
}

void ObjectMapper::Cull(Map& map, KeyframeId keyframe) {
  const IslandId island = IslandOf(map, keyframe);
  std::vector<std::pair<ObjectId, Objection>> culled;
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    if (IslandOf(map, object) != island) {
      return;  // the camera cannot see it
    }
    if (const auto reason = ReasonToCull(map, keyframe, id)) {
      culled.emplace_back(id, *reason);
    }
  });
  for (const auto& [id, objection] : culled) {
    spdlog::debug("object {}: {}: {}", id.value, ToString(objection.reason), objection.detail);
    ++rejections_[objection.reason];
    contradictions_.Forget(id);
    map.EraseObject(id);
  }
}

void ObjectMapper::Reject(Map& map, ObjectId id, const Objection& objection) {
  ++rejections_[objection.reason];
  ObjectLandmark& object = map.MutableObject(id);
  object.state = ObjectState::kCandidate;
  spdlog::debug("object {} ({}): {}: {}", id.value, object.Label(), ToString(objection.reason),
                objection.detail);
}

}  // namespace hullslam
