// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/make_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "objects/resolved_observation.h"
#include "scene/box_fit.h"
#include "scene/joint_observations.h"
#include "scene/object_body.h"
#include "scene/relations.h"
#include "scene/shape_covariance.h"
#include "system/compose_trajectory.h"

namespace hullslam {
namespace {

SceneObject Describe(const ObjectResult& reported) {
  SceneObject object;
  object.id = reported.id;
  object.label = reported.label;
  object.shares = reported.votes;
  double sum = 0.0;
  for (const auto& [label, votes] : reported.votes) {
    sum += votes;
  }
  for (auto& [label, share] : object.shares) {
    share = sum > 0.0 ? share / sum : 1.0 / static_cast<double>(object.shares.size());
  }
  object.ellipsoid = reported.ellipsoid;
  object.observations = reported.observations.size();
  object.first_seen = reported.observations.front().timestamp;
  object.last_seen = reported.observations.front().timestamp;
  for (const ObservationResult& observation :
       reported.observations) {  // sessions may have earlier time stamps
    object.first_seen = std::min(object.first_seen, observation.timestamp);
    object.last_seen = std::max(object.last_seen, observation.timestamp);
  }
  object.quality = QualityOf(reported);
  return object;
}

std::vector<float> MeanEmbedding(std::span<const ResolvedObservation> observations) {
  Eigen::VectorXd sum;
  for (const ResolvedObservation& observation : observations) {
    const std::vector<float>& embedding = observation.detection->embedding;
    const auto size = static_cast<Eigen::Index>(embedding.size());
    if (sum.size() == 0) {
      sum = Eigen::VectorXd::Zero(size);
    }
    if (size > 0 && size == sum.size()) {  // sessions may have masks of different networks
      sum += observation.detection->score *
             Eigen::Map<const Eigen::VectorXf>(embedding.data(), size).cast<double>();
    }
  }
  const double norm = sum.norm();
  std::vector<float> mean;
  for (const double value : sum) {
    if (norm > 0.0) {
      mean.push_back(static_cast<float>(value / norm));
    }
  }
  return mean;
}

}  // namespace

Scene MakeScene(const Map& map, const ObjectResults& report, const UpDirection& up) {
  Scene scene;
  scene.up = up.up;
  scene.up_from = up.from;
  const Eigen::Quaterniond upright_from_world =
      UprightFromWorld(up.up.value_or(Eigen::Vector3d::UnitZ()));
  const Rigid3 world_from_upright(upright_from_world.conjugate(), Eigen::Vector3d::Zero());
  std::vector<ObjectBody> bodies;
  for (const ObjectResult& reported : report.objects) {
    if (reported.state != ObjectState::kMapped) {
      continue;
    }
    SceneObject& object = scene.objects.emplace_back(Describe(reported));
    const ObjectLandmark& landmark = map.objects().At(reported.id);
    const std::vector<ResolvedObservation> observations = ResolveObservations(map, landmark);
    object.embedding = MeanEmbedding(observations);
    object.covariance = CovarianceOf(report.camera, object.ellipsoid, landmark.start, observations);
    bodies.push_back(
        MeasureBody(object.id, object.ellipsoid, report.camera, observations, upright_from_world));
    if (up.up && object.covariance) {
      bodies.back().height_sigma = std::sqrt(up.up->dot(object.covariance->center * *up.up));
    }
    if (up.up) {
      const std::vector<SupportPlane> planes =
          SupportPlanesOf(report.camera, object.ellipsoid, observations, upright_from_world);
      object.box = FitBox(planes, bodies.back().ellipsoid);
      if (object.box) {
        // The covariance is that of an ellipsoid, which the thing is not; the box has its sides.
        if (object.covariance) {
          object.covariance->axes = {};
        }
        object.box->world_from_box = world_from_upright * object.box->world_from_box;
      } else {
        object.box = BoxOf(bodies.back(), upright_from_world);
      }
      FindSeenSides(planes, upright_from_world, *object.box);
    }
  }
  const ObservationStatistics observations = CollectObservationStatistics(map, report.camera);
  scene.relations = FindObservedRelations(observations);
  if (up.up) {
    SceneRelations found = FindStandingRelations(bodies, observations);
    std::move(found.relations.begin(), found.relations.end(), std::back_inserter(scene.relations));
    scene.surfaces = std::move(found.surfaces);
  }
  std::stable_sort(scene.relations.begin(), scene.relations.end(),
                   [](const Relation& a, const Relation& b) { return a.subject < b.subject; });
  return scene;
}

Scene MakeScene(const Map& map, const ObjectResults& report,
                const std::optional<Trajectory>& groundtruth) {
  std::vector<Eigen::Vector3d> landmarks;
  map.landmarks().ForEach(
      [&](LandmarkId, const Landmark& landmark) { landmarks.push_back(landmark.position); });
  return MakeScene(map, report, FindUp(groundtruth, KeyframeTrajectory(map), landmarks));
}

}  // namespace hullslam
