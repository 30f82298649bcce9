// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/suite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <vector>

#include "hullslam/util/error.h"
#include "synthetic/renderer.h"
#include "synthetic/tests/image_motion.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

const SuiteSequence& Named(const std::string& name) {
  return *SelectSuite(std::vector<std::string>{name}).front();
}

TEST(Suite, PlaysTheTenSequencesOfThePaper) {
  std::vector<std::string> played;
  std::set<std::string_view> names;
  for (const SuiteSequence& sequence : SuiteSequences()) {
    played.emplace_back(sequence.plays);
    names.insert(sequence.name);
    EXPECT_FALSE(sequence.special.empty());
    const bool is_icl = sequence.plays.starts_with("office-");
    EXPECT_EQ(sequence.form, is_icl ? DatasetForm::kIcl : DatasetForm::kTum) << sequence.name;
  }
  EXPECT_EQ(names.size(), 10U);
  EXPECT_EQ(played, (std::vector<std::string>{"fr1-desk", "fr2-desk", "fr2-person", "fr2-dishes",
                                              "fr3-office", "fr3-teddy", "office-traj0",
                                              "office-traj1", "office-traj2", "office-traj3"}));
}

TEST(SelectSuite, GivesAllOrTheNamedOnesInTheOrderOfTheSuite) {
  EXPECT_EQ(SelectSuite({}).size(), 10U);
  const std::vector<std::string> names = {"icl2", "desk1", "icl2"};
  const std::vector<const SuiteSequence*> selected = SelectSuite(names);
  ASSERT_EQ(selected.size(), 2U);
  EXPECT_EQ(selected[0]->name, "desk1");
  EXPECT_EQ(selected[1]->name, "icl2");
}

TEST(SelectSuite, ListsTheNamesIfOneIsUnknown) {
  for (const std::string name : {"kitchen", "", "Desk1"}) {
    try {
      Named(name);
      FAIL() << name;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("'" + name + "'"), std::string::npos) << message;
      EXPECT_NE(message.find("desk1, desk2, person"), std::string::npos) << message;
    }
  }
}

TEST(PlanOf, AnotherSeedIsAnotherRenderingOfTheSameScene) {
  for (const char* const name : {"teddy"}) {
    const SequencePlan a = PlanOf(Named(name), 300, 1);
    const SequencePlan again = PlanOf(Named(name), 300, 1);
    const SequencePlan b = PlanOf(Named(name), 300, 2);
    EXPECT_EQ(a.sensor_seed, again.sensor_seed);
    EXPECT_NE(a.sensor_seed, b.sensor_seed);
    for (const double time : {0.0, 3.0, 9.0}) {
      const Vector3d eye = a.scene.world_from_cam(time).translation;
      EXPECT_EQ(eye, again.scene.world_from_cam(time).translation);
      const double wobble = (eye - b.scene.world_from_cam(time).translation).norm();
      EXPECT_GT(wobble, 1e-4);
      EXPECT_LT(wobble, 0.15);
    }
    ASSERT_EQ(a.scene.objects.size(), b.scene.objects.size());
    for (size_t i = 0; i < a.scene.objects.size(); ++i) {
      EXPECT_EQ(a.scene.objects[i].world_from_object.translation,
                b.scene.objects[i].world_from_object.translation);
    }
  }
  EXPECT_NE(PlanOf(Named("desk1"), 2, 1).sensor_seed, PlanOf(Named("desk2"), 2, 1).sensor_seed);
}

TEST(PlanOf, FewFramesAreTheBeginningAndManyAreSlower) {
  for (const SuiteSequence& sequence : SuiteSequences()) {
    const auto few = sequence.path(10);
    const auto usual = sequence.path(kSuiteFrames);
    const auto many = sequence.path(2 * kSuiteFrames);
    EXPECT_EQ(few(0.3).translation, usual(0.3).translation);
    double usual_way = 0.0;
    double many_way = 0.0;
    for (double time = 0.0; time < 9.0; time += 0.5) {
      const auto step = [time](const std::function<Rigid3(double)>& path) {
        const Rigid3 motion = Inverse(path(time)) * path(time + 0.5);
        return motion.translation.norm() + LogSo3(motion.rotation).norm();
      };
      usual_way += step(usual);
      many_way += step(many);
    }
    EXPECT_LT(many_way, 0.85 * usual_way) << sequence.name;
  }
}

// The person may come nearer than the furniture.
TEST(Suite, ScenesAreClosedFurnishedAndSlowEnoughToTrack) {
  for (const SuiteSequence& sequence : SuiteSequences()) {
    SCOPED_TRACE(sequence.name);
    const Scene scene = PlanOf(sequence, kSuiteFrames, 1).scene;
    const Renderer renderer(scene, SmallCamera());
    EXPECT_GE(scene.objects.size(), 9U);
    for (int i = 0; i < kSuiteFrames; i += 30) {
      const double time = i / 30.0;
      const RenderedFrame frame = renderer.Render(time);
      EXPECT_LT(LargestMotion(scene, frame, time), 27.0) << "frame " << i;
      double nearest = 0.0;
      cv::minMaxLoc(frame.depth, &nearest, nullptr);
      EXPECT_GT(nearest, 0.35) << "frame " << i;
    }
  }
}

TEST(Suite, ObjectsStandFreeOfEachOther) {
  for (const SuiteSequence& sequence : SuiteSequences()) {
    const Scene scene = sequence.furnish(2);
    for (const SceneObject& a : scene.objects) {
      for (const SceneObject& b : scene.objects) {
        const Vector3d offset = Inverse(a.world_from_object) * b.world_from_object.translation;
        EXPECT_TRUE(a.id == b.id ||
                    (offset.cwiseAbs().array() > 0.8 * a.half_extents.array()).any())
            << sequence.name << ": " << a.class_name << ' ' << a.id << ", " << b.class_name << ' '
            << b.id;
      }
    }
  }
}

// Number of features that ORB of OpenCV finds in an image.
int FeaturesAt(double time, const std::string& name) {
  const SequencePlan plan = PlanOf(Named(name), kSuiteFrames, 1);
  const RenderedFrame frame = Renderer(plan.scene, plan.camera).Render(time);
  cv::Mat grey;
  cv::cvtColor(Sensor(plan.sensor, 1).Colour(frame, 150), grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::KeyPoint> keypoints;
  cv::ORB::create(2000, 1.2F, 8, 19, 0, 2, cv::ORB::HARRIS_SCORE, 31, 20)->detect(grey, keypoints);
  return static_cast<int>(keypoints.size());
}

TEST(Suite, TwoOfTheFourSequencesOfIclNuimHaveLittleTexture) {
  EXPECT_GT(FeaturesAt(5.0, "icl0"), 1200);
  EXPECT_GT(FeaturesAt(5.0, "icl2"), 1200);
  EXPECT_LT(FeaturesAt(7.5, "icl1"), 500);
  EXPECT_LT(FeaturesAt(6.5, "icl3"), 500);
}

TEST(Suite, InPersonThePersonMovesAndIsUsuallySeen) {
  const Scene scene = PlanOf(Named("person"), kSuiteFrames, 0).scene;
  const SceneObject& person = scene.objects.back();
  ASSERT_EQ(person.class_name, "person");
  ASSERT_TRUE(person.IsDynamic());
  const Renderer renderer(scene, SmallCamera());
  int seen = 0;
  for (int i = 0; i < kSuiteFrames; i += 15) {
    const cv::Mat mask = renderer.Render(i / 30.0).instance == person.id;
    seen += cv::countNonZero(mask) > 0.02 * static_cast<double>(mask.total()) ? 1 : 0;
  }
  EXPECT_GE(seen, 15) << "of 20";
}

}  // namespace
}  // namespace hullslam::synthetic
