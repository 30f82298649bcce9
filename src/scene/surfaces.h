// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/joint_observations.h"
#include "scene/object_body.h"
#include "scene/scene.h"

namespace hullslam {

// The least difference of two heights that counts as a difference, m: 15 % of the sum of
// the two sizes, because the error of a height grows with the size of the object, but at least two
// standard deviations of the difference.
double HeightTolerance(const ObjectBody& a, const ObjectBody& b);

// The height of the floor: the median of the lower sides that are at this height or lower. It
// begins with the lowest one and is repeated until it does not change. Only objects whose lower
// side was seen count, if there are any. 0 without objects.
double FloorHeight(std::span<const ObjectBody> bodies);

// The bodies, with those whose lower side was never seen extended down to the floor. Things do not
// float, so a couch of which only the upper half was in the images reaches the floor.
std::vector<ObjectBody> ExtendToFloor(std::span<const ObjectBody> bodies);

// Finds the surfaces on which objects stand. Two objects stand on one surface if a keyframe has
// seen both, their lower sides have the same height, and they are near each other in relation to
// their widths, or other objects on the surface are between them. All objects that reach down to
// the height of the floor stand on the floor, which is the lowest surface, whether they were seen
// together or not. `standing` are the objects that no other object carries, and `floor` is
// FloorHeight().
std::vector<Surface> FindSurfaces(std::span<const ObjectBody* const> standing, double floor,
                                  const ObservationStatistics& observations);

}  // namespace hullslam
