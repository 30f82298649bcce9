// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/ate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

TEST(ErrorStatistics, MatchHandComputedValues) {
  const ErrorStatistics statistics = SummarizeErrors({4.0, 1.0, 3.0, 2.0});
  EXPECT_DOUBLE_EQ(statistics.rmse, std::sqrt(30.0 / 4.0));
  EXPECT_DOUBLE_EQ(statistics.mean, 2.5);
  EXPECT_DOUBLE_EQ(statistics.median, 2.5);
  EXPECT_DOUBLE_EQ(statistics.max, 4.0);
  EXPECT_DOUBLE_EQ(SummarizeErrors({9.0, 1.0, 2.0}).median, 2.0);
}

TEST(ErrorStatistics, OfAnEmptyListAreZero) {
  const ErrorStatistics statistics = SummarizeErrors({});
  EXPECT_EQ(statistics.rmse, 0.0);
  EXPECT_EQ(statistics.mean, 0.0);
  EXPECT_EQ(statistics.median, 0.0);
  EXPECT_EQ(statistics.max, 0.0);
}

Trajectory Helix(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back({t, Rigid3(ExpSo3({0.0, 0.0, t}), {std::cos(t), std::sin(t), 0.2 * t})});
  }
  return trajectory;
}

Trajectory Moved(const Trajectory& trajectory, const Rigid3& motion, double scale) {
  Trajectory moved = trajectory;
  for (StampedPose& pose : moved) {
    pose.world_from_cam.translation *= scale;
    pose.world_from_cam = motion * pose.world_from_cam;
  }
  return moved;
}

TEST(Ate, IsInvariantUnderTheTransformsOfTheAlignment) {
  const Trajectory reference = Helix(50);
  const Rigid3 motion(ExpSo3({1.0, -0.5, 2.0}), {3.0, 4.0, -5.0});
  const AteResult rigid = EvaluateAte(reference, Moved(reference, motion, 1.0));
  ASSERT_TRUE(rigid.ok()) << rigid.failure;
  EXPECT_LT(rigid.errors.max, 1e-9);
  const Trajectory scaled = Moved(reference, motion, 0.5);
  EXPECT_GT(EvaluateAte(reference, scaled).errors.rmse, 0.1);
  const AteResult similar = EvaluateAte(reference, scaled, {.alignment = AlignmentKind::kSim3});
  EXPECT_LT(similar.errors.max, 1e-9);
  EXPECT_NEAR(similar.reference_from_estimate.scale, 2.0, 1e-9);
}

// The lengths of the estimate grow by a quarter on the way.
TEST(Ate, ScaleDriftIsThatOfTheLastTenthOverTheFirst) {
  const Trajectory reference = Helix(200);
  Trajectory estimate = Moved(reference, Rigid3(), 0.4);
  for (size_t i = 100; i < estimate.size(); ++i) {
    estimate[i].world_from_cam.translation *= 1.25;
  }
  const AteResult report = EvaluateAte(reference, estimate, {.alignment = AlignmentKind::kSim3});
  ASSERT_TRUE(report.scale_drift);
  EXPECT_NEAR(*report.scale_drift, 0.25, 1e-9);
  EXPECT_FALSE(EvaluateAte(reference, estimate).scale_drift) << "only with kSim3";
  const Trajectory few = Helix(29);
  EXPECT_FALSE(EvaluateAte(few, few, {.alignment = AlignmentKind::kSim3}).scale_drift);
}

TEST(Ate, WithoutAlignmentIsTheDistanceOfThePositions) {
  const Trajectory reference = Helix(10);
  const Trajectory shifted = Moved(reference, Rigid3({1, 0, 0, 0}, {0.0, 3.0, 4.0}), 1.0);
  const AteResult report = EvaluateAte(reference, shifted, {.alignment = AlignmentKind::kNone});
  EXPECT_NEAR(report.errors.rmse, 5.0, 1e-12);
  EXPECT_NEAR(report.errors.median, 5.0, 1e-12);
}

TEST(Ate, ReportsPairsAndCoverage) {
  const Trajectory reference = Helix(50);
  Trajectory estimate(reference.begin() + 10, reference.begin() + 30);
  for (int i = 0; i < 5; ++i) {
    estimate.push_back({100.0 + i, Rigid3()});
  }
  const AteResult report = EvaluateAte(reference, estimate);
  EXPECT_EQ(report.pairs, 20U);
  EXPECT_EQ(report.reference_poses, 50U);
  EXPECT_EQ(report.estimate_poses, 25U);
  EXPECT_DOUBLE_EQ(report.coverage, 0.8);
  EXPECT_NEAR(report.paired_span, 1.9, 1e-9);
}

TEST(Ate, SaysWhyThereIsNoError) {
  Trajectory late = Helix(10);
  for (StampedPose& pose : late) {
    pose.timestamp += 100.0;
  }
  EXPECT_NE(EvaluateAte(Helix(10), late).failure.find("within 0.02 s"), std::string::npos);
  EXPECT_NE(EvaluateAte(Helix(10), Helix(2)).failure.find("at least 3 pairs"), std::string::npos);
  EXPECT_FALSE(EvaluateAte({}, {}).ok());
  const std::string failure = EvaluateAte(Helix(10), late).failure;
  EXPECT_NE(failure.find("from 100.000 to 100.900 s"), std::string::npos) << failure;
  EXPECT_NE(failure.find("reference from 0.000 to 0.900 s"), std::string::npos) << failure;
}

// Stamps of another clock hit a few poses by chance.
TEST(Ate, AFewPairsByChanceAreNoEvaluation) {
  const Trajectory estimate = Helix(100);
  const auto hit = [&](size_t count) {
    Trajectory reference = estimate;
    for (size_t i = 0; i < reference.size(); ++i) {
      reference[i].timestamp += i % 10 == 0 && i / 10 < count ? 0.0 : 0.05;
    }
    return EvaluateAte(reference, estimate);
  };
  EXPECT_TRUE(hit(10).ok());
  const AteResult few = hit(9);
  EXPECT_EQ(few.pairs, 9U);
  EXPECT_NE(few.failure.find("only 9 of the 100 poses"), std::string::npos) << few.failure;
}

// Every `step`-th pose of 400 is known.
Trajectory Sparse(size_t step, size_t begin = 0, size_t end = 400) {
  const Trajectory all = Helix(400);
  Trajectory sparse;
  for (size_t i = begin; i < end; i += step) {
    sparse.push_back(all[i]);
  }
  return sparse;
}

TEST(Ate, ASparseReferenceIsEnoughIfEachOfItsPosesHasAPartner) {
  for (const size_t step : {12, 40, 100}) {
    const Trajectory reference = Sparse(step);
    const AteResult report = EvaluateAte(reference, Helix(400));
    EXPECT_TRUE(report.ok()) << report.failure;
    EXPECT_EQ(report.pairs, reference.size());
    EXPECT_LT(report.errors.rmse, 1e-9);
    EXPECT_EQ(DescribeMissingPairs(report), "");
  }
  // A reference that goes on for much longer has more poses than the estimate.
  const Trajectory all = Helix(40'000);
  Trajectory reference;
  for (size_t i = 0; i < all.size(); i += 15) {
    reference.push_back(all[i]);
  }
  const AteResult report = EvaluateAte(reference, Helix(400));
  EXPECT_TRUE(report.ok()) << report.failure;
  EXPECT_EQ(DescribeMissingPairs(report), "");
  // Half of a sparse reference has no partner: that is said.
  Trajectory half = Sparse(20);
  for (size_t i = 0; i < half.size(); i += 2) {
    half[i].timestamp += 0.05;
  }
  EXPECT_NE(DescribeMissingPairs(EvaluateAte(half, Helix(400))), "");
}

TEST(Ate, APieceOfTheEstimateIsNoEvaluationOfTheWhole) {
  EXPECT_TRUE(EvaluateAte(Sparse(1, 0, 50), Helix(400)).ok());
  EXPECT_FALSE(EvaluateAte(Sparse(1, 0, 39), Helix(400)).ok());
  EXPECT_FALSE(EvaluateAte(Sparse(10, 200, 231), Helix(400)).ok());
  EXPECT_TRUE(EvaluateAte(Sparse(10, 200, 260), Helix(400)).ok());
}

// 10 in place of 9.6 images per second: four poses of ten have a partner within 0.02 s.
TEST(Ate, StampsOfAnotherRateAreNoticed) {
  const Trajectory reference = Helix(100);
  Trajectory estimate = reference;
  EXPECT_EQ(DescribeMissingPairs(EvaluateAte(reference, estimate)), "");
  for (StampedPose& pose : estimate) {
    pose.timestamp *= 0.96;
  }
  const std::string missing = DescribeMissingPairs(EvaluateAte(reference, estimate));
  EXPECT_NE(missing.find("of the 96 poses during the ground truth"), std::string::npos) << missing;
}

struct Golden {
  const char* reference;
  const char* estimate;
  PairingRule pairing;
  size_t pairs;
  double scale;
  double rmse_se3;
  double rmse_sim3;

  // For the name of the test, which would have addresses in it.
  friend void PrintTo(const Golden& golden, std::ostream* out) {
    *out << golden.estimate << (golden.pairing == PairingRule::kTum ? " tum" : " evo");
  }
};

class GoldenAte : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenAte, IsReproduced) {
  const Golden& golden = GetParam();
  const auto reference_path = FindTestData(golden.reference);
  const auto estimate_path = FindTestData(golden.estimate);
  if (!reference_path || !estimate_path) {
    GTEST_SKIP() << "the golden trajectories are not on this machine; set HULLSLAM_DATA";
  }
  const Trajectory reference = ReadTrajectory(*reference_path);
  const Trajectory estimate = ReadTrajectory(*estimate_path);
  const AteResult rigid = EvaluateAte(reference, estimate, {.pairing = golden.pairing});
  const AteResult similar = EvaluateAte(
      reference, estimate, {.alignment = AlignmentKind::kSim3, .pairing = golden.pairing});
  EXPECT_EQ(rigid.pairs, golden.pairs);
  EXPECT_NEAR(rigid.errors.rmse, golden.rmse_se3, 1e-6);
  EXPECT_NEAR(similar.errors.rmse, golden.rmse_sim3, 1e-6);
  EXPECT_NEAR(similar.reference_from_estimate.scale, golden.scale, 1e-6);
}

constexpr const char* kDesk = "golden/fr2_desk_groundtruth.txt";
constexpr const char* kXyz = "fr1_xyz/groundtruth.txt";
constexpr const char* kDeskAll = "golden/fr2_desk_ORB.txt";
constexpr const char* kDeskMono = "golden/fr2_desk_ORB_kf_mono.txt";
constexpr const char* kXyzMono = "golden/freiburg1_xyz-ORB_kf_mono.txt";
constexpr const char* kXyzSlam = "golden/freiburg1_xyz-rgbdslam.txt";
constexpr PairingRule kTum = PairingRule::kTum;
constexpr PairingRule kEvo = PairingRule::kEvo;

INSTANTIATE_TEST_SUITE_P(
    Trajectories, GoldenAte,
    ::testing::Values(Golden{kDesk, kDeskAll, kTum, 2223, 0.997002, 0.008144, 0.006186},
                      Golden{kDesk, kDeskAll, kEvo, 2174, 0.996970, 0.008119, 0.006123},
                      Golden{kDesk, kDeskMono, kTum, 122, 2.228344, 0.948813, 0.007900},
                      Golden{kDesk, kDeskMono, kEvo, 118, 2.228022, 0.939049, 0.007729},
                      Golden{kXyz, kXyzMono, kTum, 32, 1.105622, 0.024302, 0.009755},
                      Golden{kXyz, kXyzMono, kEvo, 32, 1.105622, 0.024302, 0.009755},
                      Golden{kXyz, kXyzSlam, kTum, 786, 1.007924, 0.013473, 0.013394},
                      Golden{kXyz, kXyzSlam, kEvo, 785, 1.008001, 0.013470, 0.013389}));

// Each hundredth of a second more is a pose without partner, because the reference has a gap there.
TEST(Ate, NineOfTenPartnersAreEnough) {
  const auto described = [](size_t first_missing, size_t count) {
    Trajectory reference = Helix(100);
    const auto first = reference.begin() + static_cast<std::ptrdiff_t>(first_missing);
    reference.erase(first, first + static_cast<std::ptrdiff_t>(count));
    return DescribeMissingPairs(EvaluateAte(reference, Helix(100)));
  };
  EXPECT_EQ(described(40, 10), "");
  EXPECT_NE(described(40, 11).find("only 89 of the 100 poses"), std::string::npos);
  EXPECT_EQ(described(0, 50), "") << "poses before the ground truth can have no partner";
  EXPECT_EQ(described(50, 50), "") << "nor can those after it";
}

// Errors of one standard deviation in each of the six directions, in turn with both signs, so that
// the alignment cannot take them away: NEES is 1 for each pose.
TEST(Nees, IsTheSquaredErrorInStandardDeviations) {
  const Trajectory reference = Helix(120);
  const Rigid3 world_from_truth(ExpSo3({0.3, -0.2, 0.1}), {1.0, 2.0, 3.0});
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << 0.001, 0.002, 0.003, 0.004, 0.005, 0.006;
  const Eigen::Matrix<double, 6, 6> covariance = sigma.cwiseAbs2().asDiagonal();
  Trajectory estimate;
  for (size_t i = 0; i < reference.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i / 2 % 6);
    Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
    error[axis] = i % 2 == 0 ? sigma[axis] : -sigma[axis];
    const Rigid3 cam_from_world = Inverse(world_from_truth * reference[i].world_from_cam);
    estimate.push_back({reference[i].timestamp, Inverse(Retract(cam_from_world, error))});
  }
  std::vector<Eigen::Matrix<double, 6, 6>> covariances(estimate.size(), covariance);
  const NeesResult nees = EvaluateNees(reference, estimate, covariances);
  EXPECT_EQ(nees.poses, estimate.size());
  EXPECT_NEAR(nees.ratio.mean, 1.0 / 6.0, 0.01);
  // A third of the errors of each part is on an axis of that part, and half of all poses have one.
  EXPECT_NEAR(nees.rotation.mean, 1.0 / 6.0, 0.01);
  EXPECT_NEAR(nees.translation.mean, 1.0 / 6.0, 0.01);
  covariances[0].setZero();
  EXPECT_EQ(EvaluateNees(reference, estimate, covariances).poses, estimate.size() - 1);
}

// The same errors are in the true trajectory, and the estimate claims to be almost free of them.
TEST(Nees, TakesTheErrorOfTheTruthIntoAccount) {
  const Trajectory exact = Helix(120);
  const TruthErrors sigma = {.translation = 0.01, .rotation = 0.005};
  Trajectory reference;
  for (size_t i = 0; i < exact.size(); ++i) {
    Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
    const auto axis = static_cast<Eigen::Index>(i / 2 % 6);
    error[axis] = (i % 2 == 0 ? 1.0 : -1.0) * (axis < 3 ? sigma.rotation : sigma.translation);
    reference.push_back(
        {exact[i].timestamp, Inverse(Retract(Inverse(exact[i].world_from_cam), error))});
  }
  const std::vector<Eigen::Matrix<double, 6, 6>> covariances(
      exact.size(), 1e-10 * Eigen::Matrix<double, 6, 6>::Identity());
  EXPECT_GT(EvaluateNees(reference, exact, covariances).ratio.mean, 1e4);
  const NeesResult nees = EvaluateNees(reference, exact, covariances, sigma);
  EXPECT_NEAR(nees.ratio.mean, 1.0 / 6.0, 0.01);
  EXPECT_NEAR(nees.rotation.mean, 1.0 / 6.0, 0.01);
  EXPECT_NEAR(nees.translation.mean, 1.0 / 6.0, 0.01);
  EXPECT_THROW(EvaluateNees(reference, exact, covariances, {.translation = -1.0}), std::exception);
}

// The body of the true trajectory is turned and moved against the camera, and its clock is ahead.
TEST(Nees, FindsTheConstantErrorsOfTheTruth) {
  Trajectory exact;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.02 * i;  // after a time of this century, which has few digits left
    exact.push_back(
        {1.3e9 + t, Rigid3(ExpSo3({0.3 * std::sin(t), 0.2 * std::cos(1.7 * t), 0.1 * t}),
                           {std::sin(1.3 * t), std::cos(0.9 * t), 0.2 * t})});
  }
  const Rigid3 cam_from_body(ExpSo3({0.02, -0.01, 0.015}), {0.03, -0.02, 0.01});
  constexpr double kAhead = 0.004;
  Trajectory reference;
  for (const StampedPose& pose : exact) {
    reference.push_back({pose.timestamp + kAhead, pose.world_from_cam * cam_from_body});
  }
  const std::vector<Eigen::Matrix<double, 6, 6>> covariances(
      exact.size(), 1e-6 * Eigen::Matrix<double, 6, 6>::Identity());
  EXPECT_FALSE(EvaluateNees(reference, exact, covariances).offset);
  EXPECT_GT(EvaluateNees(reference, exact, covariances).ratio.mean, 10.0);
  const NeesResult nees = EvaluateNees(reference, exact, covariances, {.has_offset = true});
  EXPECT_LT(nees.ratio.mean, 0.01);
  ASSERT_TRUE(nees.offset);
  EXPECT_LT(Difference(nees.offset->cam_from_body, cam_from_body).norm(), 1e-3);
  EXPECT_NEAR(nees.offset->clock_ahead, kAhead, 1e-4);
}

// On a straight way nothing shows where the body is on the camera; the result stays finite.
TEST(Nees, FindsNoOffsetThatNothingShows) {
  Trajectory straight;
  for (int i = 0; i < 20; ++i) {
    straight.push_back({0.1 * i, Rigid3(Eigen::Quaterniond::Identity(), {0.1 * i, 0.0, 0.0})});
  }
  const std::vector<Eigen::Matrix<double, 6, 6>> covariances(
      straight.size(), 1e-6 * Eigen::Matrix<double, 6, 6>::Identity());
  const NeesResult nees = EvaluateNees(straight, straight, covariances, {.has_offset = true});
  EXPECT_LT(nees.ratio.max, 1e-9);
  ASSERT_TRUE(nees.offset);
  EXPECT_LT(nees.offset->cam_from_body.translation.norm(), 1e-6);
}

}  // namespace

}  // namespace hullslam
