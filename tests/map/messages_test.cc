// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/messages.h"

#include <gtest/gtest.h>

#include <variant>

namespace hullslam {
namespace {

// A default TrackedFrame must not look like one with a pose.
TEST(TrackedFrame, IsNotTrackedAtFirst) {
  const TrackedFrame frame;
  EXPECT_EQ(frame.state, TrackingState::kNotInitialized);
  EXPECT_FALSE(frame.frame.IsValid());
  EXPECT_FALSE(frame.from_keyframe.has_value());
  EXPECT_EQ(frame.inliers, 0);
}

TEST(TrackingState, HasANameForMessages) {
  EXPECT_EQ(ToString(TrackingState::kNotInitialized), "initialising");
  EXPECT_EQ(ToString(TrackingState::kTracked), "tracked");
  EXPECT_EQ(ToString(TrackingState::kLost), "lost");
}

TEST(KeyframeRequest, HasNoReferenceAtFirst) {
  const KeyframeRequest request;
  EXPECT_EQ(request.frame, nullptr);
  EXPECT_FALSE(request.pose.reference.IsValid());
  EXPECT_TRUE(request.landmarks.empty());
  EXPECT_TRUE(request.sightings.empty());
}

TEST(InitialMap, IsEmptyAtFirst) {
  const InitialMap initial;
  EXPECT_TRUE(initial.views.empty());
  EXPECT_TRUE(initial.points.empty());
  EXPECT_TRUE(InitialMap::Point().observations.empty());
}

TEST(MapCorrection, IsEmptyAtFirst) {
  const MapCorrection correction;
  EXPECT_EQ(correction.snapshot_corrections, 0u);
  EXPECT_TRUE(correction.poses.empty());
  EXPECT_TRUE(correction.positions.empty());
  EXPECT_TRUE(correction.landmarks.empty());
  EXPECT_TRUE(correction.objects.empty());
  EXPECT_FALSE(correction.loop.has_value());
  EXPECT_EQ(MapCorrection::Pose().corrected_cam_from_world.scale, 1.0);
}

TEST(MapMessage, HoldsAnyOfThreeMessages) {
  EXPECT_TRUE(std::holds_alternative<InitialMap>(MapMessage(InitialMap())));
  EXPECT_TRUE(std::holds_alternative<KeyframeRequest>(MapMessage(KeyframeRequest())));
  EXPECT_TRUE(std::holds_alternative<MapCorrection>(MapMessage(MapCorrection())));
}

TEST(FrameReport, IsEmptyAtFirst) {
  const FrameReport report;
  EXPECT_EQ(report.tracked.state, TrackingState::kNotInitialized);
  EXPECT_EQ(report.frame, nullptr);
  EXPECT_TRUE(report.landmarks.empty());
  EXPECT_TRUE(report.objects.empty());
}

TEST(FrameReport, NamesTheReasonWhyThereIsNoPose) {
  FrameReport report;
  EXPECT_EQ(report.Reason(), std::nullopt);
  report.loss = TrackingFailure::kTooFewFeatures;
  EXPECT_EQ(report.Reason(), ToString(TrackingFailure::kTooFewFeatures));
  report.loss.reset();
  report.failure = InitialisationFailure::kTooLittleParallax;
  EXPECT_EQ(report.Reason(), ToString(InitialisationFailure::kTooLittleParallax));
}

TEST(Sighting, IsZeroAtFirst) {
  const Sighting sighting;
  EXPECT_FALSE(sighting.landmark.IsValid());
  EXPECT_EQ(sighting.visible, 0);
  EXPECT_EQ(sighting.found, 0);
}

TEST(Odometry, HasNamesForFiles) {
  EXPECT_EQ(ToString(OdometryStep::kBegun), "begun");
  EXPECT_EQ(ToString(OdometryStep::kMeasured), "measured");
  EXPECT_EQ(ToString(OdometryStep::kPrior), "prior");
  EXPECT_EQ(ToString(OdometryStep::kPredicted), "predicted");
  EXPECT_EQ(ToString(OdometryStep::kStopped), "stopped");
  EXPECT_EQ(ToString(PriorUse::kNone), "none");
  EXPECT_EQ(ToString(PriorUse::kFused), "fused");
  EXPECT_EQ(ToString(PriorUse::kDropped), "dropped");
  EXPECT_EQ(ToString(PriorUse::kAlone), "alone");
}

}  // namespace
}  // namespace hullslam
