// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/loop_correction.h"

#include <algorithm>
#include <map>
#include <utility>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "objects/fusion.h"
#include "optim/bundle_adjustment.h"
#include "optim/pose_graph.h"
#include "places/similar_places.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr int kStrong = 100;  // shared landmarks of an edge of the essential graph
// The weight of a loop's edge relative to other edges. It is high, because otherwise the many edges
// along the path between the ends of the loop would open the loop again.
constexpr double kLoopWeight = 10.0;
constexpr double kTiedWeight = 0.01;  // of an edge to a parent that is not known by landmarks

KeyframeId RootOf(const Map& map, KeyframeId keyframe) {
  while (map.keyframes().At(keyframe).parent.IsValid()) {
    keyframe = map.keyframes().At(keyframe).parent;
  }
  return keyframe;
}

// The graph of all keyframes of an island. Its edges are their relative poses in the map.
class EssentialGraph {
 public:
  EssentialGraph(const Map& map, IslandId island) : map_(map), ids_(KeyframesOf(map, island)) {
    for (size_t i = 0; i < ids_.size(); ++i) {
      index_.emplace(ids_[i], i);
      graph_.nodes.push_back({.cam_from_world = Sim3(map.keyframes().At(ids_[i]).cam_from_world)});
    }
    for (const KeyframeId id : ids_) {
      AddEdgesOf(id, map.keyframes().At(id));
    }
  }

  void Fix(KeyframeId id) { graph_.nodes[index_.at(id)].is_fixed = true; }
  void Start(KeyframeId id, const Sim3& cam_from_world) {
    graph_.nodes[index_.at(id)].cam_from_world = cam_from_world;
  }
  void AddEdge(KeyframeId a, KeyframeId b, const Sim3& b_from_a, double weight) {
    PoseGraph::Edge& edge = graph_.edges.emplace_back();
    edge.a = index_.at(a);
    edge.b = index_.at(b);
    edge.b_from_a = b_from_a;
    edge.inverse_sigma.setConstant(weight);
  }
  const PoseGraph& graph() const { return graph_; }
  const std::vector<KeyframeId>& ids() const { return ids_; }  // one per node

 private:
  // The edges to older keyframes, and to the parent.
  void AddEdgesOf(KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.parent.IsValid()) {
      AddMeasured(keyframe.parent, id, IsTied(map_, id) ? kTiedWeight : 1.0);
    }
    for (const Covisible& other : keyframe.covisible) {
      const bool is_in_tree = other.keyframe == keyframe.parent ||
                              std::ranges::binary_search(keyframe.children, other.keyframe);
      if (other.keyframe < id && other.shared >= kStrong && !is_in_tree) {
        AddMeasured(other.keyframe, id, 1.0);
      }
    }
    for (const KeyframeId other : keyframe.loops) {
      if (other < id) {
        AddMeasured(other, id, kLoopWeight);
      }
    }
  }

  void AddMeasured(KeyframeId a, KeyframeId b, double weight) {
    const Rigid3 b_from_a =
        map_.keyframes().At(b).cam_from_world * Inverse(map_.keyframes().At(a).cam_from_world);
    AddEdge(a, b, Sim3(b_from_a), weight);
  }

  const Map& map_;
  const std::vector<KeyframeId> ids_;
  std::map<KeyframeId, size_t> index_;
  PoseGraph graph_;
};

// Collects merges: a landmark that is found at a keypoint is merged with the landmark that the
// keypoint shows.
class LandmarkMerger {
 public:
  LandmarkMerger(const Map& map, const std::vector<LandmarkId>& kept, MapCorrection& correction)
      : map_(map), correction_(correction) {
    for (const LandmarkId id : kept) {
      kept_.Insert(id);
    }
  }

  // `found`: keypoints of the keyframe and the landmarks to be kept that they show.
  void Add(KeyframeId keyframe, const std::vector<FoundLandmark>& found) {
    for (const FoundLandmark& sighting : found) {
      const LandmarkId own = map_.keyframes().At(keyframe).landmarks[sighting.keypoint];
      if (own.IsValid() && !kept_.Contains(own) && merged_.Insert(own)) {
        correction_.landmarks.push_back({.duplicate = own, .kept = sighting.landmark});
      }
    }
  }

 private:
  const Map& map_;
  MapCorrection& correction_;
  IdSet<LandmarkId> kept_;
  IdSet<LandmarkId> merged_;
};

void SearchAndMerge(const Map& map, const Sensor& sensor, const std::vector<KeyframeId>& keyframes,
                    const std::vector<LandmarkId>& kept, LandmarkMerger& merger) {
  for (const KeyframeId id : keyframes) {
    const Keyframe& keyframe = map.keyframes().At(id);
    merger.Add(id, FindLandmarks(map, sensor, *keyframe.frame, keyframe.cam_from_world, kept));
  }
}

}  // namespace

MapCorrection SpreadLoopError(const Map& map, const Loop& loop, bool fix_scale) {
  const Rigid3 world_from_query = Inverse(map.keyframes().At(loop.query).cam_from_world);
  const Sim3 corrected_query =
      loop.query_from_candidate * Sim3(map.keyframes().At(loop.candidate).cam_from_world);
  EssentialGraph graph(map, IslandOf(map, loop.candidate));
  graph.Fix(RootOf(map, loop.candidate));
  for (const KeyframeId id : KeyframesAround(map, loop.query)) {
    graph.Start(id,
                Sim3(map.keyframes().At(id).cam_from_world * world_from_query) * corrected_query);
  }
  graph.AddEdge(loop.candidate, loop.query, loop.query_from_candidate, kLoopWeight);

  const PoseGraphResult result = OptimizePoseGraph(graph.graph(), {.fix_scale = fix_scale});
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  correction.loop = MapCorrection::LoopEdge{loop.candidate, loop.query};
  if (result.is_usable) {
    for (size_t i = 0; i < graph.ids().size(); ++i) {
      correction.poses.push_back({graph.ids()[i], map.keyframes().At(graph.ids()[i]).cam_from_world,
                                  result.cam_from_world[i]});
    }
  }
  return correction;
}

MapCorrection MoveIsland(const Map& map, const Loop& loop) {
  const Rigid3& query = map.keyframes().At(loop.query).cam_from_world;
  const Rigid3& candidate = map.keyframes().At(loop.candidate).cam_from_world;
  const IslandId of_query = IslandOf(map, loop.query);
  const IslandId of_candidate = IslandOf(map, loop.candidate);
  // The transform from the world of the older island to the world of the younger one.
  const Sim3 candidate_from_query =
      Inverse(Sim3(candidate)) * Inverse(loop.query_from_candidate) * Sim3(query);
  const Sim3 younger_from_older =
      of_candidate > of_query ? candidate_from_query : Inverse(candidate_from_query);
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  correction.loop = MapCorrection::LoopEdge{loop.candidate, loop.query};
  for (const KeyframeId id : KeyframesOf(map, std::max(of_query, of_candidate))) {
    const Rigid3& pose = map.keyframes().At(id).cam_from_world;
    correction.poses.push_back({id, pose, Sim3(pose) * younger_from_older});
  }
  return correction;
}

void AddLandmarkMerges(const Map& map, const Sensor& sensor,
                       const std::vector<KeyframeId>& searched,
                       const std::vector<KeyframeId>& observers, MapCorrection& correction) {
  const std::vector<LandmarkId> kept = ObservedLandmarks(map, observers);
  LandmarkMerger merger(map, kept, correction);
  SearchAndMerge(map, sensor, searched, kept, merger);
}

void AddObjectMerges(const Map& map, const std::vector<KeyframeId>& observers,
                     const FusionOptions& fusion, MapCorrection& correction) {
  std::vector<ObjectId> objects;
  for (const KeyframeId keyframe : observers) {
    for (const ObjectId id : map.keyframes().At(keyframe).objects) {
      if (id.IsValid()) {
        objects.push_back(id);
      }
    }
  }
  SortUnique(objects);
  for (const auto& [kept, duplicate] : FindDuplicates(map, objects, fusion)) {
    correction.objects.push_back({.duplicate = duplicate, .kept = kept});
  }
}

void AddMerges(const Map& corrected, const Sensor& sensor, const Loop& loop,
               const FusionOptions& fusion, MapCorrection& correction) {
  const std::vector<LandmarkId> kept =
      ObservedLandmarks(corrected, KeyframesAround(corrected, loop.candidate));
  const std::vector<KeyframeId> at_query = KeyframesAround(corrected, loop.query);
  LandmarkMerger merger(corrected, kept, correction);
  merger.Add(loop.query, loop.landmarks);
  SearchAndMerge(corrected, sensor, at_query, kept, merger);
  AddObjectMerges(corrected, at_query, fusion, correction);
}

namespace {

void Append(const Map& map, const BundleResult& result, MapCorrection& correction) {
  for (const auto& [id, pose] : result.poses) {
    correction.poses.push_back({id, map.keyframes().At(id).cam_from_world, Sim3(pose)});
  }
  for (const auto& [id, position] : result.positions) {
    correction.positions.push_back({id, position});
  }
}

}  // namespace

std::optional<MapCorrection> AdjustWholeMap(const Map& map, const Sensor& sensor,
                                            const ObjectOptions& objects,
                                            const Cancellation* cancellation) {
  MapCorrection correction;
  correction.snapshot_corrections = map.correction_count();
  bool is_adjusted = false;
  for (const IslandId island : Islands(map)) {
    const BundleResult result = AdjustIsland(map, island, sensor, objects, cancellation).result;
    if (result.is_usable) {
      Append(map, result, correction);
      is_adjusted = true;
    }
  }
  if (!is_adjusted || IsRequested(cancellation)) {
    return std::nullopt;
  }
  std::sort(correction.poses.begin(), correction.poses.end(),
            [](const auto& a, const auto& b) { return a.keyframe < b.keyframe; });
  return correction;
}

}  // namespace hullslam
