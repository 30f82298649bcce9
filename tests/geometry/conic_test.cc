// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/conic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "geometry/polygon.h"
#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

constexpr double kPi = std::numbers::pi;

Ellipse MakeEllipse(const Eigen::Vector2d& center, double a, double b, double angle) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  return {center, turn * Eigen::Vector2d(a * a, b * b).asDiagonal() * turn.transpose()};
}

Ellipse RandomEllipse(RandomGeometry& random) {
  return MakeEllipse({random.Number(-100.0, 700.0), random.Number(-100.0, 500.0)},
                     random.Number(5.0, 200.0), random.Number(5.0, 200.0),
                     random.Number(-3.0, 3.0));
}

std::vector<Eigen::Vector2d> PointsOn(const Ellipse& ellipse, int count, double from, double to) {
  const Eigen::Matrix2d root = ellipse.shape.llt().matrixL();
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double t = from + (to - from) * i / count;
    points.emplace_back(ellipse.center + root * Eigen::Vector2d(std::cos(t), std::sin(t)));
  }
  return points;
}

double Form(const Ellipse& ellipse, const Eigen::Vector2d& point) {
  const Eigen::Vector2d p = point - ellipse.center;
  return p.dot(ellipse.shape.inverse() * p);
}

TEST(Ellipse, MatchesHandComputedValuesForACircle) {
  const Ellipse circle = MakeEllipse({30.0, 20.0}, 5.0, 5.0, 0.0);
  EXPECT_DOUBLE_EQ(circle.HalfExtent({0.6, -0.8}), 5.0);
  EXPECT_DOUBLE_EQ(circle.Area(), 25.0 * kPi);
  EXPECT_EQ(circle.Bounds().min(), Eigen::Vector2d(25.0, 15.0));
  EXPECT_EQ(circle.Bounds().max(), Eigen::Vector2d(35.0, 25.0));
  // h^2 - d^2 for the line x = 37: 5^2 - 7^2.
  const Eigen::Vector3d line(1.0, 0.0, -37.0);
  EXPECT_NEAR(line.dot(circle.DualConic() * line), -24.0, 1e-12);
}

TEST(Ellipse, HalfExtentIsTheLargestDistanceOfItsPoints) {
  RandomGeometry random(1);
  for (int i = 0; i < 50; ++i) {
    const Ellipse ellipse = RandomEllipse(random);
    const double angle = random.Number(0.0, 2.0 * kPi);
    const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
    double reach = 0.0;
    for (const Eigen::Vector2d& p : PointsOn(ellipse, 3600, 0.0, 2.0 * kPi)) {
      reach = std::max(reach, n.dot(p - ellipse.center));
    }
    EXPECT_LE(reach, ellipse.HalfExtent(n) * (1.0 + 1e-12));
    EXPECT_GT(reach, ellipse.HalfExtent(n) * (1.0 - 1e-5));
    EXPECT_NEAR(ellipse.Bounds().sizes().x(), 2.0 * ellipse.HalfExtent({1.0, 0.0}), 1e-9);
    EXPECT_NEAR(ellipse.Bounds().sizes().y(), 2.0 * ellipse.HalfExtent({0.0, 1.0}), 1e-9);
  }
}

TEST(Ellipse, OnlyTangentsAreOnTheDualConic) {
  RandomGeometry random(2);
  for (int i = 0; i < 50; ++i) {
    const Ellipse ellipse = RandomEllipse(random);
    const double angle = random.Number(0.0, 2.0 * kPi);
    const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
    const double half = ellipse.HalfExtent(n);
    for (const double beyond : {0.0, 3.0}) {
      const Eigen::Vector3d line(n.x(), n.y(), -n.dot(ellipse.center) - half - beyond);
      const double distance = half + beyond;
      EXPECT_NEAR(line.dot(ellipse.DualConic() * line), half * half - distance * distance, 1e-8);
    }
  }
}

TEST(Ellipse, IsRecoveredFromADualConicOfAnyScale) {
  RandomGeometry random(3);
  for (int i = 0; i < 100; ++i) {
    const Ellipse ellipse = RandomEllipse(random);
    const double scale = random.Number(0.1, 10.0) * (i % 2 == 0 ? 1.0 : -1.0);
    const auto back = EllipseFromDualConic(scale * ellipse.DualConic());
    ASSERT_TRUE(back);
    EXPECT_LT((back->center - ellipse.center).norm(), 1e-10);
    EXPECT_LT((back->shape - ellipse.shape).norm(), 1e-8);
  }
}

TEST(Ellipse, IsNotFoundInAHyperbolaOrADegenerateConic) {
  const Ellipse good = MakeEllipse({300.0, 200.0}, 40.0, 20.0, 0.3);
  Ellipse hyperbola = good;
  hyperbola.shape = good.shape - 900.0 * Eigen::Matrix2d::Identity();
  EXPECT_FALSE(EllipseFromDualConic(hyperbola.DualConic()));
  Ellipse imaginary = good;
  imaginary.shape = -good.shape;
  EXPECT_FALSE(EllipseFromDualConic(imaginary.DualConic()));
  Ellipse flat = good;
  flat.shape << 9.0, 12.0, 12.0, 16.0;
  EXPECT_FALSE(EllipseFromDualConic(flat.DualConic()));
  EXPECT_FALSE(EllipseFromDualConic(Eigen::Matrix3d::Zero()));
  Eigen::Matrix3d parabola = good.DualConic();
  parabola(2, 2) = 0.0;
  EXPECT_FALSE(EllipseFromDualConic(parabola));
  Eigen::Matrix3d broken = good.DualConic();
  broken(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(EllipseFromDualConic(broken));
}

TEST(Ellipse, PolygonHasTheSameAreaAndCentreAndPositiveOrder) {
  RandomGeometry random(4);
  for (const int vertices : {3, 7, 64}) {
    const Ellipse ellipse = RandomEllipse(random);
    const std::vector<Eigen::Vector2d> polygon = ellipse.Polygon(vertices);
    ASSERT_EQ(polygon.size(), static_cast<size_t>(vertices));
    EXPECT_NEAR(SignedArea(polygon), ellipse.Area(), 1e-9 * ellipse.Area());
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : polygon) {
      mean += p / vertices;
      EXPECT_NEAR(Form(ellipse, p), Form(ellipse, polygon[0]), 1e-9);
    }
    EXPECT_LT((mean - ellipse.center).norm(), 1e-9);
  }
  EXPECT_THROW(Ellipse().Polygon(2), CheckError);
}

TEST(FitEllipse, FindsTheEllipseOfItsPoints) {
  RandomGeometry random(5);
  for (int i = 0; i < 50; ++i) {
    const Ellipse ellipse = RandomEllipse(random);
    const auto fit = FitEllipse(PointsOn(ellipse, 100, 0.0, 2.0 * kPi));
    ASSERT_TRUE(fit);
    EXPECT_LT((fit->center - ellipse.center).norm(), 1e-6);
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector2d n(std::cos(k * kPi / 8.0), std::sin(k * kPi / 8.0));
      EXPECT_NEAR(fit->HalfExtent(n), ellipse.HalfExtent(n), 1e-6);
    }
  }
}

TEST(FitEllipse, IsCloseForNoisyPoints) {
  RandomGeometry random(6);
  const Ellipse ellipse = MakeEllipse({320.0, 200.0}, 80.0, 40.0, 0.4);
  std::vector<Eigen::Vector2d> points = PointsOn(ellipse, 200, 0.0, 2.0 * kPi);
  for (Eigen::Vector2d& p : points) {
    p += random.Vector(1.0).head<2>();
  }
  const auto fit = FitEllipse(points);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->center - ellipse.center).norm(), 0.5);
  EXPECT_NEAR(fit->Area(), ellipse.Area(), 0.02 * ellipse.Area());
}

TEST(FitEllipse, FindsNoneForTooFewPointsOrPointsOnALine) {
  const Ellipse ellipse = MakeEllipse({320.0, 200.0}, 80.0, 40.0, 0.4);
  EXPECT_FALSE(FitEllipse({}));
  EXPECT_FALSE(FitEllipse(PointsOn(ellipse, 4, 0.0, 6.0)));
  EXPECT_TRUE(FitEllipse(PointsOn(ellipse, 5, 0.0, 6.0)));
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < 20; ++i) {
    line.emplace_back(10.0 + 3.0 * i, 20.0 - 7.0 * i);
  }
  EXPECT_FALSE(FitEllipse(line));
  EXPECT_FALSE(FitEllipse(std::vector<Eigen::Vector2d>(8, Eigen::Vector2d(3.0, 4.0))));
}

}  // namespace
}  // namespace hullslam
