// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>
#include <optional>

#include "fuzz/fuzzed_input.h"
#include "fuzz/readers.h"
#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "images/rvl_depth.h"
#include "sequences/euroc_states.h"
#include "settings/stereo_settings.h"

namespace hullslam {
namespace {

void FuzzSequence(std::string_view bytes) {
  static const InputFolder folder("rgb.txt");
  folder.Write(bytes);
  Try([] { OpenTumSequence(folder.path(), {.need_images = false}); });
}

void FuzzAssociations(std::string_view bytes) {
  static const InputFolder folder("associations.txt");
  folder.Write(bytes);
  Try([] {
    OpenTumSequence(folder.path(),
                    {.associations = folder.path() / "associations.txt", .need_images = false});
  });
}

// The images do not exist, so a good file ends with an error that names the first one.
void FuzzIclAssociations(std::string_view bytes) {
  static const InputFolder folder("associations.txt");
  folder.Write(bytes);
  Try([] { OpenIclSequence(folder.path(), PinholeCamera(), DepthOptions()); });
}

// A small image, because the maps have an entry for each of its pixels.
void FuzzStereoSettings(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    constexpr PinholeCamera kLeft{
        .fx = 50.0, .fy = 50.0, .cx = 32.0, .cy = 24.0, .width = 64, .height = 48};
    const std::optional<StereoCalibration> pair = ReadStereoPair(path, kLeft);
    if (pair && pair->left.width * pair->left.height <= kLeft.width * kLeft.height) {
      const StereoRectifier rectifier(*pair, "the pair");
      Expect(rectifier.camera().FindFault().empty(), "a rectified camera with a fault");
      Expect(rectifier.camera().bf > 0.0, "no baseline");
    }
  });
}

// The images do not exist.
void FuzzKittiCalibration(std::string_view bytes) {
  static const InputFolder folder("calib.txt");
  folder.Write(bytes);
  fs::create_directory(folder.path() / "image_0");
  fs::create_directory(folder.path() / "image_1");
  Try([] { OpenKittiPairs(folder.path()); });
  Try([] { OpenKittiImages(folder.path()); });
}

void FuzzEurocSensor(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    const EurocCamera read = ReadEurocCamera(path);
    Expect(read.calibration.camera.FindFault().empty(), "a camera with a fault");
    Expect(std::abs(read.body_from_cam.rotation.norm() - 1.0) < 1e-6, "not normalised");
  });
}

// The folder is its own subfolder `cam0`.
void FuzzEurocImages(std::string_view bytes) {
  static const InputFolder folder("data.csv", "sensor.yaml");
  const fs::path cam0 = folder.path() / "cam0";
  if (!fs::exists(cam0)) {
    fs::create_directory_symlink(folder.path(), cam0);
  }
  folder.Write(bytes);
  Try([] { OpenEurocSequence(folder.path()); });
}

void FuzzEurocStates(std::string_view bytes) {
  TryFile(bytes, [](const fs::path& path) {
    for (const StampedPose& pose : ReadEurocStates(path, Rigid3())) {
      Expect(std::abs(pose.world_from_cam.rotation.norm() - 1.0) < 1e-9, "not normalised");
    }
  });
}

// The format is recognised by the first bytes, so all formats of recordings have this reader.
// SQLite opens no file in memory.
void FuzzBag(std::string_view bytes) {
  static const InputFolder folder("unused");
  const fs::path file = folder.path() / "recording";
  std::ofstream(file, std::ios::binary) << bytes;
  Try([&] {
    const BagSequence bag = OpenBagSequence(file);
    Expect(bag.camera.has_value() && !bag.images.frames.empty(), "no camera or no frames");
    for (const FramePaths& frame : bag.images.frames) {
      const ImageInput image = bag.images.load(frame, bag.camera->camera);
      Expect(image.grey.type() == CV_8UC1 && image.depth.size() == image.grey.size(), "the images");
    }
  });
}

void FuzzRvl(std::string_view bytes) {
  Try([&] {
    const cv::Mat depth = DecodeRvl(bytes, "a message");
    Expect(depth.type() == CV_16UC1 && !depth.empty(), "the depth");
  });
}

constexpr auto kSequenceReaders =
    std::to_array<FuzzedReader>({{"sequence", FuzzSequence},
                                 {"associations", FuzzAssociations},
                                 {"icl_associations", FuzzIclAssociations},
                                 {"stereo_settings", FuzzStereoSettings},
                                 {"kitti_calib", FuzzKittiCalibration},
                                 {"euroc_sensor", FuzzEurocSensor},
                                 {"euroc_images", FuzzEurocImages},
                                 {"euroc_states", FuzzEurocStates},
                                 {"mcap", FuzzBag},
                                 {"rosbag1", FuzzBag},
                                 {"rosbag2", FuzzBag},
                                 {"rvl_depth", FuzzRvl}});

const KnownReaders kKnownSequenceReaders(kSequenceReaders);

}  // namespace
}  // namespace hullslam
