// SPDX-License-Identifier: GPL-3.0-or-later
// Example 7: what a robot needs. Maps an RGB-D sequence in TUM's format with the odometry of its
// wheels, which also bridges ten images of a covered lens, saves the map while it drives, and goes
// on without changing the map. ODOMETRY has poses of the camera in TUM's format.
//
//   07_robot SEQUENCE ODOMETRY MAP
#include <cstdio>
#include <memory>
#include <string>

#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace {

void PrintPose(const char* name, const hullslam::Rigid3& pose) {
  const Eigen::Vector3d& position = pose.translation;
  std::printf("%s: %.2f %.2f %.2f m\n", name, position.x(), position.y(), position.z());
}

void Run(const char* folder, const char* odometry, const char* map_file) {
  hullslam::SystemOptions settings =
      hullslam::ReadSettings(hullslam::FindDefaultSettings(folder, hullslam::FindConfigFolder()));
  settings.vocabulary = std::make_shared<const hullslam::Vocabulary>(
      hullslam::ReadVocabulary(hullslam::FindDefaultVocabulary()));
  hullslam::ImageSequence sequence = hullslam::OpenTumSequence(folder);
  hullslam::ReadOdometry(odometry, settings.sensor, sequence);

  hullslam::System slam(settings, hullslam::PipelineKind::kSequential);
  slam.SetFrameCallback([](const hullslam::FrameReport& report) {
    for (const hullslam::MapEvent& event : report.events) {
      std::printf("%.3f s: %s\n", report.tracked.timestamp, ToString(event.kind).data());
    }
  });
  auto saver = std::make_unique<hullslam::MapSaver>(
      map_file, hullslam::MapSettingsOf(settings), 5.0,
      [](const std::string& why) { std::fprintf(stderr, "%s\n", why.c_str()); });
  const size_t half = sequence.frames.size() / 2;
  int by_wheels = 0;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    hullslam::ImageInput frame = sequence.load(sequence.frames[i], settings.camera);
    if (i > 0) {
      frame.motion = PriorBetween(sequence, slam.frames().back().timestamp, frame.timestamp,
                                  settings.odometry);
    }
    if (i >= half && i < half + 10) {
      frame.grey.setTo(0);
    }
    if (i == half + 10) {
      slam.SetLocalizationOnly(true);  // the place is known now
    }
    by_wheels += slam.Track(frame).prior == hullslam::PriorUse::kAlone ? 1 : 0;
    saver->Offer(slam.map());
  }
  const hullslam::TrackedFrame last = slam.frames().back();
  std::printf("%d frames by wheels alone\n", by_wheels);
  PrintPose("odometry", last.odometry->odom_from_cam);
  PrintPose("map", last.odometry->map_from_odom * last.odometry->odom_from_cam);
  saver.reset();  // waits until an earlier map is written, which would else replace the last one
  slam.Finish();
  hullslam::WriteMap(map_file, *slam.map(), hullslam::MapSettingsOf(settings));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::fprintf(stderr, "usage: 07_robot SEQUENCE ODOMETRY MAP\n");
    return 2;
  }
  Run(argv[1], argv[2], argv[3]);
} catch (const hullslam::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
