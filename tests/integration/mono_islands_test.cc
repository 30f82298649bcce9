// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "hullslam/results/trajectory_file.h"
#include "support/mono_program.h"
#include "support/rendered_desk.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 30;
constexpr int kBlank = 8;

enum class Side { kLeft, kRight, kBoth };

// One half of an image; the other one is black, and brightness falls off between them.
cv::Mat HalfOf(const cv::Mat& image, Side side) {
  constexpr int kRamp = 48;  // px
  cv::Mat half = image.clone();
  for (int x = 0; x < half.cols; ++x) {
    const int inside = side == Side::kLeft ? half.cols / 2 - x : x - half.cols / 2;
    half.col(x) *= std::clamp(inside / static_cast<double>(kRamp), 0.0, 1.0);
  }
  return half;
}

// The camera first sees the left half of a desk, then nothing, then the right half on the way back,
// and at the end the whole desk. So when the right half is mapped as an island of its own, no image
// has shown the left half again.
class InterruptedDesk {
 public:
  InterruptedDesk() {
    fs::create_directory(path() / "rgb");
    fs::copy(desk_.path() / "camera.yaml", path() / "camera.yaml");
    cv::imwrite((path() / "rgb" / "black.png").string(), cv::Mat::zeros(480, 640, CV_8UC3));
    for (int i = 0; i < kFrames; ++i) {
      Add(i, Side::kLeft);
    }
    for (int i = 0; i < kBlank; ++i) {
      AddLine("rgb/black.png", {});
    }
    for (int i = kFrames - 1; i >= 0; --i) {
      Add(i, Side::kRight);
    }
    for (int i = 0; i < kFrames; ++i) {
      Add(i, Side::kBoth);
    }
    folder_.Write("rgb.txt", lines_);
    folder_.Write("groundtruth.txt", FormatTrajectory(truth_));
  }

  const fs::path& path() const { return folder_.path(); }
  int size() const { return size_; }

 private:
  void Add(int frame, Side side) {
    const fs::path& file = images_.frames.at(static_cast<size_t>(frame)).image;
    const cv::Mat image = cv::imread(file.string());
    const std::string name = fmt::format("rgb/{}.png", size_);
    cv::imwrite((path() / name).string(), side == Side::kBoth ? image : HalfOf(image, side));
    AddLine(name, desk_truth_.at(static_cast<size_t>(frame)).world_from_cam);
  }
  void AddLine(const std::string& image, const Rigid3& world_from_cam) {
    const double stamp = 100.0 + size_ / 30.0;
    lines_ += fmt::format("{:.6f} {}\n", stamp, image);
    truth_.push_back({stamp, world_from_cam});
    ++size_;
  }

  RenderedDesk desk_{kFrames};
  ImageSequence images_ = desk_.images();
  Trajectory desk_truth_ = ReadTrajectory(desk_.path() / "groundtruth.txt");
  TemporaryFolder folder_;
  std::string lines_;
  Trajectory truth_;
  int size_ = 0;
};

class MonoIslands : public MonoProgram {
 protected:
  MonoIslands() : MonoProgram("mono_tum") {}

  void ExpectOneMap(const std::vector<std::string>& arguments, int frames) {
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    ExpectParts(result.output, {"the map was begun 2 times; 1 of its islands were joined"});
    const Json summary = Summary();
    EXPECT_EQ(summary["initialisation"]["islands"], 2);
    EXPECT_EQ(summary["initialisation"]["joined_islands"], 1);
    EXPECT_EQ(summary["trajectory"]["tracked"], frames - kBlank);
    EXPECT_EQ(Poses().size(), static_cast<size_t>(frames - kBlank));
    EXPECT_LE(Ate(), 0.005);
  }
};

TEST_F(MonoIslands, AnIslandIsJoinedWhenItsPlaceIsSeenAgain) {
  const InterruptedDesk desk;
  ExpectOneMap({desk.path()}, desk.size());
}

}  // namespace
}  // namespace hullslam
