// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/guess_camera.h"

#include <gtest/gtest.h>

#include <random>

#include "calibration/made_recording.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// Two views of points all over the image, through a lens; a fifth of the pairs is wrong.
DistortedPair MadePair(const PinholeCamera& camera, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Vector3d axis(uniform(random), uniform(random), uniform(random));
  const Rigid3 b_from_a{Eigen::Quaterniond(Eigen::AngleAxisd(0.15, axis.normalized())),
                        {0.4 * uniform(random), 0.4 * uniform(random), 0.2 * uniform(random)}};
  std::normal_distribution<double> noise(0.0, 0.3);
  const auto seen = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector2d raw = camera.Distort(camera.Project(point));
    return Eigen::Vector2d(raw.x() + noise(random), raw.y() + noise(random));
  };
  DistortedPair pair;
  while (pair.a.size() < 300) {
    const Eigen::Vector2d raw(320.0 + 310.0 * uniform(random), 240.0 + 230.0 * uniform(random));
    const Eigen::Vector3d in_a = camera.Unproject(camera.Undistort(raw), 2.0 + uniform(random));
    const Eigen::Vector2d in_b = seen(b_from_a * in_a);
    const bool is_inside = in_b.x() > 0.0 && in_b.x() < 640.0 && in_b.y() > 0.0 && in_b.y() < 480.0;
    if (!is_inside) {
      continue;
    }
    const bool is_wrong = pair.a.size() % 5 == 0;
    pair.a.push_back(seen(in_a));
    pair.b.push_back(is_wrong ? Eigen::Vector2d(320.0 + 310.0 * uniform(random), 200.0) : in_b);
  }
  return pair;
}

PinholeCamera LensOf(double distortion) {
  PinholeCamera camera = MadeCamera().camera;
  camera.cx = 319.5;
  camera.cy = 239.5;
  SetDivisionModel(distortion, camera);
  return camera;
}

TEST(RadialDistortionOf, FindsTheDistortionWithoutTheFocalLength) {
  for (const double distortion : {-0.3, -0.1, 0.0}) {
    std::vector<DistortedPair> pairs;
    for (uint32_t seed = 0; seed < 8; ++seed) {
      pairs.push_back(MadePair(LensOf(distortion), seed));
    }
    const std::optional<double> found = RadialDistortionOf(pairs, 640, 480);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, distortion, 0.05);
  }
}

TEST(RadialDistortionOf, NeedsEnoughPoints) {
  EXPECT_FALSE(RadialDistortionOf({}, 640, 480));
  DistortedPair few = MadePair(LensOf(0.0), 1);
  few.a.resize(20);
  few.b.resize(20);
  EXPECT_FALSE(RadialDistortionOf(std::vector{few}, 640, 480));
}

TEST(SetDivisionModel, IsLikeTheModelAllOverTheImage) {
  constexpr double kDistortion = -0.25;
  const PinholeCamera camera = LensOf(kDistortion);
  EXPECT_LT(camera.k1, 0.0);
  for (const double share : {0.2, 0.5, 0.8, 1.0}) {
    const Eigen::Vector2d raw(319.5 + 320.0 * share, 239.5 + 240.0 * share);
    const double stretch = 1.0 / (1.0 + kDistortion * share * share);
    const Eigen::Vector2d expected(319.5 + 320.0 * share * stretch,
                                   239.5 + 240.0 * share * stretch);
    EXPECT_LT((camera.Undistort(raw) - expected).norm(), 3.0) << share;
  }
}

// Without images that can be read there is no camera, and the reason is said.
TEST(GuessCamera, SaysThatItNeedsAMap) {
  SystemOptions options;
  options.sensor = SensorKind::kMonocular;
  options.camera = {.width = 640, .height = 480};
  const CameraRecording black{40, [](size_t frame, const PinholeCamera&) {
                                ImageInput image;
                                image.timestamp = 0.1 * static_cast<double>(frame);
                                image.grey = cv::Mat::zeros(480, 640, CV_8UC1);
                                return image;
                              }};
  EXPECT_THROW(GuessCamera(options, black, {}), InputError);
}

}  // namespace
}  // namespace hullslam
