// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/wide_lens.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <string>
#include <vector>

#include "support/fisheye_camera.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Undistorted pixels up to this angle from the axis, in all directions.
std::vector<Eigen::Vector2d> PixelsUpTo(const PinholeCamera& camera, double most_angle) {
  std::vector<Eigen::Vector2d> pixels;
  for (double angle = 0.5 * kDegree; angle < most_angle; angle += 4.0 * kDegree) {
    for (double turn = 0.1; turn < 6.28; turn += 0.7) {
      pixels.push_back(camera.Project(
          {std::tan(angle) * std::cos(turn), std::tan(angle) * std::sin(turn), 1.0}));
    }
  }
  return pixels;
}

class WideLens : public testing::TestWithParam<PinholeCamera> {};

TEST(KannalaBrandt, AgreesWithOpenCv) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector2d& pixel : PixelsUpTo(camera, 79.0 * kDegree)) {
    const Eigen::Vector3d ray = camera.Unproject(pixel, 1.0);
    const std::vector<cv::Point2d> points = {{ray.x(), ray.y()}};
    std::vector<cv::Point2d> distorted;
    cv::fisheye::distortPoints(
        points, distorted,
        cv::Matx33d(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0),
        cv::Vec4d(camera.k1, camera.k2, camera.k3, camera.k4));
    const Eigen::Vector2d expected(distorted[0].x, distorted[0].y);
    EXPECT_LT((camera.Distort(pixel) - expected).norm(), 1e-9) << pixel.transpose();
  }
}

TEST_P(WideLens, UndistortInvertsDistort) {
  const PinholeCamera& camera = GetParam();
  for (const Eigen::Vector2d& pixel : PixelsUpTo(camera, 79.5 * kDegree)) {
    const Eigen::Vector2d raw = camera.Distort(pixel);
    EXPECT_LT((camera.Undistort(raw) - pixel).norm(), 1e-8 * pixel.norm()) << pixel.transpose();
    EXPECT_LT((camera.Distort(camera.Undistort(raw)) - raw).norm(), 1e-9);
  }
  EXPECT_EQ(camera.Undistort({camera.cx, camera.cy}), Eigen::Vector2d(camera.cx, camera.cy));
}

TEST_P(WideLens, JacobianIsTrue) {
  const PinholeCamera& camera = GetParam();
  for (const Eigen::Vector2d& pixel : PixelsUpTo(camera, 79.0 * kDegree)) {
    const Eigen::Matrix2d jacobian = camera.DistortionJacobian(pixel);
    constexpr double kStep = 1e-3;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d slope =
          (camera.Distort(pixel + step) - camera.Distort(pixel - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-7) << pixel.transpose();
    }
  }
}

TEST_P(WideLens, RawPixelsBeyondTheLargestAngleGiveThePixelThere) {
  const PinholeCamera& camera = GetParam();
  const Eigen::Vector2d beyond = camera.Undistort({camera.cx + 500.0, camera.cy});
  EXPECT_NEAR(beyond.x(), camera.cx + camera.fx * std::tan(PinholeCamera::kMostAngle), 1e-6);
  const double limit = camera.fx * RadiusOfAngle(camera, PinholeCamera::kMostAngle);
  EXPECT_TRUE(camera.SeesRaw({camera.cx - 0.5 * limit, camera.cy}));
  PinholeCamera large = camera;
  large.width = 1000;
  large.cx = 500.0;
  EXPECT_TRUE(large.SeesRaw({large.cx + limit - 0.1, large.cy}));
  EXPECT_FALSE(large.SeesRaw({large.cx + limit + 0.1, large.cy}));
  EXPECT_FALSE(camera.SeesRaw({-0.1, camera.cy}));
}

TEST_P(WideLens, RaysHaveTheirPixelsInAllDirectionsThatAreSeen) {
  const PinholeCamera& camera = GetParam();
  RandomGeometry random(3);
  const double largest = LargestAngle(camera, std::numbers::pi);
  EXPECT_GT(largest, 2.0);
  int seen = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d ray = random.Vector(1.0).normalized();
    if (std::acos(ray.z()) > largest - 0.05) {
      continue;
    }
    ++seen;
    const Eigen::Vector2d raw = RawPixelOfRay(camera, 3.0 * ray);
    EXPECT_LT((RayOfRawPixel(camera, raw, largest) - ray).norm(), 1e-7) << ray.transpose();
    if (ray.z() > 0.2) {
      EXPECT_LT((camera.Distort(camera.Project(ray)) - raw).norm(), 1e-8);
    }
  }
  EXPECT_GT(seen, 120);
  EXPECT_EQ(RayOfRawPixel(camera, {camera.cx, camera.cy}, largest), Eigen::Vector3d::UnitZ());
}

TEST_P(WideLens, TheRadiusGrowsUpToTheLargestAngle) {
  const PinholeCamera& camera = GetParam();
  const double largest = LargestAngle(camera, std::numbers::pi);
  constexpr double kStep = 1e-6;
  for (double angle = 0.0; angle < largest - 0.01; angle += 0.01) {
    const LensRadius at = RadiusAt(camera, angle);
    EXPECT_GT(at.slope, 0.0) << angle;
    const double slope = (RadiusOfAngle(camera, angle + kStep) - at.radius) / kStep;
    EXPECT_NEAR(slope, at.slope, 1e-4 * (1.0 + at.slope)) << angle;
  }
  EXPECT_EQ(camera.FindFault(), "");
}

TEST_P(WideLens, TheAxisIsNoException) {
  const PinholeCamera& camera = GetParam();
  const Eigen::Vector2d axis(camera.cx, camera.cy);
  const Eigen::Vector2d near = axis + Eigen::Vector2d(1e-3, 1e-3);
  EXPECT_EQ(camera.Distort(axis), axis);
  EXPECT_LT((camera.DistortionJacobian(axis) - camera.DistortionJacobian(near)).norm(), 1e-5);
  const Eigen::Vector2d tiny(1e-8, 0.0);
  EXPECT_LT((camera.Undistort(axis + tiny) - camera.Undistort(axis) -
             camera.DistortionJacobian(axis).inverse() * tiny)
                .norm(),
            1e-12);
}

INSTANTIATE_TEST_SUITE_P(Lenses, WideLens,
                         testing::Values(FisheyeCamera(), DoubleSphereCamera(),
                                         ExtendedUnifiedCamera()),
                         [](const auto& info) {
                           return std::string(FindWideModel(info.param.lens)->type);
                         });

// The projections as Usenko et al. 2018 write them.
TEST(DoubleSphere, AgreesWithItsEquations) {
  const PinholeCamera camera = DoubleSphereCamera();
  RandomGeometry random(4);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p = 2.0 * random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 1.5);
    const double d1 = p.norm();
    const double z = camera.xi * d1 + p.z();
    const double d2 = std::hypot(p.x(), p.y(), z);
    const double d = camera.alpha * d2 + (1.0 - camera.alpha) * z;
    const double scale = 1.0 + camera.xi;  // of the focal length there
    const Eigen::Vector2d expected(scale * camera.fx * p.x() / d + camera.cx,
                                   scale * camera.fy * p.y() / d + camera.cy);
    EXPECT_LT((RawPixelOfRay(camera, p) - expected).norm(), 1e-9) << p.transpose();
  }
}

TEST(ExtendedUnified, AgreesWithItsEquations) {
  const PinholeCamera camera = ExtendedUnifiedCamera();
  RandomGeometry random(5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p = 2.0 * random.Vector(1.0) + Eigen::Vector3d(0.0, 0.0, 1.5);
    const double d =
        camera.alpha * std::sqrt(camera.beta * p.head<2>().squaredNorm() + p.z() * p.z()) +
        (1.0 - camera.alpha) * p.z();
    const Eigen::Vector2d expected(camera.fx * p.x() / d + camera.cx,
                                   camera.fy * p.y() / d + camera.cy);
    EXPECT_LT((RawPixelOfRay(camera, p) - expected).norm(), 1e-9) << p.transpose();
  }
}

// Without their coefficients both are pinholes.
TEST(WideLensLimits, ADoubleSphereOfNoSizeIsThePinhole) {
  for (PinholeCamera camera : {DoubleSphereCamera(), ExtendedUnifiedCamera()}) {
    camera.xi = 0.0;
    camera.alpha = 0.0;
    camera.beta = 1.0;
    EXPECT_LT((camera.Distort({20.0, 30.0}) - Eigen::Vector2d(20.0, 30.0)).norm(), 1e-9);
    EXPECT_NEAR(LargestAngle(camera, std::numbers::pi), 0.5 * std::numbers::pi, 1e-9);
  }
}

// t (1 - t^2 / 3) has its maximum 2/3 at t = 1.
TEST(KannalaBrandt, TheFoldIsFound) {
  PinholeCamera camera = FisheyeCamera();
  camera.k1 = -1.0 / 3.0;
  camera.k2 = camera.k3 = camera.k4 = 0.0;
  EXPECT_NEAR(LargestAngle(camera, 1.4), 1.0, 0.004);
  EXPECT_NEAR(camera.FoldRadius(), camera.fx * 2.0 / 3.0, 0.01);
  EXPECT_EQ(FisheyeCamera().FoldRadius(), std::numeric_limits<double>::infinity());
  const Eigen::Vector2d beyond = camera.Undistort({camera.cx + 5.0 * camera.fx, camera.cy});
  EXPECT_NEAR(beyond.x(), camera.cx + camera.fx * std::tan(1.0), 5.0);
}

TEST(KannalaBrandt, APinholeAsFisheyeIsThePinhole) {
  const PinholeCamera camera = PinholeAsFisheye();
  for (int y = 0; y <= camera.height; y += 40) {
    for (int x = 0; x <= camera.width; x += 40) {
      EXPECT_LT((camera.Undistort({x, y}) - Eigen::Vector2d(x, y)).norm(), 0.05);
    }
  }
  EXPECT_EQ(camera.FindFault(), "");
}

}  // namespace

}  // namespace hullslam
