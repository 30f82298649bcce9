// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/evaluation_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace hullslam {
namespace {

bool Says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A camera that moves along x, and an estimate that is 0.01 m beside it.
TEST(TrajectoryErrorsText, HasTheErrorsOfTheJson) {
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d position(0.1 * i, 0.0, 0.0);
    reference.push_back({0.1 * i, Rigid3(Eigen::Quaterniond::Identity(), position)});
    estimate.push_back({0.1 * i, Rigid3(Eigen::Quaterniond::Identity(),
                                        position + Eigen::Vector3d(0.0, 0.01, 0.0))});
  }
  const TrajectoryErrors errors =
      EvaluateTrajectory(reference, estimate, {.alignment = AlignmentKind::kNone});
  ASSERT_TRUE(errors.ate.ok());
  EXPECT_TRUE(Says(TrajectoryErrorsText(errors), "ATE          rmse 0.010000"));
  EXPECT_TRUE(Says(TrajectoryErrorsText(errors), "pairs        30 (tum's rule within 0.02 s)"));
  EXPECT_TRUE(Says(TrajectoryErrorsText(errors), "alignment    none, scale 1.000000"));
  const auto json = nlohmann::json::parse(TrajectoryErrorsJson(errors));
  EXPECT_TRUE(json.is_object());
}

TEST(EvaluationText, HasTheErrorsOfTrueBodies) {
  TrueBody truth;
  truth.shape = "box";
  truth.body = {BodyKind::kBox, {}, {0.3, 0.2, 0.1}};
  MappedBody mapped;
  mapped.body = {BodyKind::kBox, {}, {0.33, 0.2, 0.1}};
  mapped.body.world_from_body.translation.z() = 0.02;
  const BodyEvaluation bodies = EvaluateBodies({truth}, {mapped});
  const std::string text = EvaluationText({}, AlignmentKind::kNone, std::nullopt, bodies);
  EXPECT_TRUE(Says(text, "boxes                   1.000 1.000     1.000  1.000 1.000     1.000"))
      << text;
  EXPECT_TRUE(
      Says(text, "box              1  0.750 0.750    20.0    10.0    0.0    0.0     0.0    3.3"))
      << text;
  const auto json = nlohmann::json::parse(EvaluationJson({}, std::nullopt, bodies))["truth"];
  EXPECT_NEAR(json["shapes"]["box"]["longest"].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(json["boxes"]["50"]["ap"], 1.0);
  EXPECT_EQ(json["each"].size(), 1U);
}

TEST(EvaluationText, ExplainsTheUnitOfAMapWithoutMetres) {
  EXPECT_TRUE(Says(EvaluationText({}, AlignmentKind::kSe3, std::nullopt),
                   "0 mapped, 0 not mapped; 0 observations"));
  EXPECT_TRUE(Says(EvaluationText({}, AlignmentKind::kSim3, std::nullopt),
                   "u is the unit of length of the map"));
}

}  // namespace
}  // namespace hullslam
