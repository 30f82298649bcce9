// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/concave_models.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHalfTurn = std::numbers::pi;

// A solid of revolution that stands on z = 0, from its profile: radius and height, metres.
ObjectBuilder MakeTurned(const char* class_name, std::vector<Vector2d> profile,
                         const Material& material) {
  const Shape shape = Shape::Revolved(std::move(profile));
  ObjectBuilder object(class_name, "compound");
  object.Add(shape, material, Shift(0.0, 0.0, shape.half.z()));
  return object;
}

}  // namespace

ObjectBuilder MakeOpenMug(const Material& material) {
  ObjectBuilder mug = MakeTurned(
      "cup", {{0.0, 0.0}, {0.040, 0.0}, {0.043, 0.1}, {0.039, 0.1}, {0.036, 0.008}, {0.0, 0.008}},
      material);
  mug.Add(Shape::Torus(0.03, 0.006), material, Shift(0.06, 0.0, 0.05));
  return mug;
}

ObjectBuilder MakeOpenBowl(const Material& material) {
  constexpr double kRadius = 0.12;
  constexpr double kWall = 0.006;
  constexpr double kDepth = 0.075;
  constexpr double kFoot = 0.01;
  constexpr int kSteps = 12;
  std::vector<Vector2d> profile = {{0.0, 0.0}, {0.05, 0.0}, {0.05, kFoot}};
  const auto side = [&](double radius, double depth, int step) {
    const double angle = 0.5 * kHalfTurn * step / kSteps;
    return Vector2d(radius * std::sin(angle), kFoot + kDepth - depth * std::cos(angle));
  };
  for (int i = 4; i <= kSteps; ++i) {
    profile.push_back(side(kRadius, kDepth, i));
  }
  for (int i = kSteps; i >= 0; --i) {
    profile.push_back(side(kRadius - kWall, kDepth - kWall, i));
  }
  return MakeTurned("bowl", profile, material);
}

ObjectBuilder MakeWineGlass(const Material& material) {
  return MakeTurned("wine glass",
                    {{0.0, 0.0},
                     {0.036, 0.0},
                     {0.030, 0.006},
                     {0.006, 0.014},
                     {0.005, 0.085},
                     {0.025, 0.100},
                     {0.039, 0.125},
                     {0.041, 0.155},
                     {0.034, 0.210},
                     {0.031, 0.210},
                     {0.038, 0.155},
                     {0.036, 0.127},
                     {0.023, 0.104},
                     {0.0, 0.098}},
                    material);
}

ObjectBuilder MakeWaistedVase(const Material& material) {
  return MakeTurned("vase",
                    {{0.0, 0.0},
                     {0.06, 0.0},
                     {0.085, 0.04},
                     {0.09, 0.08},
                     {0.075, 0.13},
                     {0.035, 0.18},
                     {0.03, 0.205},
                     {0.045, 0.235},
                     {0.08, 0.26},
                     {0.074, 0.26},
                     {0.038, 0.235},
                     {0.022, 0.205},
                     {0.0, 0.19}},
                    material);
}

ObjectBuilder MakeBanana(const Material& peel) {
  constexpr int kPieces = 9;
  constexpr double kBend = 0.09;     // metres, radius of the middle line
  constexpr double kReach = 1.0;     // radians to either side
  constexpr double kThick = 0.019;   // metres, half
  constexpr double kPointed = 0.45;  // by how much the ends are thinner
  ObjectBuilder banana("banana", "compound");
  for (int i = 0; i < kPieces; ++i) {
    const double share = 2.0 * i / (kPieces - 1) - 1.0;
    const double angle = kReach * share;
    const double thick = kThick * (1.0 - kPointed * share * share);
    const Vector3d half(0.75 * kBend * kReach * 2.0 / (kPieces - 1), thick, thick);
    banana.Add(Shape::Ellipsoid(half), peel,
               TurnAboutZ(angle, {kBend * std::sin(angle), -kBend * std::cos(angle), kThick}));
  }
  return banana;
}

ObjectBuilder MakeDonut(const Material& dough) {
  ObjectBuilder donut("donut", "compound");
  donut.Add(Shape::Torus(0.035, 0.02), dough, TurnAboutX(0.5 * kHalfTurn, {0.0, 0.0, 0.02}));
  return donut;
}

ObjectBuilder MakeCornerCouch(const Material& cushion, const Material& frame) {
  ObjectBuilder couch("couch", "compound");
  // The long side is along x at the back, the short side along y on the left.
  couch.Add(Shape::Box({0.75, 0.35, 0.11}), frame, Shift(0.0, 0.4, 0.11));
  couch.Add(Shape::Box({0.35, 0.4, 0.11}), frame, Shift(-0.4, -0.35, 0.11));
  couch.Add(Shape::Superquadric({0.75, 0.11, 0.3}, 0.25, 0.25), frame, Shift(0.0, 0.64, 0.46));
  couch.Add(Shape::Superquadric({0.11, 0.75, 0.3}, 0.25, 0.25), frame, Shift(-0.64, 0.0, 0.46));
  for (const double x : {-0.14, 0.42}) {
    couch.Add(Shape::Superquadric({0.28, 0.26, 0.09}, 0.3, 0.3), cushion, Shift(x, 0.28, 0.3));
  }
  couch.Add(Shape::Superquadric({0.24, 0.34, 0.09}, 0.3, 0.3), cushion, Shift(-0.3, -0.36, 0.3));
  return couch;
}

ObjectBuilder MakeBench(const Material& wood) {
  ObjectBuilder bench("bench", "compound");
  bench.Add(Shape::Box({0.55, 0.16, 0.02}), wood, Shift(0.0, 0.0, 0.43));
  for (const double x : {-0.4, 0.4}) {
    bench.Add(Shape::Box({0.025, 0.14, 0.205}), wood, Shift(x, 0.0, 0.205));
  }
  return bench;
}

}  // namespace hullslam::synthetic
