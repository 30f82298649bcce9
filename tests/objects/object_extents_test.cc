// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_extents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "objects/made_objects.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// The corners of a box with these sides.
Points Box(const Eigen::Vector3d& sides) {
  Points corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    corners.push_back(sides.cwiseProduct(signs));
  }
  return corners;
}

// Points of an ellipsoid with these sides of the box around it.
Points Ball(const Eigen::Vector3d& sides) {
  Points points;
  for (int k = 0; k <= 32; ++k) {
    const double z = k / 16.0 - 1.0;
    const double radius = std::sqrt(1.0 - z * z);
    for (int i = 0; i < 96; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 96;
      const Eigen::Vector3d unit(radius * std::cos(angle), radius * std::sin(angle), z);
      points.push_back(0.5 * sides.cwiseProduct(unit));
    }
  }
  return points;
}

// A body that cameras above a table see.
class Measured : public ::testing::Test {
 protected:
  void See(const Points& body, int count = 20, double noise_px = 0.0) {
    observations_.clear();
    for (int i = 0; i < count; ++i) {
      const Rigid3 pose = CameraOnCircle(0.1 * i, 1.2, 0.6);
      std::vector<Eigen::Vector2d> pixels;
      for (const Eigen::Vector3d& point : body) {
        pixels.push_back(sensor_.camera.Project(pose * (turned_ * point)));
      }
      Detection& detection = detections_.emplace_back();
      detection.hull = ConvexHull(pixels);
      detection.box = BoundingBox(detection.hull);
      for (int k = 0; k < 16; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 16;
        SilhouetteLine line;
        line.line.normal = {std::cos(angle), std::sin(angle)};
        double reach = -1e9;
        for (const Eigen::Vector2d& corner : detection.hull) {
          reach = std::max(reach, line.line.normal.dot(corner));
        }
        line.line.offset = -reach + random_.Number(-noise_px, noise_px);
        detection.lines.push_back(line);
      }
      observations_.push_back({KeyframeId(i), pose, &detection});
    }
  }
  std::optional<ObjectExtents> Measure() const {
    return MeasureExtents(sensor_, {Rigid3(), {0.27, 0.13, 0.06}}, observations_);
  }
  void ExpectSides(const Eigen::Vector3d& sides, double tolerance) const {
    const auto extents = Measure();
    ASSERT_TRUE(extents);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(extents->sides[i], sides[i], tolerance) << i;
    }
  }

  Sensor sensor_ = MakeObjectSensor();
  Rigid3 turned_{ExpSo3(Eigen::Vector3d(0.0, 0.0, 0.3)), {0.02, -0.01, 0.01}};
  std::deque<Detection> detections_;
  std::vector<ResolvedObservation> observations_;
  RandomGeometry random_{3};
};

TEST_F(Measured, ABoxHasItsSides) {
  See(Box({0.46, 0.20, 0.04}));
  ExpectSides({0.04, 0.20, 0.46}, 1e-4);
  EXPECT_LT(Measure()->misfit, 1e-4);
}

TEST_F(Measured, AnEllipsoidHasTheSidesOfTheBoxAroundIt) {
  See(Ball({0.30, 0.12, 0.20}));
  ExpectSides({0.12, 0.20, 0.30}, 2e-3);
}

TEST_F(Measured, NoiseAndSomeWrongLinesHardlyChangeIt) {
  See(Box({0.46, 0.20, 0.04}), 20, 2.0);
  for (Detection& detection : detections_) {
    detection.lines[static_cast<size_t>(random_.Number(0.0, 15.9))].line.offset -= 30.0;
  }
  const auto extents = Measure();
  ASSERT_TRUE(extents);
  EXPECT_NEAR(extents->sides.z(), 0.46, 0.01);
}

TEST_F(Measured, LinesThatAreOneSidedOrNearTheBorderAreLeftOut) {
  See(Box({0.46, 0.20, 0.04}));
  const double right = sensor_.bounds.max_x;
  for (Detection& detection : detections_) {
    detection.lines[3].line.offset -= 200.0;
    detection.lines[3].is_one_sided = true;
    // The mask reaches to the border and ends 10 px before it.
    detection.hull.emplace_back(right - 10.0, detection.box.center().y());
    detection.lines[0].line.offset = -(right - 10.0);
  }
  ExpectSides({0.04, 0.20, 0.46}, 1e-3);
}

TEST_F(Measured, TooFewLinesOrRandomLinesGiveNothing) {
  See(Box({0.46, 0.20, 0.04}), 1);
  EXPECT_FALSE(Measure());
  See(Box({0.46, 0.20, 0.04}), 2);
  EXPECT_TRUE(Measure());
  See(Box({0.46, 0.20, 0.04}), 20, 300.0);
  EXPECT_FALSE(Measure());
}

// Mapped ellipsoids, each seen in twelve keyframes.
class KnownSizes : public ::testing::Test {
 protected:
  ObjectLandmark& Map(const std::string& label, double longest) {
    const MadeObject made =
        MakeObject(label, {0.0, 0.0, 0.0}, {0.3 * longest, 0.5 * longest, 0.2 * longest});
    const ObjectId id = map_.AddObject();
    for (int i = 0; i < 12; ++i) {
      map_.AddObservation(id, AddObserver(map_, sensor_, CameraOnCircle(0.2 * i, 1.5, 0.6), {made}),
                          0);
    }
    ObjectLandmark& object = map_.MutableObject(id);
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = made.ellipsoid;
    return object;
  }
  Sensor sensor_ = MakeObjectSensor();
  hullslam::Map map_;
};

TEST_F(KnownSizes, GiveTheUnitOfTheMap) {
  Map("keyboard", 0.25);
  const KnownScale scale = MeasureScale(map_, sensor_, {{"keyboard", 0.5}, {"mouse", 0.1}});
  EXPECT_EQ(scale.objects, 1u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, TheMedianOfSeveralCounts) {
  Map("keyboard", 0.25);
  Map("keyboard", 0.40);  // wrong: a part of another thing was mapped
  Map("mouse", 0.05);
  const KnownScale scale = MeasureScale(map_, sensor_, {{"keyboard", 0.5}, {"mouse", 0.1}});
  EXPECT_EQ(scale.objects, 3u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, AnObjectCountsAsOftenAsItWasObserved) {
  Map("keyboard", 0.25);
  ObjectLandmark& wrong = Map("keyboard", 0.10);
  for (uint32_t i = 12; i < 20; ++i) {
    map_.RemoveObservation(ObjectId(1), KeyframeId(i));
  }
  ASSERT_EQ(wrong.observations.size(), 4u);
  const KnownScale scale = MeasureScale(map_, sensor_, {{"keyboard", 0.5}});
  EXPECT_EQ(scale.objects, 2u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, AnObjectsOwnSizeCountsBeforeThatOfItsClass) {
  ObjectLandmark& keyboard = Map("keyboard", 0.25);
  keyboard.known_size = 0.75;
  for (const auto& sizes : {std::map<std::string, double>(), {{"keyboard", 0.5}}}) {
    EXPECT_EQ(KnownSize(keyboard, sizes), 0.75);
    EXPECT_NEAR(MeasureScale(map_, sensor_, sizes).metres_per_unit, 3.0, 1e-3);
  }
  keyboard.known_size = 0.0;
  EXPECT_EQ(KnownSize(keyboard, {{"keyboard", 0.5}}), 0.5);
  keyboard.known_size = 0.75;
  keyboard.state = ObjectState::kCandidate;
  EXPECT_EQ(KnownSize(keyboard, {}), 0.0);
  EXPECT_EQ(MeasureScale(map_, sensor_, {}).objects, 0u);
}

// The object with more observations has the median on its side; if both have as many, the larger
// unit counts.
TEST_F(KnownSizes, ContradictingSizesGiveTheMedianOfTheObservations) {
  Map("keyboard", 0.25).known_size = 0.50;  // 2 m
  Map("cup", 0.10).known_size = 0.30;       // 3 m
  EXPECT_NEAR(MeasureScale(map_, sensor_, {}).metres_per_unit, 3.0, 1e-3);
  map_.RemoveObservation(ObjectId(1), KeyframeId(12));
  const KnownScale scale = MeasureScale(map_, sensor_, {});
  EXPECT_EQ(scale.objects, 2u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, OtherClassesAndCandidatesDoNotCount) {
  Map("cup", 0.25);
  Map("keyboard", 0.25).state = ObjectState::kCandidate;
  for (const auto& sizes : {std::map<std::string, double>(), {{"keyboard", 0.5}}}) {
    const KnownScale scale = MeasureScale(map_, sensor_, sizes);
    EXPECT_EQ(scale.objects, 0u);
    EXPECT_EQ(scale.metres_per_unit, 1.0);
  }
}

}  // namespace

}  // namespace hullslam
