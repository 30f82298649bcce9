// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/system.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <utility>

#include "hullslam/map_files/map_file.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "map_files/invariants.h"
#include "objects/made_objects.h"
#include "support/expect_error.h"
#include "support/made_vocabulary.h"
#include "support/synthetic_world.h"
#include "support/temporary_folder.h"
#include "system/prefetcher.h"

namespace hullslam {
namespace {

constexpr double kWallDistance = 2.0;    // m in front of the first camera
constexpr double kTexelsPerMetre = 260;  // about the resolution of the image at the wall

// A wall of random patches, photographed by a moving camera.
class Wall {
 public:
  explicit Wall(int seed = 3) : texture_(900, 1200, CV_8UC3) {
    texture_.setTo(cv::Scalar::all(120));
    cv::RNG random(seed);
    for (int i = 0; i < 4000; ++i) {
      const cv::Rect box(random.uniform(0, texture_.cols - 40), random.uniform(0, 860),
                         random.uniform(5, 40), random.uniform(5, 40));
      texture_(box).setTo(
          cv::Scalar(random.uniform(0, 256), random.uniform(0, 256), random.uniform(0, 256)));
    }
    cv::GaussianBlur(texture_, texture_, {3, 3}, 0.8);
  }

  static SystemOptions Options() {
    SystemOptions options;
    options.camera = {.fx = 520.0, .fy = 520.0, .cx = 319.5, .cy = 239.5, .bf = 40.0};
    options.features.feature_count = 600;
    return options;
  }

  // Moves 1.5 cm per frame to the right and up, and rotates a little.
  static Rigid3 CamFromWorld(int index) {
    const Eigen::Vector3d center(0.015 * index, -0.006 * index, 0.004 * index);
    const Eigen::Quaterniond rotation = ExpSo3({0.0, -0.005 * index, 0.002 * index});
    return {rotation, -(rotation * center)};
  }

  // Colour image, channels in the order blue, green, red.
  cv::Mat Photograph(int index) const {
    const PinholeCamera camera = Options().camera;
    Eigen::Matrix3d calibration = Eigen::Matrix3d::Identity();
    calibration.diagonal() << camera.fx, camera.fy, 1.0;
    calibration.col(2) << camera.cx, camera.cy, 1.0;
    const Eigen::Matrix<double, 3, 4> pose = CamFromWorld(index).ToMatrix();
    Eigen::Matrix3d cam_from_wall;  // of (x, y, 1) on the wall
    cam_from_wall << pose.col(0), pose.col(1), kWallDistance * pose.col(2) + pose.col(3);
    Eigen::Matrix3d texel_from_wall = Eigen::Matrix3d::Identity();
    texel_from_wall.diagonal() << kTexelsPerMetre, kTexelsPerMetre, 1.0;
    texel_from_wall.col(2) << 0.5 * texture_.cols, 0.5 * texture_.rows, 1.0;
    const Eigen::Matrix3d pixel_from_texel =
        calibration * cam_from_wall * texel_from_wall.inverse();
    cv::Matx33d homography;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        homography(row, column) = pixel_from_texel(row, column);
      }
    }
    cv::Mat image;
    cv::warpPerspective(texture_, image, homography, {camera.width, camera.height});
    return image;
  }

  // Metres, CV_32FC1.
  static cv::Mat Depth(int index) {
    const PinholeCamera camera = Options().camera;
    const Rigid3 world_from_cam = Inverse(CamFromWorld(index));
    cv::Mat depth(camera.height, camera.width, CV_32FC1);
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        const Eigen::Vector3d ray = world_from_cam.rotation * camera.Unproject({x, y}, 1.0);
        depth.at<float>(y, x) =
            static_cast<float>((kWallDistance - world_from_cam.translation.z()) / ray.z());
      }
    }
    return depth;
  }

 private:
  cv::Mat texture_;
};

const Wall& TheWall() {
  static const Wall wall;
  return wall;
}

double Time(int index) { return 100.0 + index / 30.0; }

TrackedFrame TrackFrame(System& system, int index) {
  return system.Track(Time(index), TheWall().Photograph(index), Wall::Depth(index));
}

double MaxError(const Trajectory& trajectory) {
  double error = 0.0;
  for (const StampedPose& pose : trajectory) {
    const int index = static_cast<int>(std::lround((pose.timestamp - Time(0)) * 30.0));
    const Rigid3 truth = Inverse(Wall::CamFromWorld(index));
    error = std::max(error, (pose.world_from_cam.translation - truth.translation).norm());
  }
  return error;
}

class SystemTest : public testing::TestWithParam<PipelineKind> {};

std::vector<TrackedFrame> CopyOfFrames(const System& system) {
  const std::span<const TrackedFrame> frames = system.frames();
  return {frames.begin(), frames.end()};
}

TEST_P(SystemTest, TracksACameraAlongAWall) {
  System system(Wall::Options(), GetParam());
  EXPECT_EQ(system.map(), nullptr);
  EXPECT_TRUE(system.trajectory().empty());
  for (int i = 0; i < 15; ++i) {
    const TrackedFrame frame = TrackFrame(system, i);
    EXPECT_EQ(frame.state, TrackingState::kTracked) << i;
    EXPECT_EQ(frame.timestamp, Time(i));
    EXPECT_EQ(frame.frame, FrameId(static_cast<uint32_t>(i)));
  }
  system.Finish();
  system.Finish();
  EXPECT_EQ(FindViolations(*system.map()), std::vector<std::string>());
  EXPECT_EQ(system.frames().size(), 15u);
  const Trajectory trajectory = system.trajectory();
  ASSERT_EQ(trajectory.size(), 15u);
  EXPECT_LT(MaxError(trajectory), 0.01) << "of 0.25 m travelled";
  EXPECT_EQ(system.times().samples().at("track").size(), 15u);
  EXPECT_EQ(system.times().samples().at("frame").size(), 15u);
}

TEST_P(SystemTest, FinishAdjustsTheWholeMapUnlessCancelled) {
  SystemOptions options = Wall::Options();
  options.mapping.final_bundle_adjustment = true;
  for (const bool is_cancelled : {false, true}) {
    System system(options, GetParam());
    for (int i = 0; i < 15; ++i) {
      TrackFrame(system, i);
    }
    Cancellation cancellation;
    if (is_cancelled) {
      cancellation.Request();
    }
    int iterations = 0;
    int poses = 0;
    const std::vector<TrackedFrame> before = CopyOfFrames(system);
    system.Finish(
        &cancellation, [&](int done, int) { iterations = done; },
        [&](int done, int most) {
          EXPECT_EQ(done, ++poses);
          EXPECT_EQ(most, 15);
        });
    const bool is_adjusted = !is_cancelled && system.map()->keyframes().size() > 1;
    EXPECT_EQ(system.times().samples().contains("global_bundle_adjustment"), is_adjusted);
    EXPECT_EQ(iterations > 0, is_adjusted);
    EXPECT_EQ(poses, is_cancelled ? 0 : 15);
    for (size_t i = 0; is_cancelled && i < before.size(); ++i) {
      const std::optional<RelativePose>& pose = system.frames()[i].from_keyframe;
      ASSERT_EQ(pose.has_value(), before[i].from_keyframe.has_value());
      EXPECT_TRUE(!pose || pose->cam_from_reference.translation ==
                               before[i].from_keyframe->cam_from_reference.translation);
    }
    ASSERT_EQ(system.trajectory().size(), 15u);
    EXPECT_LT(MaxError(system.trajectory()), 0.01);
  }
}

// The poses are computed from the final positions of the landmarks.
TEST_P(SystemTest, FinishComputesThePosesOfFramesAgain) {
  System system(Wall::Options(), GetParam());
  for (int i = 0; i < 15; ++i) {
    TrackFrame(system, i);
  }
  const std::vector<TrackedFrame> before = CopyOfFrames(system);
  system.Finish();
  int changed = 0;
  for (size_t i = 0; i < before.size(); ++i) {
    const TrackedFrame& after = system.frames()[i];
    ASSERT_EQ(after.from_keyframe.has_value(), before[i].from_keyframe.has_value());
    EXPECT_EQ(after.inliers, before[i].inliers);
    changed += after.from_keyframe && after.from_keyframe->cam_from_reference.translation !=
                                          before[i].from_keyframe->cam_from_reference.translation;
  }
  EXPECT_GT(changed, 0);
}

TEST_P(SystemTest, FinishLeavesThePosesOfFramesAsTheyAreIfAsked) {
  SystemOptions options = Wall::Options();
  options.tracking.refine_at_end = false;
  System system(options, GetParam());
  for (int i = 0; i < 15; ++i) {
    TrackFrame(system, i);
  }
  const std::vector<TrackedFrame> before = CopyOfFrames(system);
  system.Finish();
  for (size_t i = 0; i < before.size(); ++i) {
    if (before[i].from_keyframe) {
      EXPECT_EQ(system.frames()[i].from_keyframe->cam_from_reference.translation,
                before[i].from_keyframe->cam_from_reference.translation);
    }
  }
}

TEST_P(SystemTest, MayBeDestroyedWithoutFinish) {
  System system(Wall::Options(), GetParam());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(TrackFrame(system, i).state, TrackingState::kTracked);
  }
}

TEST_P(SystemTest, ABlankFirstImageOnlyDelaysTheStart) {
  System system(Wall::Options(), GetParam());
  const cv::Mat blank(480, 640, CV_8UC3, cv::Scalar::all(128));
  EXPECT_EQ(system.Track(Time(0), blank, Wall::Depth(0)).state, TrackingState::kNotInitialized);
  EXPECT_EQ(TrackFrame(system, 1).state, TrackingState::kTracked);
  EXPECT_EQ(TrackFrame(system, 2).state, TrackingState::kTracked);
  EXPECT_EQ(system.trajectory().size(), 2u);
}

TEST_P(SystemTest, ResetGivesAnEmptySystem) {
  System system(Wall::Options(), GetParam());
  size_t reports = 0;
  system.SetFrameCallback([&](const FrameReport&) { ++reports; });
  for (int i = 0; i < 6; ++i) {
    TrackFrame(system, i);
  }
  const std::shared_ptr<const Map> before = system.map();
  const size_t landmarks = before->landmarks().size();
  for (const bool is_finished : {false, true}) {
    if (is_finished) {
      system.Finish();
    }
    system.Reset();
    EXPECT_EQ(system.map(), nullptr);
    EXPECT_TRUE(system.frames().empty());
    EXPECT_TRUE(system.trajectory().empty());
    EXPECT_TRUE(system.times().samples().empty());
    EXPECT_EQ(system.object_counts().frames_without_masks, 0u);
    for (int i = 0; i < 6; ++i) {  // the time stamps begin again
      const TrackedFrame frame = TrackFrame(system, i);
      EXPECT_EQ(frame.state, TrackingState::kTracked) << i;
      EXPECT_EQ(frame.frame, FrameId(static_cast<uint32_t>(i)));
    }
  }
  EXPECT_EQ(before->landmarks().size(), landmarks) << "an old snapshot is not changed";
  EXPECT_EQ(reports, 18u) << "the callback is kept";
  system.Finish();
  EXPECT_LT(MaxError(system.trajectory()), 0.01);
}

// In real time, too few frames may become keyframes.
class WaitingSystemTest : public SystemTest {};
INSTANTIATE_TEST_SUITE_P(All, WaitingSystemTest,
                         testing::Values(PipelineKind::kSequential, PipelineKind::kThreaded));

// Frames that were tracked before the switch may enter the map after it, and keyframes may leave
// it, so the frames of the keyframes are looked at and not their number.
TEST_P(WaitingSystemTest, LocalizationIsSwitchedBetweenFrames) {
  System system(Wall::Options(), GetParam());
  EXPECT_THROW(system.SetLocalizationOnly(true), CheckError) << "there is no map yet";
  EXPECT_FALSE(system.is_localization_only());
  const auto track = [&](int first, int end) {
    for (int i = first; i < end; ++i) {
      EXPECT_EQ(TrackFrame(system, i).state, TrackingState::kTracked) << i;
    }
  };
  const auto keyframes = [&](uint32_t first, uint32_t end) {
    size_t count = 0;
    for (uint32_t frame = first; frame < end; ++frame) {
      count += system.map()->KeyframeOfFrame(FrameId(frame)) ? 1 : 0;
    }
    return count;
  };
  track(0, 6);
  system.SetLocalizationOnly(true);
  EXPECT_TRUE(system.is_localization_only());
  track(6, 26);
  system.SetLocalizationOnly(false);
  track(26, 36);
  system.SetLocalizationOnly(true);
  track(36, 42);
  system.SetLocalizationOnly(false);
  track(42, 56);
  system.Finish();
  EXPECT_GT(keyframes(0, 6), 0u);
  EXPECT_EQ(keyframes(6, 26), 0u);
  EXPECT_GT(keyframes(26, 36), 0u);
  EXPECT_EQ(keyframes(36, 42), 0u);
  EXPECT_GT(keyframes(42, 56), 0u);
  EXPECT_EQ(system.trajectory().size(), 56u);
  EXPECT_LT(MaxError(system.trajectory()), 0.02);
  system.SetLocalizationOnly(true);
  system.Reset();
  EXPECT_FALSE(system.is_localization_only());
}

// No frame can be found in the loaded map yet.
TEST_P(SystemTest, BeginsWithTheMapOfAnEarlierSession) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map";
  {
    System first(Wall::Options(), GetParam(), {.session_name = "first"});
    for (int i = 0; i < 6; ++i) {
      TrackFrame(first, i);
    }
    first.Finish();
    WriteMap(path, *first.map(), MapSettingsOf(Wall::Options()));
  }
  SystemStart start{.map = ReadMap(path, Wall::Options()), .session_name = "second"};
  ASSERT_EQ(start.map.sessions(), (std::vector<Session>{{"first", FrameId(0)}}));
  const FrameId next = start.map.NextFrame();
  const size_t landmarks = start.map.landmarks().size();
  System second(Wall::Options(), GetParam(), std::move(start));
  for (int run = 0; run < 2; ++run) {
    ASSERT_NE(second.map(), nullptr);
    for (int i = 0; i < 3; ++i) {  // the time stamps begin before the last one of the map
      const TrackedFrame frame = TrackFrame(second, i);
      EXPECT_EQ(frame.state, TrackingState::kLost);
      EXPECT_EQ(frame.frame, FrameId(next.value + static_cast<uint32_t>(i)));
    }
    EXPECT_EQ(second.map()->landmarks().size(), landmarks);
    EXPECT_EQ(second.map()->sessions().size(), 1u);
    EXPECT_TRUE(second.trajectory().empty());
    second.Reset();
  }
}

// Words can be compared if the vocabularies have the same content, in one object or in two.
TEST(System, VocabulariesAreComparedByTheirContent) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map";
  SystemOptions options = Wall::Options();
  options.vocabulary = SharedVocabulary();
  {
    System first(options, PipelineKind::kSequential);
    for (int i = 0; i < 6; ++i) {
      TrackFrame(first, i);
    }
    first.Finish();
    WriteMap(path, *first.map(), MapSettingsOf(options));
  }
  const auto begin = [](const SystemOptions& with, Map map) {
    System system(with, PipelineKind::kSequential, {.map = std::move(map)});
    return TrackFrame(system, 2).state;
  };
  SystemOptions again = options;
  again.vocabulary = SharedVocabulary();
  ASSERT_NE(again.vocabulary, options.vocabulary);
  EXPECT_EQ(begin(again, ReadMap(path, options)), TrackingState::kTracked);
  again.vocabulary = SharedVocabulary(3, 3);
  ExpectInputError([&] { begin(again, ReadMap(path, options)); }, {"vocabulary", "the same"});
  again.vocabulary = nullptr;
  ExpectInputError([&] { begin(again, ReadMap(path, options)); }, {"vocabulary", "not set"});
  ExpectInputError([&] { begin(options, ReadMap(path).map); }, {"ReadMap(path, options)"});
}

INSTANTIATE_TEST_SUITE_P(All, SystemTest,
                         testing::Values(PipelineKind::kSequential, PipelineKind::kThreaded,
                                         PipelineKind::kRealtime));

TEST(System, TheSameImagesGiveTheSameBits) {
  const auto run = [] {
    System system(Wall::Options(), PipelineKind::kSequential);
    for (int i = 0; i < 10; ++i) {
      TrackFrame(system, i);
    }
    return system.trajectory();
  };
  const Trajectory a = run();
  const Trajectory b = run();
  ASSERT_EQ(a.size(), 10u);
  ASSERT_EQ(b.size(), 10u);
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].timestamp, b[i].timestamp);
    EXPECT_EQ(a[i].world_from_cam.rotation.coeffs(), b[i].world_from_cam.rotation.coeffs());
    EXPECT_EQ(a[i].world_from_cam.translation, b[i].world_from_cam.translation);
  }
}

// So the memory that a run needs for its frames does not depend on its length. Lost frames follow,
// because they take little time.
TEST(System, OnlyTheLastFramesAreKeptForFinish) {
  System system(Wall::Options(), PipelineKind::kSequential);
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(TrackFrame(system, i).state, TrackingState::kTracked);
  }
  const auto pose_of = [&](size_t i) {
    return system.frames()[i].from_keyframe.value().cam_from_reference.translation;
  };
  const std::vector<TrackedFrame> before = CopyOfFrames(system);
  const auto is_refined = [&](size_t i) {
    return pose_of(i) != before[i].from_keyframe.value().cam_from_reference.translation;
  };
  size_t count = before.size();
  const auto lose_frames = [&](size_t until) {
    for (; count < until; ++count) {
      BuiltFrame built;
      built.frame = std::make_unique<Frame>();
      built.frame->timestamp = Time(static_cast<int>(count));
      EXPECT_EQ(system.Track(std::move(built)).state, TrackingState::kLost);
    }
  };
  lose_frames(5000);
  EXPECT_FALSE(is_refined(8));
  lose_frames(5009);
  EXPECT_TRUE(is_refined(8));
  EXPECT_FALSE(is_refined(9));
  const Eigen::Vector3d refined = pose_of(8);
  system.Finish();
  EXPECT_EQ(pose_of(8), refined);
  EXPECT_TRUE(is_refined(9));
  EXPECT_EQ(system.trajectory().size(), 10u);
  EXPECT_LT(MaxError(system.trajectory()), 0.01);
}

// The frames themselves and the times of their stages are kept in bounded memory too.
TEST(System, AFrameOfALongRunTakesNoMemory) {
  for (const PipelineKind kind : {PipelineKind::kSequential, PipelineKind::kThreaded}) {
    System system(Wall::Options(), kind);
    ASSERT_EQ(TrackFrame(system, 0).state, TrackingState::kTracked);
    const auto heap_after = [&](size_t frames) {
      for (size_t i = system.frames().size(); i < frames; ++i) {
        BuiltFrame built;
        built.frame = std::make_unique<Frame>();
        built.frame->timestamp = Time(static_cast<int>(i));
        system.Track(std::move(built));
      }
      const struct mallinfo2 info = mallinfo2();
      return static_cast<double>(info.uordblks + info.hblkhd);
    };
    const double before = heap_after(12000);
    const double grown = heap_after(30000) - before;
    EXPECT_LT(grown / 18000.0, 8.0) << "bytes a frame";
    ASSERT_EQ(system.frames().size(), 30000u);
    EXPECT_EQ(system.frames()[0].state, TrackingState::kTracked);
    EXPECT_EQ(system.frames()[29999].timestamp, Time(29999));
    system.Finish();
    EXPECT_EQ(system.trajectory().size(), 1u);
  }
}

// A square in front of the wall, so that objects are part of the comparison.
std::vector<InstanceMask> SquareMask() {
  return {{.label = "cup",
           .outlines = {{{250.0, 180.0}, {390.0, 180.0}, {390.0, 300.0}, {250.0, 300.0}}}}};
}

TEST(System, ARunAfterResetGivesTheBitsOfANewSystem) {
  const auto run = [](System& system, int first) {
    for (int i = first; i < first + 10; ++i) {
      system.Track(Time(i), TheWall().Photograph(i), Wall::Depth(i), SquareMask());
    }
    system.Finish();
  };
  System fresh(Wall::Options(), PipelineKind::kSequential);
  run(fresh, 0);
  System used(Wall::Options(), PipelineKind::kSequential);
  run(used, 20);
  used.Reset();
  run(used, 0);
  const Trajectory expected = fresh.trajectory();
  const Trajectory trajectory = used.trajectory();
  ASSERT_EQ(trajectory.size(), expected.size());
  for (size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(trajectory[i].timestamp, expected[i].timestamp);
    EXPECT_EQ(trajectory[i].world_from_cam.ToMatrix(), expected[i].world_from_cam.ToMatrix());
  }
  ASSERT_EQ(used.map()->landmarks().size(), fresh.map()->landmarks().size());
  for (const auto& [id, landmark] : fresh.map()->landmarks()) {
    EXPECT_EQ(used.map()->landmarks().At(id).position, landmark.position);
  }
  ASSERT_EQ(used.map()->objects().size(), fresh.map()->objects().size());
  EXPECT_FALSE(fresh.map()->objects().empty());
  for (const auto& [id, object] : fresh.map()->objects()) {
    EXPECT_EQ(used.map()->objects().At(id).ellipsoid.half_axes, object.ellipsoid.half_axes);
  }
  EXPECT_EQ(used.object_counts().detections, fresh.object_counts().detections);
  EXPECT_EQ(used.object_counts().rejections, fresh.object_counts().rejections);
}

ImageInput GreyInput(int index) {
  ImageInput input{Time(index), {}, Wall::Depth(index), SquareMask()};
  cv::cvtColor(TheWall().Photograph(index), input.grey, cv::COLOR_RGB2GRAY);
  return input;
}

TEST(System, FramesBuiltAheadByAnotherThreadGiveTheSameBits) {
  constexpr int kFrames = 10;
  System plain(Wall::Options(), PipelineKind::kSequential);
  for (int i = 0; i < kFrames; ++i) {
    plain.Track(GreyInput(i));
  }
  plain.Finish();
  System ahead(Wall::Options(), PipelineKind::kSequential);
  {
    Prefetcher<BuiltFrame> frames(
        [&ahead, next = 0]() mutable {
          return next < kFrames ? std::optional(ahead.Build(GreyInput(next++))) : std::nullopt;
        },
        4);
    while (std::optional<BuiltFrame> frame = frames.Next()) {
      ahead.Track(std::move(*frame));
    }
  }
  ahead.Finish();
  const Trajectory expected = plain.trajectory();
  const Trajectory trajectory = ahead.trajectory();
  ASSERT_EQ(trajectory.size(), expected.size());
  for (size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(trajectory[i].timestamp, expected[i].timestamp);
    EXPECT_EQ(trajectory[i].world_from_cam.ToMatrix(), expected[i].world_from_cam.ToMatrix());
  }
  EXPECT_EQ(ahead.object_counts().detections, plain.object_counts().detections);
  EXPECT_EQ(ahead.object_counts().frames_with_masks, static_cast<size_t>(kFrames));
}

TEST(System, AFrameThatIsOnlyBuiltChangesNothing) {
  System system(Wall::Options(), PipelineKind::kSequential);
  system.Build(GreyInput(0));
  EXPECT_TRUE(system.frames().empty());
  EXPECT_TRUE(system.times().samples().empty());
  EXPECT_EQ(system.object_counts().frames_with_masks, 0u);
  EXPECT_EQ(system.Track(system.Build(GreyInput(1))).frame, FrameId(0));
  EXPECT_EQ(system.object_counts().frames_with_masks, 1u);
  EXPECT_THROW(system.Track(system.Build(GreyInput(1))), CheckError) << "the same time stamp";
}

// In real time the user also waits while a built frame waits to be tracked. At full speed frames
// may be built long before they are tracked, so this time does not count.
TEST(System, TrackTimesCountWaitingOnlyInRealTime) {
  constexpr std::chrono::milliseconds kWait(50);
  for (const PipelineKind kind : {PipelineKind::kThreaded, PipelineKind::kRealtime}) {
    System system(Wall::Options(), kind);
    BuiltFrame built = system.Build(GreyInput(0));
    built.begin -= kWait;
    system.Track(std::move(built));
    system.Finish();
    const auto times = system.times();
    const auto sample = [&](const char* stage) { return times.samples().at(stage).at(0); };
    const double work = sample("frame") + sample("pose");
    if (kind == PipelineKind::kRealtime) {
      EXPECT_GE(sample("track"), work + kWait.count());
    } else {
      EXPECT_EQ(sample("track"), work);
    }
  }
}

TEST(System, OptionsThatDoNotFitTogetherAreRefused) {
  ExpectInputError([] { System system(SystemOptions(), PipelineKind::kSequential); },
                   {"Camera.fx"});
}

TEST(System, TimeStampsThatDoNotIncreaseAreRefused) {
  System system(Wall::Options(), PipelineKind::kSequential);
  const cv::Mat image = TheWall().Photograph(0);
  const cv::Mat depth = Wall::Depth(0);
  EXPECT_THROW(system.Track(std::numeric_limits<double>::quiet_NaN(), image, depth), CheckError);
  EXPECT_THROW(system.Track(1305031102175304000.0, image, depth), CheckError) << "nanoseconds";
  system.Track(10.0, image, depth);
  for (const double time : {10.0, 9.9, -10.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(system.Track(time, image, depth), CheckError) << time;
  }
  try {
    system.Track(9.9, image, depth);
  } catch (const CheckError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("9.900000 s"), std::string::npos) << what;
    EXPECT_NE(what.find("10.000000 s"), std::string::npos) << what;
  }
  EXPECT_EQ(system.frames().size(), 1u);
  EXPECT_EQ(system.Track(10.1, image, depth).state, TrackingState::kTracked)
      << "a refused image changes nothing";
}

TEST(System, ImagesOfAnotherTypeOrSizeAreRefused) {
  System system(Wall::Options(), PipelineKind::kSequential);
  const cv::Mat image = TheWall().Photograph(0);
  const cv::Mat depth = Wall::Depth(0);
  for (const int type : {CV_8UC2, CV_16UC1, CV_32FC1, CV_32FC3}) {
    EXPECT_THROW(system.Track(1.0, cv::Mat(480, 640, type, cv::Scalar::all(9)), depth), InputError)
        << type;
  }
  for (const int type : {CV_8UC1, CV_16SC1, CV_64FC1, CV_16UC3}) {
    EXPECT_THROW(system.Track(1.0, image, cv::Mat(480, 640, type, cv::Scalar::all(9))), InputError)
        << type;
  }
  EXPECT_THROW(system.Track(1.0, cv::Mat(), depth), InputError);
  EXPECT_THROW(system.Track(1.0, image, cv::Mat()), InputError);
  ExpectInputError([&] { system.Track(1.0, image(cv::Rect(0, 0, 320, 240)), depth); },
                   {"320x240", "640x480", "Camera.width"});
  ExpectInputError([&] { system.Track(1.0, image, depth(cv::Rect(0, 0, 320, 200))); },
                   {"depth", "320x200", "640x480"});
  EXPECT_TRUE(system.frames().empty());
  EXPECT_EQ(system.Track(1.0, image, depth).state, TrackingState::kTracked);
}

TEST(System, MasksThatCannotBeUsedAreRefused) {
  System system(Wall::Options(), PipelineKind::kSequential);
  const cv::Mat image = TheWall().Photograph(0);
  const cv::Mat depth = Wall::Depth(0);
  const InstanceMask good = {
      .label = "cup",
      .outlines = {{{100.0, 100.0}, {200.0, 100.0}, {200.0, 200.0}, {100.0, 200.0}}}};
  const auto refuse = [&](const auto& change, const std::vector<std::string>& parts) {
    InstanceMask mask = good;
    change(mask);
    ExpectInputError([&] { system.Track(1.0, image, depth, {good, mask}); }, parts);
  };
  refuse([](InstanceMask& mask) { mask.label.clear(); }, {"mask 1", "label"});
  refuse([](InstanceMask& mask) { mask.score = 7.0; }, {"mask 1", "score is 7"});
  refuse([](InstanceMask& mask) { mask.outlines[0].resize(1); }, {"mask 1", "1 point"});
  refuse([](InstanceMask& mask) { mask.outlines[0][2].x() = std::nan(""); }, {"mask 1", "nan"});
  EXPECT_TRUE(system.frames().empty());
  EXPECT_EQ(system.Track(1.0, image, depth, {good}).state, TrackingState::kTracked);
}

// The detections of a keyframe; empty if the frame is none.
std::vector<Detection> DetectionsOfKeyframe(const System& system, FrameId frame) {
  const auto keyframe = system.map()->KeyframeOfFrame(frame);
  return keyframe ? system.map()->keyframes().At(*keyframe).frame->detections
                  : std::vector<Detection>();
}

TEST_P(SystemTest, MasksThatComeLateGiveTheDetectionsOfMasksInTime) {
  System in_time(Wall::Options(), GetParam());
  in_time.Track(Time(0), TheWall().Photograph(0), Wall::Depth(0), SquareMask());
  in_time.Finish();
  const std::vector<Detection> expected = DetectionsOfKeyframe(in_time, FrameId(0));
  ASSERT_EQ(expected.size(), 1u);

  System system(Wall::Options(), GetParam());
  system.AwaitMasks(true);
  cv::Mat depth = Wall::Depth(0);
  const TrackedFrame first = system.Track(Time(0), TheWall().Photograph(0), depth);
  depth.setTo(0);  // the caller's image may be overwritten
  for (int i = 1; i < 5; ++i) {
    TrackFrame(system, i);
  }
  EXPECT_TRUE(system.AddMasks(first.frame, SquareMask()));
  EXPECT_FALSE(system.AddMasks(first.frame, SquareMask())) << "for the second time";
  EXPECT_FALSE(system.AddMasks(FrameId(77), SquareMask())) << "no such frame";
  EXPECT_EQ(system.object_counts().frames_with_masks, 1u);
  system.Finish();
  const std::vector<Detection> late = DetectionsOfKeyframe(system, first.frame);
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late[0].hull, expected[0].hull);
  EXPECT_EQ(late[0].keypoints, expected[0].keypoints);
  EXPECT_EQ(late[0].points.Unpack(), expected[0].points.Unpack());
  EXPECT_EQ(FindViolations(*system.map()), std::vector<std::string>());
}

TEST_P(SystemTest, AFrameWhoseLateMasksShowAnObjectBecomesAKeyframe) {
  System system(Wall::Options(), GetParam());
  TrackFrame(system, 0);
  system.AwaitMasks(true);
  const FrameId second = TrackFrame(system, 1).frame;
  ASSERT_FALSE(system.map()->KeyframeOfFrame(second).has_value());
  EXPECT_TRUE(system.AddMasks(second, SquareMask()));
  system.Finish();
  EXPECT_EQ(DetectionsOfKeyframe(system, second).size(), 1u);
  EXPECT_EQ(FindViolations(*system.map()), std::vector<std::string>());
}

TEST_P(SystemTest, ObjectsAreNamedLockedSizedAndDeletedAndFilesKeepIt) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map";
  {
    System system(Wall::Options(), GetParam());
    ExpectInputError([&] { system.NameObject(ObjectId(0), "a"); }, {"no object 0"});
    system.Track(Time(0), TheWall().Photograph(0), Wall::Depth(0), SquareMask());
    ASSERT_TRUE(system.map()->objects().Contains(ObjectId(0)));
    system.NameObject(ObjectId(0), "poster");
    system.LockObject(ObjectId(0), true);
    system.SetObjectSize(ObjectId(0), 0.3);
    ExpectInputError([&] { system.SetObjectSize(ObjectId(7), 0.3); }, {"no object 7"});
    for (const double wrong : {-0.3, 1e-4, 100.5, std::nan(""), HUGE_VAL}) {
      ExpectInputError([&] { system.SetObjectSize(ObjectId(0), wrong); },
                       {"object 0", fmt::format("{:g} m", wrong), "0.001 to 100 m"});
    }
    ExpectInputError([&] { system.LockObject(ObjectId(7), true); }, {"no object 7"});
    ExpectInputError([&] { system.DeleteObject(ObjectId(7)); }, {"no object 7"});
    ExpectInputError([&] { system.NameObject(ObjectId(0), "a\tb"); }, {"a?b", "object 0"});
    system.Finish();
    EXPECT_THROW(system.DeleteObject(ObjectId(0)), CheckError);
    WriteMap(path, *system.map(), MapSettingsOf(Wall::Options()));
  }
  System later(Wall::Options(), GetParam(),
               {.map = ReadMap(path, Wall::Options()), .localization_only = true});
  EXPECT_EQ(later.map()->objects().At(ObjectId(0)).name, "poster");
  EXPECT_TRUE(later.map()->objects().At(ObjectId(0)).is_locked);
  EXPECT_EQ(later.map()->objects().At(ObjectId(0)).known_size, 0.3);
  later.NameObject(ObjectId(0), "");
  later.LockObject(ObjectId(0), false);
  later.DeleteObject(ObjectId(0));
  later.Finish();
  EXPECT_TRUE(later.map()->objects().empty());
  EXPECT_EQ(FindViolations(*later.map()), std::vector<std::string>());
  later.Reset();
  EXPECT_EQ(later.map()->objects().At(ObjectId(0)).name, "poster");
}

// A monocular camera that moves around a cup, whose longest side is 0.8 m.
class CupRun {
 public:
  explicit CupRun(PipelineKind kind, SystemStart start = {})
      : system_(Options(), kind, std::move(start)) {
    system_.SetFrameCallback([this](const FrameReport& report) { Count(report.events); });
  }
  static SystemOptions Options() {
    SystemOptions options;
    options.camera = SyntheticSensor().camera;
    options.sensor = SensorKind::kMonocular;
    static const auto vocabulary = SharedVocabulary(8, 3);  // for relocalisation
    options.vocabulary = vocabulary;
    options.loop.enabled = false;
    options.mapping.cull_keyframes = false;  // a size needs ten observations
    return options;
  }
  System& system() { return system_; }
  double rescaling() const { return rescaling_; }

  // Tracks frames of the closed path until `is_done`. The mapper of the pipeline that never waits
  // comes to its work at some time.
  template <typename Condition>
  void TrackUntil(const Condition& is_done) {
    for (int i = 0; i < 3000 && !is_done(); ++i, ++next_) {
      BuiltFrame built;
      const Rigid3 pose = Pose(next_);
      built.frame = std::make_unique<Frame>(*world_.Observe(FrameId(next_), pose).frame);
      built.frame->words = Options().vocabulary->WordsOf(built.frame->features.descriptors);
      built.frame->detections.push_back(Detect(cup_, world_.sensor(), pose));
      built.frame->detections.back().points.clear();
      system_.Track(std::move(built));
    }
    ASSERT_TRUE(is_done());
  }
  void Finish() {
    system_.Finish();
    Count(system_.events_at_end());
    EXPECT_EQ(FindViolations(*system_.map()), std::vector<std::string>());
  }
  // The number of observations of the cup while it is mapped.
  size_t Views() const { return Cup().second; }
  void TellSize(double longest_side) { system_.SetObjectSize(Cup().first, longest_side); }

  // The true length of the unit of the map, m, by the distances of the cameras.
  double Unit() const {
    const Trajectory trajectory = system_.trajectory();
    double truth = 0.0;
    double found = 0.0;
    const auto true_centre = [](const StampedPose& pose) {
      const double index = std::round(pose.timestamp * SyntheticSensor().frames_per_second);
      return Eigen::Vector3d(Inverse(SyntheticWorld::CamFromWorld(index)).translation);
    };
    for (const StampedPose& pose : trajectory) {
      truth += (true_centre(pose) - true_centre(trajectory.front())).norm();
      found +=
          (pose.world_from_cam.translation - trajectory.front().world_from_cam.translation).norm();
    }
    return truth / found;
  }

 private:
  // On the path of the synthetic world, but looking to the left and to the right, so that points
  // leave the image.
  static Rigid3 Pose(uint32_t index) {
    const Eigen::Vector3d centre = Inverse(SyntheticWorld::CamFromWorld(index)).translation;
    return SyntheticWorld::LookAt(centre, {1.2 * std::sin(0.1 * index), 0.0, 4.0});
  }
  std::pair<ObjectId, size_t> Cup() const {
    std::pair<ObjectId, size_t> most;
    const std::shared_ptr<const Map> map = system_.map();
    for (uint32_t i = 0; map != nullptr && i < map->objects().NextId().value; ++i) {
      const ObjectLandmark* const object = map->objects().Find(ObjectId(i));
      if (object != nullptr && object->state == ObjectState::kMapped &&
          object->observations.size() > most.second) {
        most = {ObjectId(i), object->observations.size()};
      }
    }
    return most;
  }
  void Count(std::span<const MapEvent> events) {
    for (const MapEvent& event : events) {
      rescaling_ *= event.kind == MapEventKind::kRescaled ? event.scale : 1.0;
    }
  }

  System system_;
  uint32_t next_ = 0;
  double rescaling_ = 1.0;
  const SyntheticWorld world_{{.points = 500, .depth_share = 0.0}};
  const MadeObject cup_ = MakeObject("cup", {0.0, 0.0, 4.0}, {0.25, 0.40, 0.30});
};

TEST_P(SystemTest, ASizeToldDuringAMonocularRunMakesTheUnitTheMetre) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map";
  {
    CupRun run(GetParam());
    run.TrackUntil([&] { return run.Views() >= 12; });
    EXPECT_EQ(run.rescaling(), 1.0);
    const double unit = run.Unit();
    EXPECT_GT(std::abs(unit - 1.0), 0.2) << "the unit is the depth of the first map";
    WriteMap(path, *run.system().map(), MapSettingsOf(CupRun::Options()));
    run.TellSize(0.8);
    run.TrackUntil([&] { return run.rescaling() != 1.0; });
    EXPECT_NEAR(run.rescaling(), unit, 0.05 * unit);
    run.Finish();
    EXPECT_NEAR(run.Unit(), 1.0, 0.03);
    EXPECT_EQ(run.system().sized_objects(), 1u);
  }
  // In a map without a size, while poses are only localised.
  CupRun later(GetParam(), {.map = ReadMap(path, CupRun::Options()), .localization_only = true});
  later.TrackUntil([&] { return later.system().trajectory().size() >= 20; });
  const double unit = later.Unit();
  EXPECT_GT(std::abs(unit - 1.0), 0.2);
  later.TellSize(0.8);
  later.TrackUntil([&] { return later.rescaling() != 1.0; });
  EXPECT_NEAR(later.rescaling(), unit, 0.05 * unit);
  EXPECT_NEAR(later.Unit(), 1.0, 0.05);
  later.Finish();
  EXPECT_NEAR(later.Unit(), 1.0, 0.05);
}

// Nothing of the run before may be left: neither frames that await masks nor counts.
TEST_P(SystemTest, ResetForgetsAllThatTheRunHasLeft) {
  const auto run = [&](System& system) {
    system.AwaitMasks(true);
    for (int i = 0; i < 12; ++i) {
      TrackFrame(system, i);
      if (i % 4 == 0) {
        EXPECT_TRUE(system.AddMasks(FrameId(static_cast<uint32_t>(i)), SquareMask()));
      }
    }
  };
  System fresh(Wall::Options(), GetParam());
  run(fresh);
  fresh.Finish();
  System system(Wall::Options(), GetParam());
  run(system);
  system.Reset();
  EXPECT_TRUE(system.frames().empty());
  EXPECT_EQ(system.map(), nullptr);
  EXPECT_TRUE(system.times().samples().empty());
  for (uint32_t id = 0; id < 12; ++id) {
    EXPECT_FALSE(system.AddMasks(FrameId(id), SquareMask())) << "frame " << id << " of before";
  }
  run(system);
  system.Finish();
  EXPECT_EQ(system.object_counts().frames_with_masks, fresh.object_counts().frames_with_masks);
  EXPECT_EQ(system.object_counts().detections, fresh.object_counts().detections);
  EXPECT_EQ(system.times().samples().at("frame").size(), 12u);
  ASSERT_EQ(system.frames().size(), fresh.frames().size());
  EXPECT_EQ(system.frames().front().frame, FrameId(0));
}

// Frames of the last minutes get their last pose at the end, from landmarks of those days. So until
// then the map knows what has replaced them: the same as if each step had been followed.
TEST(System, TheMapKnowsWhatReplacedTheLandmarksOfRememberedFrames) {
  System system(Wall::Options(), PipelineKind::kSequential);
  std::vector<LandmarkId> ids;       // as tracking reported them
  std::vector<LandmarkId> followed;  // brought up to date after each frame
  std::vector<LandmarkId> reported;
  system.SetFrameCallback([&](const FrameReport& report) { reported = report.landmarks; });
  for (int i = 0; i < 80; ++i) {
    system.Track(Time(i), TheWall().Photograph(i % 40), Wall::Depth(i % 40));
    for (const LandmarkId id : reported) {
      if (id.IsValid()) {
        ids.push_back(id);
        followed.push_back(id);
      }
    }
    const auto map = system.map();
    for (LandmarkId& id : followed) {
      id = map->Resolve(id);
    }
  }
  const auto map = system.map();
  size_t replaced = 0;
  for (size_t i = 0; i < ids.size(); ++i) {
    ASSERT_EQ(map->Resolve(ids[i]), followed[i]) << i;
    replaced += followed[i].IsValid() && followed[i] != ids[i] ? 1 : 0;
  }
  EXPECT_GT(replaced, 100u) << "too few landmarks were replaced for a test";
}

TEST(System, MasksMayComeTwoSecondsLate) {
  System system(Wall::Options(), PipelineKind::kSequential);
  const auto track = [&](double timestamp, int index) {
    return system.Track(timestamp, TheWall().Photograph(index), Wall::Depth(index)).frame;
  };
  const FrameId unasked = track(1.0, 0);
  EXPECT_FALSE(system.AddMasks(unasked, SquareMask())) << "AwaitMasks was not called";
  system.AwaitMasks(true);
  const FrameId early = track(2.0, 1);
  const FrameId later = track(2.1, 2);
  track(4.05, 3);
  EXPECT_FALSE(system.AddMasks(early, SquareMask()));
  ExpectInputError([&] { system.AddMasks(later, {InstanceMask()}); }, {"mask 0"});
  EXPECT_TRUE(system.AddMasks(later, SquareMask())) << "refused masks change nothing";
  system.Finish();
  const FrameId last = system.frames().back().frame;
  EXPECT_THROW(system.AddMasks(last, SquareMask()), CheckError);
  system.Reset();
  EXPECT_FALSE(system.AddMasks(track(1.0, 0), SquareMask())) << "Reset switches it off";
}

TrackedFrame TrackWithVectors(System& system, int index, const std::vector<size_t>& lengths) {
  std::vector<InstanceMask> masks;
  for (const size_t length : lengths) {
    InstanceMask& mask = masks.emplace_back(SquareMask().front());
    for (Eigen::Vector2d& corner : mask.outlines.front()) {
      corner.x() += 150.0 * static_cast<double>(masks.size() - 1);
    }
    mask.embedding.assign(length, 1.0f);
  }
  return system.Track(Time(index), TheWall().Photograph(index), Wall::Depth(index),
                      std::move(masks));
}

TEST(System, VectorsOfAnotherLengthThanTheEarlierOnesAreRefused) {
  System system(Wall::Options(), PipelineKind::kSequential);
  const std::vector<std::string> parts = {"4 numbers", "have 3", "expected vectors of one network"};
  ExpectInputError([&] { TrackWithVectors(system, 0, {3, 4}); }, parts);
  EXPECT_TRUE(system.frames().empty());
  TrackWithVectors(system, 0, {4});  // a refused frame sets no length
  system.Reset();
  TrackWithVectors(system, 0, {0, 3});  // nor does an earlier run
  TrackWithVectors(system, 1, {0});
  ExpectInputError([&] { TrackWithVectors(system, 2, {4}); }, parts);
  EXPECT_EQ(system.frames().size(), 2u);
  EXPECT_EQ(TrackWithVectors(system, 2, {3}).state, TrackingState::kTracked);
}

TEST(System, VectorsOfAnotherLengthThanThoseOfTheLoadedMapAreRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map";
  {
    System first(Wall::Options(), PipelineKind::kSequential);
    TrackWithVectors(first, 0, {3});
    first.Finish();
    WriteMap(path, *first.map(), MapSettingsOf(Wall::Options()));
  }
  System second(Wall::Options(), PipelineKind::kSequential,
                {.map = ReadMap(path, Wall::Options())});
  for (int run = 0; run < 2; ++run) {
    ExpectInputError([&] { TrackWithVectors(second, 0, {4}); }, {"4 numbers", "have 3"});
    EXPECT_TRUE(second.frames().empty());
    TrackWithVectors(second, 0, {0, 3});
    EXPECT_EQ(second.frames().size(), 1u);
    second.Reset();
  }
}

// The features of the first keyframe, which is made from one image.
FrameFeatures FeaturesOf(const cv::Mat& image, std::optional<bool> rgb_order) {
  SystemOptions options = Wall::Options();
  options.rgb_order = rgb_order.value_or(options.rgb_order);
  System system(options, PipelineKind::kSequential);
  system.Track(1.0, image, Wall::Depth(0));
  return system.map()->keyframes().At(KeyframeId(0)).frame->features;
}

TEST(System, TheOrderOfColoursFollowsTheOption) {
  const cv::Mat bgr = TheWall().Photograph(0);
  cv::Mat rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  cv::Mat rgba;
  cv::cvtColor(rgb, rgba, cv::COLOR_RGB2RGBA);
  cv::Mat bgra;
  cv::cvtColor(rgb, bgra, cv::COLOR_RGB2BGRA);
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  const std::vector<Descriptor> expected = FeaturesOf(grey, true).descriptors;
  EXPECT_GT(expected.size(), 300u);
  EXPECT_EQ(FeaturesOf(rgb, true).descriptors, expected);
  EXPECT_EQ(FeaturesOf(bgr, false).descriptors, expected);
  EXPECT_EQ(FeaturesOf(rgba, true).descriptors, expected);
  EXPECT_EQ(FeaturesOf(bgra, false).descriptors, expected);
  EXPECT_EQ(FeaturesOf(grey, false).descriptors, expected);
  EXPECT_NE(FeaturesOf(bgr, true).descriptors, expected);
  EXPECT_EQ(FeaturesOf(bgr, std::nullopt).descriptors, expected) << "as cv::imread gives them";
}

TEST(System, TrackAfterFinishIsRefused) {
  System system(Wall::Options(), PipelineKind::kThreaded);
  TrackFrame(system, 0);
  system.Finish();
  EXPECT_THROW(TrackFrame(system, 1), CheckError);
  EXPECT_EQ(system.trajectory().size(), 1u) << "the trajectory is kept";
}

TEST(System, SixteenBitDepthIsScaledByTheOption) {
  SystemOptions options = Wall::Options();
  options.depth.units_per_metre = 1000.0;
  System system(options, PipelineKind::kSequential);
  cv::Mat millimetres;
  Wall::Depth(0).convertTo(millimetres, CV_16UC1, 1000.0);
  system.Track(1.0, TheWall().Photograph(0), millimetres);
  system.map()->landmarks().ForEach([](LandmarkId, const Landmark& landmark) {
    EXPECT_NEAR(landmark.position.z(), kWallDistance, 1e-3);
  });
}

TEST(System, AMonocularCameraNeedsNoDepthImage) {
  SystemOptions options = Wall::Options();
  options.sensor = SensorKind::kMonocular;
  System monocular(options, PipelineKind::kSequential);
  EXPECT_EQ(monocular.Track(1.0, TheWall().Photograph(0)).state, TrackingState::kNotInitialized);
  System rgbd(Wall::Options(), PipelineKind::kSequential);
  ExpectInputError([&] { rgbd.Track(1.0, TheWall().Photograph(0)); },
                   {"no depth image", "SensorKind::kMonocular"});
}

TEST(System, AFrameHasThePoseOfItsCamera) {
  System system(Wall::Options(), PipelineKind::kSequential);
  for (int i = 0; i < 8; ++i) {
    const TrackedFrame frame = TrackFrame(system, i);
    const Rigid3 expected = Inverse(Wall::CamFromWorld(i));
    EXPECT_LT((frame.world_from_cam().translation - expected.translation).norm(), 0.01) << i;
  }
}

TEST_P(SystemTest, ANewMapBeginsAtAGivenPose) {
  const Rigid3 start(Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY())),
                     {3.0, -1.0, 2.0});
  System system(Wall::Options(), GetParam(), {.world_from_cam = start});
  for (int i = 0; i < 8; ++i) {
    const TrackedFrame frame = TrackFrame(system, i);
    const Rigid3 expected = start * Inverse(Wall::CamFromWorld(i));
    EXPECT_LT((frame.world_from_cam().translation - expected.translation).norm(), 0.01) << i;
    EXPECT_LT(frame.world_from_cam().rotation.angularDistance(expected.rotation), 0.01) << i;
  }
  system.Finish();
  EXPECT_LT((system.trajectory().front().world_from_cam.translation - start.translation).norm(),
            0.01);
  const Rigid3 nowhere(Eigen::Quaterniond::Identity(), {std::nan(""), 0.0, 0.0});
  EXPECT_THROW(System(Wall::Options(), GetParam(), {.world_from_cam = nowhere}), CheckError);
}

TEST(System, TheCallbackGetsAReportOfEachFrame) {
  System system(Wall::Options(), PipelineKind::kSequential);
  std::vector<FrameReport> reports;
  system.SetFrameCallback([&](const FrameReport& report) { reports.push_back(report); });
  for (int i = 0; i < 3; ++i) {
    TrackFrame(system, i);
  }
  ASSERT_EQ(reports.size(), 3u);
  for (size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].tracked.frame, system.frames()[i].frame);
    EXPECT_EQ(reports[i].tracked.inliers, system.frames()[i].inliers);
    ASSERT_NE(reports[i].frame, nullptr);
    EXPECT_EQ(reports[i].landmarks.size(), reports[i].frame->features.size());
  }
}

std::vector<MapEventKind> KindsOf(const std::vector<MapEvent>& events) {
  std::vector<MapEventKind> kinds;
  for (const MapEvent& event : events) {
    kinds.push_back(event.kind);
  }
  return kinds;
}

TEST(System, AReportHasTheEventsOfItsFrame) {
  System system(Wall::Options(), PipelineKind::kSequential);
  std::vector<MapEventKind> kinds;  // of the newest frame
  system.SetFrameCallback([&](const FrameReport& report) { kinds = KindsOf(report.events); });
  for (int i = 0; i < 3; ++i) {
    TrackFrame(system, i);
    EXPECT_TRUE(kinds.empty());
  }
  const cv::Mat blank(480, 640, CV_8UC1, cv::Scalar(100));
  system.Track(Time(3), blank, Wall::Depth(3));
  EXPECT_EQ(kinds, std::vector{MapEventKind::kLost});
  system.Track(Time(4), blank, Wall::Depth(4));
  EXPECT_TRUE(kinds.empty()) << "it is still lost";
  TrackFrame(system, 5);
  EXPECT_EQ(kinds, std::vector{MapEventKind::kRelocalised});
  system.Finish();
  EXPECT_TRUE(system.events_at_end().empty());
  system.Reset();
  TrackFrame(system, 0);
  EXPECT_TRUE(kinds.empty());
}

TEST(SystemStart, LocalizationNeedsAMap) {
  SystemOptions options;
  options.camera = SyntheticSensor().camera;
  EXPECT_THROW(System(options, PipelineKind::kSequential, {.localization_only = true}), CheckError);
  EXPECT_EQ(System(options, PipelineKind::kSequential, {.session_name = "a"}).map(), nullptr);
}

// After black images the camera sees another wall. It stands still at last, until the mapper of the
// pipeline that never waits has come to the keyframe.
TEST_P(SystemTest, MapsANewPlaceThatThePriorsLeadTo) {
  const Wall other(8);
  System system(Wall::Options(), GetParam());
  int alone = 0;
  TrackedFrame tracked;
  for (int i = 0; i < 1000 && (i < 25 || tracked.prior != PriorUse::kFused); ++i) {
    const int place = std::min(i, 25);
    MotionPrior motion{Wall::CamFromWorld(place) * Inverse(Wall::CamFromWorld(std::min(i - 1, 25))),
                       Time(i - 1)};
    motion.covariance *= 1e-6;
    const cv::Mat image = i < 5    ? TheWall().Photograph(place)
                          : i < 10 ? cv::Mat(480, 640, CV_8UC1, cv::Scalar(0))
                                   : other.Photograph(place);
    tracked = system.Track(Time(i), image, Wall::Depth(place), {}, {},
                           i > 0 ? std::optional(motion) : std::nullopt);
    ASSERT_EQ(tracked.state, TrackingState::kTracked) << i;
    alone += tracked.prior == PriorUse::kAlone ? 1 : 0;
  }
  EXPECT_EQ(tracked.prior, PriorUse::kFused);
  EXPECT_GE(alone, 8);
  if (GetParam() == PipelineKind::kSequential) {
    EXPECT_EQ(alone, 8) << "five black images and three that are not known";
  }
  system.Finish();
  EXPECT_EQ(FindViolations(*system.map()), std::vector<std::string>());
  EXPECT_EQ(system.trajectory().size(), system.frames().size());
  for (const auto& [id, keyframe] : system.map()->keyframes()) {
    const int place = std::min(static_cast<int>(keyframe.frame->id.value), 25);
    const Rigid3 error = keyframe.cam_from_world * Inverse(Wall::CamFromWorld(place));
    EXPECT_LT(error.translation.norm(), 0.005) << place;
  }
}

TEST(System, MotionsThatCannotBeUsedAreRefused) {
  System system(Wall::Options(), PipelineKind::kSequential);
  MotionPrior motion;
  const auto track = [&](int index) {
    return system.Track(0.1 * index, TheWall().Photograph(index), Wall::Depth(index), {}, {},
                        motion);
  };
  ExpectInputError([&] { track(0); }, {"0.000000 s", "first frame"});
  system.Track(0.0, TheWall().Photograph(0), Wall::Depth(0));
  motion.last_timestamp = 0.05;
  ExpectInputError([&] { track(1); }, {"begins at 0.050000 s", "the frame before, 0.000000 s"});
  motion.last_timestamp = 0.0;
  motion.covariance(2, 2) = 0.0;
  ExpectInputError([&] { track(1); }, {"0.100000 s", "positive definite"});
  motion.covariance(2, 2) = std::numeric_limits<double>::quiet_NaN();
  ExpectInputError([&] { track(1); }, {"positive definite"});
  motion.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
  motion.cam_from_last_cam.translation.x() = std::numeric_limits<double>::quiet_NaN();
  ExpectInputError([&] { track(1); }, {"not finite"});
  EXPECT_EQ(system.frames().size(), 1u) << "a refused frame changes nothing";
  motion.cam_from_last_cam = Wall::CamFromWorld(1);
  EXPECT_EQ(track(1).prior, PriorUse::kFused);

  SystemOptions options = Wall::Options();
  options.sensor = SensorKind::kMonocular;
  System monocular(options, PipelineKind::kSequential);
  monocular.Track(0.0, TheWall().Photograph(0));
  ExpectInputError([&] { monocular.Track(0.1, TheWall().Photograph(1), {}, {}, {}, motion); },
                   {"monocular", "metres"});
}

}  // namespace
}  // namespace hullslam
