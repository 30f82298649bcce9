// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/body_metrics.h"

#include <gtest/gtest.h>

#include <numbers>

#include "hullslam/util/check.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Eigen::Vector3d;

TrueBody Truth(const Vector3d& center, const Vector3d& half = {0.3, 0.2, 0.1},
               const std::string& label = "cup") {
  TrueBody truth;
  truth.label = label;
  truth.shape = "box";
  truth.body = {BodyKind::kBox, Rigid3(Eigen::Quaterniond::Identity(), center), half};
  return truth;
}

MappedBody Mapped(uint32_t id, const Vector3d& center, const Vector3d& half = {0.3, 0.2, 0.1},
                  const std::string& label = "cup") {
  return {ObjectId(id),
          label,
          {BodyKind::kEllipsoid, Rigid3(Eigen::Quaterniond::Identity(), center), half},
          10};
}

// The overlaps of bodies of which each is 1 with one truth (or with none: -1).
Eigen::MatrixXd Overlaps(const std::vector<int>& truth_of, Eigen::Index truths) {
  Eigen::MatrixXd overlaps =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(truth_of.size()), truths);
  for (size_t i = 0; i < truth_of.size(); ++i) {
    if (truth_of[i] >= 0) {
      overlaps(static_cast<Eigen::Index>(i), truth_of[i]) = 1.0;
    }
  }
  return overlaps;
}

// Right, wrong, right, right, wrong: the precisions at the right ones are 1, 2/3 and 3/4, and the
// largest ones from there on 1, 3/4 and 3/4. One of the four truths is never found.
TEST(BodyMetrics, AveragePrecisionIsTheAreaUnderTheEnvelope) {
  const std::vector<TrueBody> truths(4, Truth({0, 0, 0}));
  const BodyScore score = ScoreBodies(Overlaps({0, 0, 1, 2, -1}, 4), truths, 0.25);
  EXPECT_EQ(score.right, 3U);
  EXPECT_EQ(score.predictions, 5U);
  EXPECT_DOUBLE_EQ(*score.precision, 0.6);
  EXPECT_DOUBLE_EQ(*score.recall, 0.75);
  EXPECT_DOUBLE_EQ(*score.average_precision, (1.0 + 0.75 + 0.75) / 4.0);
}

TEST(BodyMetrics, AConfidentBodyTakesTheLargestOverlapThatIsFree) {
  const std::vector<TrueBody> truths(2, Truth({0, 0, 0}));
  Eigen::MatrixXd overlaps(2, 2);
  overlaps << 0.5, 0.4, 0.6, 0.2;
  EXPECT_EQ(ScoreBodies(overlaps, truths, 0.25).right, 1U) << "greedy, not the best assignment";
  EXPECT_EQ(ScoreBodies(overlaps, truths, 0.2).right, 2U);
  EXPECT_EQ(ScoreBodies(overlaps, truths, 0.55).right, 1U);
  EXPECT_THROW(ScoreBodies(overlaps, {Truth({0, 0, 0})}, 0.25), CheckError);
}

TEST(BodyMetrics, WhatNoViewHasSeenIsNoMissAndItsMatchIsNotWrong) {
  std::vector<TrueBody> truths(3, Truth({0, 0, 0}));
  truths[1].is_counted = false;
  const BodyScore score = ScoreBodies(Overlaps({1, 0, -1}, 3), truths, 0.25);
  EXPECT_EQ(score.truths, 2U);
  EXPECT_EQ(score.predictions, 2U);
  EXPECT_DOUBLE_EQ(*score.recall, 0.5);
  EXPECT_DOUBLE_EQ(*score.average_precision, 0.5);
}

TEST(BodyMetrics, WithoutBodiesThereIsNoPrecisionAndWithoutTruthsNoRecall) {
  const BodyScore none =
      ScoreBodies(Eigen::MatrixXd(0, 2), {Truth({0, 0, 0}), Truth({1, 0, 0})}, 0.5);
  EXPECT_FALSE(none.precision.has_value());
  EXPECT_EQ(none.recall, 0.0);
  EXPECT_EQ(none.average_precision, 0.0);
  const BodyScore all_false = ScoreBodies(Eigen::MatrixXd(2, 0), {}, 0.5);
  EXPECT_EQ(all_false.precision, 0.0);
  EXPECT_FALSE(all_false.recall.has_value());
  EXPECT_FALSE(all_false.average_precision.has_value());
}

// An ellipsoid has no front, so any of the 24 frames along the same axes describes it.
TEST(BodyMetrics, AxesInAnotherOrderAreNoError) {
  RandomGeometry random(2);
  TrueBody truth = Truth({1, 2, 3});
  truth.body.world_from_body = random.Pose(3.0, 2.0);
  for (const auto& [turn, half] : {std::pair(Vector3d(0, 0, 1), Vector3d(0.2, 0.3, 0.1)),
                                   std::pair(Vector3d(1, 0, 0), Vector3d(0.3, 0.1, 0.2)),
                                   std::pair(Vector3d(0, 2, 0), Vector3d(0.3, 0.2, 0.1))}) {
    MappedBody mapped = Mapped(0, {0, 0, 0}, half);
    mapped.body.world_from_body = truth.body.world_from_body *
                                  Rigid3(ExpSo3(0.5 * std::numbers::pi * turn), Vector3d::Zero());
    const BodyError error = CompareBodies(truth, mapped);
    EXPECT_NEAR(error.box_overlap, 1.0, 1e-9);
    EXPECT_NEAR(*error.turn, 0.0, 1e-6);
    EXPECT_LT(error.sorted_axes.norm(), 1e-12);
    EXPECT_LT(error.along_axes.norm(), 1e-12);
  }
}

TEST(BodyMetrics, ErrorsAreAlongTheAxesOfTheTruth) {
  const TrueBody truth = Truth({0, 0, 0}, {0.3, 0.2, 0.1});
  MappedBody mapped = Mapped(0, {0, 0.03, 0.04}, {0.15, 0.22, 0.2});
  mapped.body.world_from_body.rotation = Eigen::Quaterniond(ExpSo3({0, 0, 0.1}));
  mapped.sight = Vector3d(0.9, 0.1, 0.0).asDiagonal();
  const BodyError error = CompareBodies(truth, mapped);
  EXPECT_NEAR(error.center_m, 0.05, 1e-12);
  EXPECT_NEAR(*error.turn, 0.1, 1e-9);
  EXPECT_TRUE(error.along_axes.isApprox(Vector3d(-0.5, 0.1, 1.0), 1e-12));
  EXPECT_TRUE(error.sorted_axes.isApprox(Vector3d(0.22 / 0.3 - 1.0, 0.0, 0.5), 1e-12));
  EXPECT_TRUE(error.sight.isApprox(Vector3d(0.9, 0.1, 0.0), 1e-12));
  const BodyErrors summary = SummarizeBodyErrors({error});
  EXPECT_NEAR(*summary.towards, -0.5, 1e-12);
  EXPECT_NEAR(*summary.across, 0.55, 1e-12) << "the median of 0.1 and 1.0";
  EXPECT_NEAR(*summary.axes_mean, (0.8 / 3.0 + 0.0 + 0.5) / 3.0, 1e-12);
  EXPECT_NEAR(*summary.axes_median, 0.8 / 3.0, 1e-12);
  EXPECT_FALSE(SummarizeBodyErrors({}).center_m.has_value());
}

TEST(BodyMetrics, ARoundBodyMayBeTurnedAboutItsAxis) {
  TrueBody truth = Truth({0, 0, 0}, {0.1, 0.1, 0.3});
  MappedBody mapped = Mapped(0, {0, 0, 0}, {0.1, 0.3, 0.1});
  // The long axis of the mapped body, its y, is tilted from z by 0.2 and turned about z by 0.6.
  mapped.body.world_from_body.rotation =
      ExpSo3({0, 0, 0.6}) * ExpSo3({0.2, 0, 0}) * ExpSo3({0.5 * std::numbers::pi, 0, 0});
  EXPECT_GT(*CompareBodies(truth, mapped).turn, 0.4);
  truth.is_round[2] = true;
  const BodyError error = CompareBodies(truth, mapped);
  EXPECT_NEAR(*error.turn, 0.2, 1e-9);
  EXPECT_LT(error.along_axes.norm(), 1e-12);
  truth.is_round[0] = true;
  EXPECT_FALSE(CompareBodies(truth, mapped).turn.has_value()) << "a sphere";
}

TEST(BodyMetrics, CountsMissesDuplicatesAndFalseOnes) {
  std::vector<TrueBody> truths = {Truth({0, 0, 0}), Truth({1, 0, 0}), Truth({2, 0, 0}),
                                  Truth({3, 0, 0})};
  truths[3].is_counted = false;
  const BodyEvaluation evaluation =
      EvaluateBodies(truths, {Mapped(5, {0.05, 0, 0}), Mapped(6, {0, 0, 0}),
                              Mapped(7, {1, 0, 0}, {0.3, 0.2, 0.1}, "vase"), Mapped(8, {9, 0, 0})});
  ASSERT_EQ(evaluation.errors.size(), 2U);
  EXPECT_EQ(evaluation.errors[0].mapped, 1U) << "the nearer one";
  EXPECT_EQ(evaluation.errors[1].truth, 1U);
  EXPECT_EQ(evaluation.duplicates, (std::vector<size_t>{0}));
  EXPECT_EQ(evaluation.false_ones, (std::vector<size_t>{3}));
  EXPECT_EQ(evaluation.missed, (std::vector<size_t>{2})) << "what was not seen is no miss";
  EXPECT_EQ(evaluation.boxes[1].right, 2U);
  EXPECT_EQ(evaluation.boxes_of_class[1].right, 1U);
  EXPECT_EQ(evaluation.solids[1].right, 2U) << "an ellipsoid fills 0.52 of its box";
  EXPECT_TRUE(evaluation.have_common_class);
  EXPECT_EQ(ErrorsByShape(evaluation).at("box").count, 2U);
  EXPECT_FALSE(EvaluateBodies(truths, {Mapped(1, {0, 0, 0}, {1, 1, 1}, "dog")}).have_common_class);
}

TEST(BodyMetrics, MappedObjectsComeIntoTheFrameOfTheTruthByTheirViews) {
  ObjectResults report;
  for (const size_t views : {1, 3, 2, 3}) {
    ObjectResult object;
    object.id = ObjectId(static_cast<uint32_t>(report.objects.size()));
    object.state = report.objects.size() == 2 ? ObjectState::kCandidate : ObjectState::kMapped;
    object.ellipsoid = {Rigid3(Eigen::Quaterniond::Identity(), {0, 0, 2}), {0.1, 0.2, 0.3}};
    object.observations.resize(views);
    report.objects.push_back(object);
  }
  const Sim3 truth_from_map(2.0, ExpSo3({0.5 * std::numbers::pi, 0, 0}), {1, 0, 0});
  const std::vector<MappedBody> bodies = MappedBodies(report, truth_from_map);
  ASSERT_EQ(bodies.size(), 3U);
  EXPECT_EQ(bodies[0].id, ObjectId(1));
  EXPECT_EQ(bodies[1].id, ObjectId(3));
  EXPECT_EQ(bodies[2].id, ObjectId(0));
  EXPECT_TRUE(bodies[0].body.half_axes.isApprox(Vector3d(0.2, 0.4, 0.6), 1e-12));
  EXPECT_TRUE(bodies[0].body.world_from_body.translation.isApprox(Vector3d(1, -4, 0), 1e-12));
  EXPECT_TRUE(bodies[0].sight.isApprox(Eigen::Matrix3d(Vector3d(0, 1, 0).asDiagonal()), 1e-9));
}

}  // namespace
}  // namespace hullslam
