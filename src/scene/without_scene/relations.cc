// SPDX-License-Identifier: GPL-3.0-or-later
// A scene without this component has objects, boxes and the upward direction, but no relations,
// surfaces and covariances.
#include "scene/relations.h"

#include "scene/joint_views.h"
#include "scene/shape_covariance.h"

namespace hullslam {

ViewStatistics CollectViewStatistics(const Map&, const PinholeCamera&) { return {}; }

std::vector<Relation> FindViewRelations(const ViewStatistics&) { return {}; }

SceneRelations FindStandingRelations(std::span<const ObjectBody>, const ViewStatistics&) {
  return {};
}

std::optional<ShapeCovariance> CovarianceOf(const PinholeCamera&, const Ellipsoid&,
                                            const Ellipsoid&, std::span<const ObjectView>) {
  return std::nullopt;
}

}  // namespace hullslam
