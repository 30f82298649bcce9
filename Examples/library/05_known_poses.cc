// SPDX-License-Identifier: GPL-3.0-or-later
// Example 5: maps objects from masks and known poses of the camera, here the ground truth of a
// sequence in TUM's format. No image is read.
//
//   05_known_poses SEQUENCE MASKS
#include <cstdio>
#include <vector>

#include "hullslam/masks/open_masks.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/known_pose_mapper.h"
#include "hullslam/util/error.h"

namespace {

void Run(const char* folder, const char* mask_folder) {
  const hullslam::SystemOptions settings =
      hullslam::ReadSettings(hullslam::FindDefaultSettings(folder, hullslam::FindConfigFolder()));
  const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(folder, {.use_depth = false});
  const std::vector<hullslam::MaskFrame> names = hullslam::MaskFrames(sequence);
  const auto masks =
      hullslam::OpenMasks({mask_folder, "", settings.camera.width, settings.camera.height}, names);
  const hullslam::Trajectory groundtruth = hullslam::ReadGroundtruth(sequence).value();

  hullslam::KnownPoseMapper mapper(settings);
  for (size_t i = 0; i < names.size(); i += 5) {  // views should differ
    const double timestamp = sequence.frames[i].timestamp;
    if (const auto pose = hullslam::InterpolatePose(groundtruth, timestamp, 0.1)) {
      mapper.AddView(timestamp, *pose, masks->Read(names[i]).masks);
    }
  }

  std::printf("%zu views\n", mapper.map().keyframes().size());
  for (const auto& [id, object] : mapper.map().objects()) {
    if (object.state == hullslam::ObjectState::kMapped) {
      const Eigen::Vector3d& center = object.ellipsoid.world_from_object.translation;
      std::printf("%s at %.3f %.3f %.3f m\n", object.Label().c_str(), center.x(), center.y(),
                  center.z());
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 05_known_poses SEQUENCE MASKS\n");
    return 2;
  }
  Run(argv[1], argv[2]);
} catch (const hullslam::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
