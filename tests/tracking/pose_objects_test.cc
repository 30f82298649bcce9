// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/pose_objects.h"

#include <gtest/gtest.h>

#include "objects/made_objects.h"
#include "objects/misfit.h"

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
      // All of them are mapped 10 % too small: what the keyframes see tells.
      object.ellipsoid.half_axes *= 0.9;
      const auto views = CollectViews(map_, object);
      object.support = MeasureMisfit(sensor_.camera, object.ellipsoid, views);
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
    options.residual = residual;
    const TrackingOptions tracking;
    PoseEstimate estimate;
    estimate.cam_from_world = camera_;
    const std::vector<ObjectId> ids =
        FindMappedObjects(frame_, map_, {sensor_, tracking, options}, estimate);
    return MakePoseObjects(map_, sensor_, frame_, camera_, ids, options);
  }
  // Largest distance of a line from the tangent of the mapped quadric, px.
  double WorstLine(const PoseObjects& found) const {
    double worst = 0.0;
    for (const PoseObject& object : found.objects) {
      const Ellipse ellipse =
          ProjectEllipsoid(sensor_.camera.Matrix(), camera_, object.ellipsoid).value();
      for (const SilhouetteLine& line : object.measurement.lines) {
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
  EXPECT_EQ(found.objects[0].measurement.lines.size(), frame_.detections[0].lines.size());
}

TEST_F(PoseObjectsTest, CompensationTakesTheMisfitOffTheLinesAndOffTheirSigma) {
  const PoseObjects plain = Find(false);
  const PoseObjects compensated = Find(true);
  EXPECT_GT(WorstLine(plain), 2.0);
  EXPECT_LT(WorstLine(compensated), 0.25 * WorstLine(plain));
  for (size_t i = 0; i < plain.objects.size(); ++i) {
    EXPECT_LT(compensated.objects[i].sigma_px, plain.objects[i].sigma_px);
    EXPECT_GE(compensated.objects[i].sigma_px, ObjectOptions().sigma);
  }
}

TEST_F(PoseObjectsTest, ResidualsThatTakeNoLinesAreNotCompensated) {
  const PoseObjects found = Find(true, ObjectResidual::kOverlap);
  EXPECT_TRUE(found.lines.empty());
  EXPECT_EQ(found.objects.size(), 3u);
}

TEST_F(PoseObjectsTest, AViewThatKeyframesTellNothingOfIsTakenAsItIs) {
  for (uint32_t k = 0; k < table_.size(); ++k) {
    map_.MutableObject(ObjectId(k)).support.clear();
  }
  EXPECT_TRUE(Find(true).lines.empty());
  EXPECT_EQ(Find(true).objects.size(), 3u);
}

}  // namespace
}  // namespace hullslam
