// SPDX-License-Identifier: GPL-3.0-or-later
// Extraction of ORB features, and each of its stages, on IMAGE or, without it, on a drawn image:
//   extraction_bench [IMAGE] [benchmark options]
#include <benchmark/benchmark.h>

#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "features/corners.h"
#include "features/orb_descriptor.h"
#include "features/pyramid.h"
#include "features/quadtree_selection.h"
#include "hullslam/features/extractor.h"
#include "hullslam/features/feature_grid.h"

namespace hullslam {
namespace {

cv::Mat MakeImage() {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(120));
  cv::RNG random(7);
  for (int i = 0; i < 260; ++i) {
    const cv::Rect box(random.uniform(0, 640), random.uniform(0, 480), random.uniform(4, 60),
                       random.uniform(4, 60));
    cv::rectangle(image, box, cv::Scalar(random.uniform(0, 256)), cv::FILLED);
  }
  cv::Mat noise(image.size(), CV_16SC1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 4.0);
  cv::add(image, noise, image, cv::noArray(), CV_8UC1);
  return image;
}

void Extraction(benchmark::State& state, const cv::Mat& image) {
  FeatureExtractor extractor(FeatureOptions{});
  size_t found = 0;
  for (auto _ : state) {
    found = extractor.Extract(image).keypoints.size();
  }
  state.counters["features"] = static_cast<double>(found);
}

void Pyramid(benchmark::State& state, const cv::Mat& image) {
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  for (auto _ : state) {
    pyramid.Build(image);
  }
}

// Runs over all levels of the pyramid, as in an extraction.
void Corners(benchmark::State& state, const cv::Mat& image) {
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  pyramid.Build(image);
  CornerDetector detector(20, 7);
  std::vector<Corner> corners;
  size_t found = 0;
  for (auto _ : state) {
    found = 0;
    for (int l = 0; l < 8; ++l) {
      detector.Detect(pyramid.level(l), kPatchReach, corners);
      found += corners.size();
    }
  }
  state.counters["corners"] = static_cast<double>(found);
}

void Selection(benchmark::State& state, const cv::Mat& image) {
  std::vector<Corner> all;
  CornerDetector(20, 7).Detect(image, kPatchReach, all);
  QuadtreeSelection selection;
  std::vector<Corner> corners;
  std::vector<Corner> selected;
  for (auto _ : state) {
    corners = all;
    selection.Select(corners, image.size(), 217, selected);
  }
  state.counters["corners"] = static_cast<double>(all.size());
}

void Blur(benchmark::State& state, const cv::Mat& image) {
  ImagePyramid pyramid(ScaleLevels::Create(8, 1.2));
  pyramid.Build(image);
  cv::Mat blurred;
  for (auto _ : state) {
    for (int l = 0; l < 8; ++l) {
      cv::GaussianBlur(pyramid.level(l), blurred, cv::Size(7, 7), 2.0, 2.0);
    }
  }
}

std::vector<cv::Point> ThousandPixels(const cv::Mat& image) {
  std::vector<cv::Point> pixels;
  cv::RNG random(3);
  for (int i = 0; i < 1000; ++i) {
    pixels.emplace_back(random.uniform(kPatchReach, image.cols - kPatchReach),
                        random.uniform(kPatchReach, image.rows - kPatchReach));
  }
  return pixels;
}

void Orientations(benchmark::State& state, const cv::Mat& image) {
  const std::vector<cv::Point> pixels = ThousandPixels(image);
  for (auto _ : state) {
    for (const cv::Point& pixel : pixels) {
      benchmark::DoNotOptimize(ComputeOrientation(image, pixel).Angle());
    }
  }
}

void Descriptors(benchmark::State& state, const cv::Mat& image) {
  const std::vector<cv::Point> pixels = ThousandPixels(image);
  std::vector<Orientation> orientations;
  for (const cv::Point& pixel : pixels) {
    orientations.push_back(ComputeOrientation(image, pixel));
  }
  for (auto _ : state) {
    for (size_t i = 0; i < pixels.size(); ++i) {
      benchmark::DoNotOptimize(ComputeDescriptor(image, pixels[i], orientations[i]));
    }
  }
}

void FindNear(benchmark::State& state, const cv::Mat& image) {
  FeatureExtractor extractor(FeatureOptions{});
  const std::vector<Keypoint> keypoints = extractor.Extract(image).keypoints;
  const FeatureGrid grid(keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  std::vector<uint32_t> found;
  for (auto _ : state) {
    for (const Keypoint& keypoint : keypoints) {
      found.clear();
      grid.FindNear(keypoints, keypoint.raw, 15.0f, keypoint.level - 1, keypoint.level, found);
      benchmark::DoNotOptimize(found.data());
    }
  }
}

void Register(const cv::Mat& image) {
  using Function = void (*)(benchmark::State&, const cv::Mat&);
  const std::vector<std::pair<const char*, Function>> all = {{"Extraction", Extraction},
                                                             {"Pyramid", Pyramid},
                                                             {"Corners", Corners},
                                                             {"SelectionLevel0", Selection},
                                                             {"Blur", Blur},
                                                             {"Orientations1000", Orientations},
                                                             {"Descriptors1000", Descriptors},
                                                             {"FindNear1000", FindNear}};
  for (const auto& [name, function] : all) {
    benchmark::RegisterBenchmark(name, [image, run = function](benchmark::State& state) {
      run(state, image);
    })->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace hullslam

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  cv::setNumThreads(1);
  const cv::Mat image =
      argc > 1 ? cv::imread(argv[1], cv::IMREAD_GRAYSCALE) : hullslam::MakeImage();
  if (image.empty()) {
    std::fprintf(stderr, "error: %s: the file cannot be read as an image\n", argv[1]);
    return 2;
  }
  hullslam::Register(image);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
