// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/features/feature_set.h"

#include <algorithm>
#include <cmath>

#include "hullslam/util/check.h"

namespace hullslam {

ScaleLevels ScaleLevels::Create(int levels, double factor) {
  Check(levels >= 1, "a pyramid needs at least one level");
  Check(factor > 1.0, "the scale factor is not above 1");
  ScaleLevels result;
  result.log_factor = static_cast<float>(std::log(factor));
  for (int l = 0; l < levels; ++l) {
    const double scale = std::pow(factor, l);
    result.scale.push_back(static_cast<float>(scale));
    result.sigma2.push_back(static_cast<float>(scale * scale));
    result.inverse_sigma2.push_back(static_cast<float>(1.0 / (scale * scale)));
  }
  return result;
}

int ScaleLevels::PredictLevel(double distance, double max_distance) const {
  Check(distance > 0.0 && max_distance > 0.0, "a distance is not positive");
  // A small tolerance prevents that rounding adds a level. It is far below the precision of any
  // distance.
  constexpr double kSlack = 1e-3;
  const double level = std::ceil(std::log(max_distance / distance) / log_factor - kSlack);
  return static_cast<int>(std::clamp(level, 0.0, static_cast<double>(count() - 1)));
}

}  // namespace hullslam
