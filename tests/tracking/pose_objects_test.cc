// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_objects.h"

#include <gtest/gtest.h>

#include "objects/constraint/misfit.h"
#include "objects/made_objects.h"

namespace hullslam {
namespace {

class PoseObjectsTest : public ::testing::Test {
 protected:
  PoseObjectsTest() {
    for (size_t k = 0; k < table_.size(); ++k) {
      map_.AddObject();
    }
    for (int i = 0; i < 20; ++i) {
      const KeyframeId keyframe =
          AddObserver(map_, sensor_, CameraOnCircle(0.03 * i, 1.5, 0.6), table_);
      for (uint32_t k = 0; k < table_.size(); ++k) {
        map_.AddObservation(ObjectId(k), keyframe, k);
      }
    }
    for (uint32_t k = 0; k < table_.size(); ++k) {
      ObjectLandmark& object = map_.MutableObject(ObjectId(k));
      object.has_shape = true;
      object.state = ObjectState::kMapped;
      object.ellipsoid = table_[k].ellipsoid;
      // All of them are mapped 10 % too small. The misfit samples of the keyframes show that.
      object.ellipsoid.half_axes *= 0.9;
      const auto views = ResolveObservations(map_, object);
      object.misfit_samples = MeasureMisfit(sensor_.camera, object.ellipsoid, views);
      const MisfitSpread spread = MeasureSpread(sensor_.camera, object, views);
      object.misfit_px = spread.plain_px;
      object.compensated_px = spread.compensated_px;
    }
    for (const MadeObject& made : table_) {
      frame_.detections.push_back(Detect(made, sensor_, camera_));
    }
  }
  PoseObjects Find(bool compensate, ObjectResidual residual = ObjectResidual::kTangent) const {
    ObjectOptions options;
    options.misfit_compensation = compensate;
    options.pose.constraint.residual = residual;
    const TrackingOptions tracking;
    PoseEstimate estimate;
    estimate.cam_from_world = camera_;
    const std::vector<ObjectId> ids = FindMappedObjects(
        frame_, map_, {sensor_, tracking, options, ObjectIndex(map_, sensor_.camera)}, estimate,
        IslandId(0));
    return MakePoseObjects(map_, sensor_, frame_, camera_, ids, options);
  }
  // Expects all three objects with the original lines of their detections and the whole misfit.
  void ExpectPlain(const PoseObjects& found) const {
    ASSERT_EQ(found.objects.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
      const PoseObject& object = found.objects[i];
      EXPECT_EQ(object.misfit_px, map_.objects().At(found.ids[i]).misfit_px);
      ASSERT_EQ(object.lines.size(), object.detection->lines.size());
      for (size_t k = 0; k < object.lines.size(); ++k) {
        EXPECT_EQ(object.lines[k].line.offset, object.detection->lines[k].line.offset);
      }
    }
  }
  // Largest distance of a line from the tangent of the mapped quadric, px.
  double WorstLine(const PoseObjects& found) const {
    double worst = 0.0;
    for (const PoseObject& object : found.objects) {
      const Ellipse ellipse =
          ProjectEllipsoid(sensor_.camera.Matrix(), camera_, object.ellipsoid).value();
      for (const SilhouetteLine& line : object.lines) {
        const Eigen::Vector2d& normal = line.line.normal;
        worst = std::max(worst, std::abs(normal.dot(ellipse.center) + line.line.offset +
                                         ellipse.HalfExtent(normal)));
      }
    }
    return worst;
  }
  Sensor sensor_ = MakeObjectSensor();
  std::vector<MadeObject> table_ = MakeTable();
  Map map_;
  Rigid3 camera_ = CameraOnCircle(0.315, 1.48, 0.61);
  Frame frame_;
};

TEST_F(PoseObjectsTest, AreTheMappedOnesOfTheFrame) {
  map_.MutableObject(ObjectId(1)).state = ObjectState::kCandidate;
  const PoseObjects found = Find(false);
  EXPECT_EQ(found.ids, (std::vector<ObjectId>{ObjectId(0), ObjectId(2)}));
  ASSERT_EQ(found.objects.size(), 2u);
  EXPECT_EQ(found.objects[0].lines.size(), frame_.detections[0].lines.size());
}

TEST_F(PoseObjectsTest, CompensationReducesTheMisfitOfTheLinesAndTheirSigma) {
  const PoseObjects plain = Find(false);
  const PoseObjects compensated = Find(true);
  EXPECT_GT(WorstLine(plain), 2.0);
  EXPECT_LT(WorstLine(compensated), 0.25 * WorstLine(plain));
  for (size_t i = 0; i < plain.objects.size(); ++i) {
    EXPECT_EQ(plain.objects[i].misfit_px, map_.objects().At(plain.ids[i]).misfit_px);
    EXPECT_EQ(compensated.objects[i].misfit_px, map_.objects().At(plain.ids[i]).compensated_px);
    EXPECT_LT(compensated.objects[i].misfit_px, plain.objects[i].misfit_px);
  }
}

// The excess is found by the normal of the plane of a line, which does not depend on the position
// of the camera. So this test sees whether the lines are compensated, but not from where.
TEST_F(PoseObjectsTest, LinesOfTheRightImageAreCompensatedToo) {
  constexpr double kBaseline = 0.3;  // m
  sensor_.camera.bf = kBaseline * sensor_.camera.fx;
  const Rigid3 world_from_left = Inverse(camera_);
  const Rigid3 left_from_right{Eigen::Quaterniond::Identity(), {kBaseline, 0.0, 0.0}};
  const Rigid3 right = Inverse(world_from_left * left_from_right);
  for (size_t k = 0; k < table_.size(); ++k) {
    frame_.detections[k].right_lines = Detect(table_[k], sensor_, right).lines;
  }
  const PoseObjects found = Find(true);
  ASSERT_EQ(found.objects.size(), 3u);
  size_t compensated = 0;
  for (size_t i = 0; i < found.objects.size(); ++i) {
    const ObjectLandmark& object = map_.objects().At(found.ids[i]);
    std::vector<uint8_t> known;
    const std::vector<SilhouetteLine> expected =
        CompensateLines(sensor_.camera, right, object, found.objects[i].detection->right_lines,
                        KeyframeId(), known, ObjectOptions().misfit);
    size_t k = 0;
    for (const SilhouetteLine& line : found.objects[i].right_lines) {
      while (k < expected.size() && (known[k] == 0 || expected[k].is_one_sided)) {
        ++k;
      }
      ASSERT_LT(k, expected.size());
      EXPECT_NEAR(line.line.offset, expected[k].line.offset, 1e-9);
      ++compensated;
      ++k;
    }
  }
  EXPECT_GT(compensated, 16u);
}

TEST_F(PoseObjectsTest, IsNotDoneForResidualsWithoutLines) {
  const PoseObjects found = Find(true, ObjectResidual::kOverlap);
  ExpectPlain(found);
}

TEST_F(PoseObjectsTest, AViewFromWhereNoKeyframeSawTheObjectIsNotCompensated) {
  for (uint32_t k = 0; k < table_.size(); ++k) {
    map_.MutableObject(ObjectId(k)).misfit_samples.clear();
  }
  ExpectPlain(Find(true));
}

// One-sided lines cannot be compensated. At least half of the 16 lines must be left.
TEST_F(PoseObjectsTest, HalfOfTheLinesMustBeTwoSidedForCompensation) {
  for (const size_t one_sided : {8u, 9u}) {
    for (Detection& detection : frame_.detections) {
      for (size_t i = 0; i < one_sided; ++i) {
        detection.lines[i].is_one_sided = true;
      }
    }
    const PoseObjects found = Find(true);
    if (one_sided == 9) {
      ExpectPlain(found);
      continue;
    }
    ASSERT_EQ(found.objects.size(), 3u);
    for (const PoseObject& object : found.objects) {
      EXPECT_EQ(object.lines.size(), 8u);
      for (const SilhouetteLine& line : object.lines) {
        EXPECT_FALSE(line.is_one_sided);
      }
    }
  }
}

}  // namespace
}  // namespace hullslam
