// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/person.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// From 0 to 1 with level ends.
double Ease(double share) { return share * share * (3.0 - 2.0 * share); }

// The share of the way that is done: three walks with two stops between them.
double ShareOfWay(double share) {
  constexpr double kStop = 0.1;  // share of the time, each
  constexpr double kWalk = (1.0 - 2.0 * kStop) / 3.0;
  const double in_round = std::clamp(share, 0.0, 1.0);
  const int walks = std::min(2, static_cast<int>(in_round / (kWalk + kStop)));
  const double within = (in_round - walks * (kWalk + kStop)) / kWalk;
  return (walks + Ease(std::min(within, 1.0))) / 3.0;
}

}  // namespace

ObjectBuilder MakePerson(const Material& shirt, const Material& trousers, const Material& skin) {
  ObjectBuilder person("person", "compound");
  person.Add(Shape::Ellipsoid({0.095, 0.11, 0.13}), skin, Shift(0.0, -0.01, 1.62));
  person.Add(Shape::Ellipsoid({0.055, 0.055, 0.09}), skin, Shift(0.0, 0.0, 1.46));
  person.Add(Shape::Superquadric({0.2, 0.12, 0.3}, 0.7, 0.9), shirt, Shift(0.0, 0.0, 1.15));
  for (const double side : {-1.0, 1.0}) {
    person.Add(Shape::Ellipsoid({0.055, 0.06, 0.19}), shirt, Shift(0.225 * side, 0.0, 1.22));
    person.Add(Shape::Ellipsoid({0.042, 0.16, 0.042}), skin,
               TurnAboutX(0.35, {0.225 * side, -0.12, 1.0}));
    person.Add(Shape::Ellipsoid({0.085, 0.1, 0.27}), trousers, Shift(0.095 * side, 0.0, 0.68));
    person.Add(Shape::Ellipsoid({0.06, 0.07, 0.25}), trousers, Shift(0.1 * side, 0.015, 0.28));
    person.Add(Shape::Ellipsoid({0.045, 0.13, 0.045}), trousers, Shift(0.1 * side, -0.05, 0.045));
  }
  return person;
}

Rigid3 StrollPath::WorldFromPerson(double time, double half_height) const {
  const double share = ShareOfWay(time / duration);
  const double angle = start_angle + swept_angle * share;
  // The person faces along the path: -y of its frame is the direction of increasing or decreasing
  // angle.
  const double facing = angle + (swept_angle > 0.0 ? pi : 0.0);
  const double step = 0.5 * pi * radius * std::abs(swept_angle) * share / 0.35;
  const double bob = 0.015 * std::abs(std::sin(step));
  return TurnAboutZ(facing,
                    {radius * std::cos(angle), radius * std::sin(angle), half_height + bob});
}

}  // namespace hullslam::synthetic
