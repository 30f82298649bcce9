// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "sequences/named_images.h"
#include "support/made_bags.h"
#include "support/made_room.h"
#include "support/mono_program.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kPairs = 12;
constexpr double kBetweenCameras = 0.12;  // m

// The tools that read every data set, with the same room in several of them. The masks show a part
// of a wall.
class AnyDataset : public MonoProgram {
 protected:
  AnyDataset() : MonoProgram("hullslam run") {
    const PinholeCamera& camera = room_.camera();
    settings_ = folder_.Write(
        "camera.yaml",
        fmt::format("Camera.fx: {}\nCamera.fy: {}\nCamera.cx: {}\nCamera.cy: {}\nCamera.width: {}\n"
                    "Camera.height: {}\nCamera.fps: 10\nCamera.bf: {}\n",
                    camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height,
                    kBetweenCameras * camera.fx));
  }

  std::string WriteMasks(const std::vector<std::string>& stems) const {
    for (const std::string& stem : stems) {
      folder_.Write("masks/" + stem + ".txt", "62 0.4 0.4 0.6 0.4 0.6 0.6 0.4 0.6\n");
    }
    return (folder_.path() / "masks").string();
  }

  // The stems "000000" to "000011".
  static std::vector<std::string> Numbers() {
    std::vector<std::string> stems;
    for (int i = 0; i < kPairs; ++i) {
      stems.push_back(fmt::format("{:06}", i));
    }
    return stems;
  }

  // Expects that all masks are found and that the tools end well.
  void ExpectTools(const std::string& path, const std::string& masks, const std::string& truth,
                   const Arguments& more) const {
    Arguments arguments = {path, masks, "--output", (folder_.path() / "pictures").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult checked = RunProgram("hullslam check-masks", arguments);
    EXPECT_EQ(checked.exit_code, 0) << checked.errors;
    ExpectParts(checked.output, {"instances                       12",
                                 "kept                            12", "1 pictures are in"});
    arguments = {path,
                 "--masks",
                 masks,
                 "--poses",
                 truth,
                 "--output",
                 (folder_.path() / "objects").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult mapped = RunProgram("hullslam map-objects", arguments);
    EXPECT_EQ(mapped.exit_code, 0) << mapped.errors;
    ExpectParts(mapped.output, {"of 12 frames (0 without a pose)"});
    arguments = {path, "--groundtruth", truth, "--quiet", "--queries", "3"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult found = RunProgram("hullslam relocalise", arguments);
    EXPECT_EQ(found.exit_code, 0) << found.errors;
    ExpectParts(found.output, {"\nwords            3   100.0 %"});
  }

  MadeRoom room_;
  std::string settings_;
};

TEST_F(AnyDataset, PairsAreReadByAllTools) {
  room_.WritePairs(path_, "left", "right", kPairs, kBetweenCameras);
  const std::string truth = path_ + "/groundtruth.txt";
  const ProgramResult result = Run({path_, "--settings", settings_});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  ExpectParts(result.output, {path_ + ": folders or a video of stereo pairs, stereo"});
  EXPECT_EQ(Summary()["provenance"]["program"], "stereo_folder");
  ExpectTools(path_, WriteMasks(Numbers()), truth, {"--settings", settings_});
}

TEST_F(AnyDataset, AFolderOfImagesIsReadByAllTools) {
  room_.WritePairs(path_, "left", "right", kPairs, kBetweenCameras);
  const std::string images = path_ + "/left";
  const std::string truth = path_ + "/groundtruth.txt";
  const Arguments more = {"--settings", settings_, "--fps", "10"};
  ExpectTools(images, WriteMasks(Numbers()), truth, more);
  const ProgramResult result = Run({images, "--settings", settings_, "--fps", "10"});
  EXPECT_EQ(Summary()["provenance"]["program"], "mono_video");
  ExpectRefusal({images, "--settings", settings_, "--depth-topic", "/depth"},
                {"--depth-topic is given", "a video or a folder of images"});
  ExpectRefusal({images, "--settings", settings_, "--mask-all-right", settings_},
                {"--mask-all-right is given", "monocular", "expected stereo"});
}

TEST_F(AnyDataset, ARecordingIsReadByAllTools) {
  const PinholeCamera& camera = room_.camera();
  const auto width = static_cast<uint32_t>(camera.width);
  const auto height = static_cast<uint32_t>(camera.height);
  std::vector<MadeMessage> messages = {
      {"/camera_info", "sensor_msgs/CameraInfo", 1'000'000'000,
       MadeCameraInfo(MessageCoding::kCdr, width, height, "plumb_bob", {}, camera.fx, 0.0)}};
  std::vector<std::string> stems;
  std::string truth;
  for (int i = 0; i < kPairs; ++i) {
    const MadeRoom::Images images = room_.Render(i);
    const uint64_t time = 1'000'000'000 + 100'000'000 * static_cast<uint64_t>(i);
    cv::Mat depth;
    images.depth.convertTo(depth, CV_16UC1, 0.2);  // mm
    messages.push_back({"/image", "sensor_msgs/Image", time,
                        MadeImage(MessageCoding::kCdr, time, "mono8", width, height,
                                  std::string(images.grey.datastart, images.grey.dataend))});
    messages.push_back({"/depth", "sensor_msgs/Image", time,
                        MadeImage(MessageCoding::kCdr, time, "16UC1", width, height,
                                  std::string(depth.datastart, depth.dataend))});
    stems.push_back(fmt::format("{:.6f}", 1.0 + 0.1 * i));
    const Rigid3 pose = MadeRoom::Pose(i);
    truth += fmt::format("{} {} {} {} {} {} {} {}\n", stems.back(), pose.translation.x(),
                         pose.translation.y(), pose.translation.z(), pose.rotation.x(),
                         pose.rotation.y(), pose.rotation.z(), pose.rotation.w());
  }
  const std::string bag = folder_.Write("room.mcap", MadeMcap(messages, "zstd"));
  const ProgramResult result = Run({bag});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  ExpectParts(result.output, {"a recording of ROS, RGB-D (--mono would do, too)"});
  EXPECT_EQ(Summary()["provenance"]["program"], "rgbd_bag");
  ExpectTools(bag, WriteMasks(stems), folder_.Write("truth.txt", truth), {});
}

}  // namespace
}  // namespace hullslam
