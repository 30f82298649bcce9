// SPDX-License-Identifier: GPL-3.0-or-later
// A scene without this component has objects, boxes and the upward direction, but no relations,
// surfaces and covariances.
#include "scene/relations.h"

#include "scene/joint_observations.h"
#include "scene/shape_covariance.h"

namespace hullslam {

ObservationStatistics CollectObservationStatistics(const Map&, const PinholeCamera&) { return {}; }

std::vector<Relation> FindObservedRelations(const ObservationStatistics&) { return {}; }

SceneRelations FindStandingRelations(std::span<const ObjectBody>, const ObservationStatistics&) {
  return {};
}

std::optional<ShapeCovariance> CovarianceOf(const PinholeCamera&, const Ellipsoid&,
                                            const Ellipsoid&,
                                            std::span<const ResolvedObservation>) {
  return std::nullopt;
}

}  // namespace hullslam
