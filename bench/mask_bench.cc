// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the masks of one frame from text, and turns them into detections with lines. The masks have
// about as many points as those of a real network.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>

#include "frame/detection/detection_builder.h"
#include "hullslam/masks/open_masks.h"

namespace hullslam {
namespace {

constexpr int kInstances = 10;
constexpr int kPoints = 200;  // per mask; the median of fr1_xyz is 142

// A folder with the mask file of one frame. The destructor removes it.
class MaskFile {
 public:
  MaskFile() {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "1.5.txt") << Text();
  }
  ~MaskFile() { std::filesystem::remove_all(folder_); }
  MaskFile(const MaskFile&) = delete;
  MaskFile& operator=(const MaskFile&) = delete;

  std::unique_ptr<const MaskSource> Open() const {
    return OpenMasks({.path = folder_, .format = {}, .width = 640, .height = 480}, frames_);
  }
  const MaskFrame& frame() const { return frames_.front(); }

 private:
  static std::string Text() {
    std::string text;
    for (int i = 0; i < kInstances; ++i) {
      text += std::to_string(i);
      const double x = 0.15 + 0.17 * (i % 5);
      const double y = 0.3 + 0.4 * (i / 5);
      for (int k = 0; k < kPoints; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kPoints;
        const double radius = 0.09 + 0.005 * std::cos(9.0 * angle);
        text += fmt::format(" {:.6f} {:.6f}", x + radius * std::cos(angle),
                            y + radius * std::sin(angle));
      }
      text += " 0.9\n";
    }
    return text;
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("hullslam_mask_bench_{}", ::getpid());
  std::vector<MaskFrame> frames_ = {{"1.5", 0}};
};

void TextToMasks(benchmark::State& state) {
  const MaskFile file;
  const auto source = file.Open();
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(source->Read(file.frame()));
  }
}
BENCHMARK(TextToMasks)->Unit(benchmark::kMillisecond);

void TextToLines(benchmark::State& state) {
  const MaskFile file;
  const auto source = file.Open();
  const PinholeCamera camera{.fx = 517.3,
                             .fy = 516.5,
                             .cx = 318.6,
                             .cy = 255.3,
                             .k1 = 0.262383,
                             .k2 = -0.953104,
                             .p1 = -0.005358,
                             .p2 = 0.002628,
                             .k3 = 1.163314};
  const cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(5000));
  const DetectionBuilder builder(camera, 5000.0, DetectionOptions());
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(builder.Build(source->Read(file.frame()).masks, depth, {}));
  }
}
BENCHMARK(TextToLines)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hullslam

BENCHMARK_MAIN();
