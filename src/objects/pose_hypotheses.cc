// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/pose_hypotheses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "estimators/p3p.h"
#include "geometry/polygon.h"
#include "hullslam/geometry/alignment.h"
#include "map/islands.h"
#include "objects/object_sighting.h"

namespace hullslam {
namespace {

constexpr size_t kMostTriples = 3000;  // largest number of triples that are tried
constexpr size_t kMostPairs = 60;      // largest number of pairs whose angle is searched
constexpr int kAngles = 36;            // about the line through two centres
constexpr size_t kMostPoses = 24;      // largest number of poses that are returned
// Largest difference of two poses at the same place, in radians and as a share of the depth.
constexpr double kSameAngle = 0.15;
constexpr double kSameDistance = 0.15;
// Largest deviation of a centre from where it is expected, over its distance and its radius.
constexpr double kDistanceShare = 0.02;
constexpr double kRadiusShare = 0.3;

// An object that a detection may show.
struct Candidate {
  ObjectId id;
  const Ellipsoid* ellipsoid = nullptr;
  Eigen::Vector3d center_in_cam = Eigen::Vector3d::Zero();  // m; only with depth
  double radius = 0.0;                                      // m, mean of the half axes
};

// A detection and the objects that it may show.
struct DetectionCandidates {
  const Detection* detection = nullptr;
  ObjectSighting sighting;
  std::vector<Candidate> candidates;

  bool has_depth() const { return sighting.surface > 0.0; }
};

const Eigen::Vector3d& CenterOf(const Candidate& candidate) {
  return candidate.ellipsoid->world_from_object.translation;
}

double Tolerance(const Candidate& candidate, double distance) {
  return kDistanceShare * distance + kRadiusShare * candidate.radius;
}

// The detections that may show mapped objects, those with the fewest candidates first.
std::vector<DetectionCandidates> FindCandidates(const Map& map, const PinholeCamera& camera,
                                                const Frame& frame, IslandId island) {
  std::vector<DetectionCandidates> all;
  for (const Detection& detection : frame.detections) {
    const std::optional<ObjectSighting> sighting = SightObject(camera, detection);
    if (!sighting) {
      continue;
    }
    DetectionCandidates seen{&detection, *sighting, {}};
    map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
      if (object.state != ObjectState::kMapped || IslandOf(map, object) != island ||
          !MayHaveClass(object, detection.label)) {
        return;
      }
      Candidate candidate{.id = id, .ellipsoid = &object.ellipsoid};
      candidate.radius = object.ellipsoid.half_axes.mean();
      if (seen.has_depth()) {
        const double distance = DistanceOfCenter(*sighting, object.ellipsoid.half_axes);
        if (!MayHaveSize(*sighting, distance, object.ellipsoid.half_axes)) {
          return;
        }
        candidate.center_in_cam = distance * sighting->ray;
      }
      seen.candidates.push_back(candidate);
    });
    if (!seen.candidates.empty()) {
      all.push_back(std::move(seen));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const DetectionCandidates& a, const DetectionCandidates& b) {
                     return a.candidates.size() < b.candidates.size();
                   });
  return all;
}

class Proposer {
 public:
  Proposer(const PinholeCamera& camera, std::vector<DetectionCandidates> seen)
      : camera_(camera), seen_(std::move(seen)) {}

  std::vector<PoseHypothesis> Run() {
    TryTriples();
    if (poses_.empty()) {
      TryPairs();
    }
    return TakeBest();
  }

 private:
  // Two detections can show two objects only if these are as far from each other as the centres.
  bool FitTogether(size_t i, const Candidate& a, size_t j, const Candidate& b) const {
    if (a.id == b.id) {
      return false;
    }
    if (!seen_[i].has_depth() || !seen_[j].has_depth()) {
      return true;
    }
    const double in_cam = (a.center_in_cam - b.center_in_cam).norm();
    const double in_map = (CenterOf(a) - CenterOf(b)).norm();
    return std::abs(in_cam - in_map) <=
           Tolerance(a, a.center_in_cam.norm()) + Tolerance(b, b.center_in_cam.norm());
  }

  void TryTriples() {
    for (size_t i = 0; i < seen_.size(); ++i) {
      for (size_t j = i + 1; j < seen_.size(); ++j) {
        for (size_t k = j + 1; k < seen_.size(); ++k) {
          TryObjectsOf({i, j, k});
        }
      }
    }
  }

  // Tries the triples of objects that three detections may show.
  void TryObjectsOf(const std::array<size_t, 3>& of) {
    for (const Candidate& a : seen_[of[0]].candidates) {
      for (const Candidate& b : seen_[of[1]].candidates) {
        if (!FitTogether(of[0], a, of[1], b)) {
          continue;
        }
        for (const Candidate& c : seen_[of[2]].candidates) {
          if (triples_ == kMostTriples) {
            return;
          }
          if (FitTogether(of[0], a, of[2], c) && FitTogether(of[1], b, of[2], c)) {
            ++triples_;
            TryTriple(of, {&a, &b, &c});
          }
        }
      }
    }
  }

  void TryTriple(const std::array<size_t, 3>& of, const std::array<const Candidate*, 3>& objects) {
    std::array<Eigen::Vector3d, 3> in_map;
    std::array<Eigen::Vector3d, 3> in_cam;
    std::array<Eigen::Vector3d, 3> rays;
    bool has_depth = true;
    for (size_t k = 0; k < 3; ++k) {
      in_map[k] = CenterOf(*objects[k]);
      in_cam[k] = objects[k]->center_in_cam;
      rays[k] = seen_[of[k]].sighting.ray;
      has_depth = has_depth && seen_[of[k]].has_depth();
    }
    if (!has_depth) {
      const P3pPoses solved = SolveP3p(rays, in_map);
      for (size_t k = 0; k < solved.count; ++k) {
        AddPose(solved.cam_from_world[k]);
      }
    } else if (SpansTriangle(in_map) && SpansTriangle(in_cam)) {
      const PointAlignment aligned = AlignPoints(in_map, in_cam, AlignmentKind::kSe3);
      if (aligned.ok()) {
        AddPose(aligned.target_from_source);
      }
    }
  }

  void TryPairs() {
    size_t pairs = 0;
    for (size_t i = 0; i < seen_.size(); ++i) {
      for (size_t j = i + 1; j < seen_.size(); ++j) {
        if (!seen_[i].has_depth() || !seen_[j].has_depth()) {
          continue;
        }
        for (const Candidate& a : seen_[i].candidates) {
          for (const Candidate& b : seen_[j].candidates) {
            if (pairs < kMostPairs && FitTogether(i, a, j, b)) {
              ++pairs;
              TryAngles(i, a, j, b);
            }
          }
        }
      }
    }
  }

  // Adds the poses that bring the two centres to their expected positions, at all angles about the
  // line through them.
  void TryAngles(size_t i, const Candidate& a, size_t j, const Candidate& b) {
    const Eigen::Vector3d in_map = CenterOf(b) - CenterOf(a);
    const Eigen::Vector3d in_cam = b.center_in_cam - a.center_in_cam;
    const Eigen::Quaterniond straight = Eigen::Quaterniond::FromTwoVectors(in_map, in_cam);
    const Eigen::Vector3d axis = in_cam.normalized();
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kAngles;
      Rigid3 pose;
      pose.rotation = ExpSo3(angle * axis) * straight;
      pose.translation = 0.5 * (a.center_in_cam + b.center_in_cam) -
                         pose.rotation * (0.5 * (CenterOf(a) + CenterOf(b)));
      const double overlap =
          BoxOverlap(pose, *seen_[i].detection, a) + BoxOverlap(pose, *seen_[j].detection, b);
      if (overlap > 0.0) {
        const double distance = 0.5 * (a.center_in_cam.norm() + b.center_in_cam.norm());
        poses_.push_back({pose, overlap, distance});
      }
    }
  }

  double BoxOverlap(const Rigid3& pose, const Detection& detection,
                    const Candidate& candidate) const {
    const auto ellipse = ProjectEllipsoid(camera_.Matrix(), pose, *candidate.ellipsoid);
    return ellipse ? IntersectionOverUnion(ellipse->Bounds(), detection.box) : 0.0;
  }

  void AddPose(const Rigid3& cam_from_world) {
    constexpr double kLeast = 1.0;  // below it the centres are far from their expected positions
    double agreement = 0.0;
    double distances = 0.0;  // weighted by the agreements
    for (const DetectionCandidates& seen : seen_) {
      double best = 0.0;
      double distance = 0.0;
      for (const Candidate& candidate : seen.candidates) {
        if (const double share = Agreement(cam_from_world, seen, candidate); share > best) {
          best = share;
          distance = (cam_from_world * CenterOf(candidate)).norm();
        }
      }
      agreement += best;
      distances += best * distance;
    }
    if (agreement >= kLeast) {
      poses_.push_back({cam_from_world, agreement, distances / agreement});
    }
  }

  // 1 if the object has the position that the detection shows, falling to 0 at twice the tolerance.
  static double Agreement(const Rigid3& cam_from_world, const DetectionCandidates& seen,
                          const Candidate& candidate) {
    const Eigen::Vector3d center = cam_from_world * CenterOf(candidate);
    const double along = center.dot(seen.sighting.ray);
    // Behind the camera it has no size either.
    if (!seen.has_depth() && !MayHaveSize(seen.sighting, along, candidate.ellipsoid->half_axes)) {
      return 0.0;
    }
    const double distance = seen.has_depth() ? (center - candidate.center_in_cam).norm()
                                             : (center - along * seen.sighting.ray).norm();
    const double share = distance / (2.0 * Tolerance(candidate, along));
    return std::max(0.0, 1.0 - share * share);
  }

  // The best poses, without those that are near a better one.
  std::vector<PoseHypothesis> TakeBest() {
    std::stable_sort(
        poses_.begin(), poses_.end(),
        [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.agreement > b.agreement; });
    std::vector<PoseHypothesis> best;
    for (const PoseHypothesis& pose : poses_) {
      const bool is_known = std::any_of(best.begin(), best.end(), [&](const auto& better) {
        return AreSamePlace(better.cam_from_world, pose.cam_from_world, better.distance);
      });
      if (!is_known) {
        best.push_back(pose);
      }
      if (best.size() == kMostPoses) {
        break;
      }
    }
    return best;
  }

  const PinholeCamera& camera_;
  const std::vector<DetectionCandidates> seen_;
  std::vector<PoseHypothesis> poses_;
  size_t triples_ = 0;
};

}  // namespace

std::vector<PoseHypothesis> ProposePoses(const Map& map, const PinholeCamera& camera,
                                         const Frame& frame, IslandId island) {
  return Proposer(camera, FindCandidates(map, camera, frame, island)).Run();
}

bool AreSamePlace(const Rigid3& a, const Rigid3& b, double depth) {
  return AngularDistance(a.rotation, b.rotation) < kSameAngle &&
         (Inverse(a).translation - Inverse(b).translation).norm() < kSameDistance * depth;
}

}  // namespace hullslam
