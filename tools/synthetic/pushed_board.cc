// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/pushed_board.h"

#include <algorithm>
#include <cstddef>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {

using Eigen::Vector3d;

ObjectBuilder MakePushedBoard(const Material& print, const Material& skin) {
  constexpr double kLean = -0.3;  // radians, the upper edge to the back
  ObjectBuilder board("", "compound");
  board.Add(Shape::Box({0.125, 0.004, 0.1}), print, TurnAboutX(kLean, {0.0, 0.0, 0.1}));
  board.Add(Shape::Ellipsoid({0.03, 0.14, 0.03}), skin, TurnAboutX(kLean, {0.0, 0.13, 0.06}));
  return board;
}

Rigid3 PushedPath::WorldFromThing(double time) const {
  Check(!places.empty(), "a pushed thing needs a place");
  const double steps = std::max(0.0, time) / (rest + move);
  const size_t last = places.size() - 1;
  const size_t from = std::min(last, static_cast<size_t>(std::min(steps, 1e6)));
  const double in_step = (steps - static_cast<double>(from)) * (rest + move);
  const double share = std::clamp((in_step - rest) / move, 0.0, 1.0);
  const double eased = share * share * (3.0 - 2.0 * share);
  const Vector3d& to = places[std::min(last, from + 1)];
  return {Eigen::Quaterniond::Identity(), places[from] + eased * (to - places[from])};
}

}  // namespace hullslam::synthetic
