// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"

namespace hullslam {

// The unit of length of a map, measured by objects of known size.
struct KnownScale {
  size_t objects = 0;  // mapped objects of known size that could be measured
  // The median over these objects, each of which counts as often as it was observed; 1 without such
  // objects.
  double metres_per_unit = 1.0;
};

// `sizes` has the length of the longest side (m) by class. An object has the class with most votes,
// and its longest side is measured with objects/object_extents.h.
KnownScale MeasureScale(const Map& map, const Sensor& sensor,
                        const std::map<std::string, double>& sizes);

}  // namespace hullslam
