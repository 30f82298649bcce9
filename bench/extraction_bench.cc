// SPDX-License-Identifier: GPL-3.0-or-later
// Extraction of ORB features beside that of OpenCV, and each of its stages, on the given images or,
// without them, on a drawn image. The stages use the first image only.
//   extraction_bench [IMAGE...] [benchmark options]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "features/corners.h"
#include "features/extractor.h"
#include "features/orb_descriptor.h"
#include "features/pyramid.h"
#include "features/quadtree_selection.h"
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

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Milliseconds.
template <typename Function>
double Time(const Function& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

// The yardstick: OpenCV's ORB with 1000 features on the same images, in turn with ours, so that
// both suffer from the same other work. Prints the medians and their ratio. OpenCV uses one thread.
void BesideOrb(benchmark::State& state, const std::vector<cv::Mat>& images) {
  FeatureExtractor extractor(FeatureOptions{});
  const cv::Ptr<cv::ORB> orb = cv::ORB::create(1000);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  std::vector<double> ours;
  std::vector<double> theirs;
  for (auto _ : state) {
    const cv::Mat& image = images[ours.size() % images.size()];
    ours.push_back(Time([&] { benchmark::DoNotOptimize(extractor.Extract(image)); }));
    theirs.push_back(
        Time([&] { orb->detectAndCompute(image, cv::noArray(), keypoints, descriptors); }));
  }
  state.counters["ours_ms"] = Median(ours);
  state.counters["orb_ms"] = Median(theirs);
  state.counters["ratio"] = Median(ours) / Median(theirs);
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
  OrbBlur blur;
  for (auto _ : state) {
    for (int l = 0; l < 8; ++l) {
      benchmark::DoNotOptimize(blur.Blur(pyramid.level(l)).data);
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
  std::vector<Keypoint> keypoints;
  for (const RawKeypoint& keypoint : extractor.Extract(image).keypoints) {
    keypoints.push_back({.undistorted = keypoint.raw, .level = keypoint.level});
  }
  const FeatureGrid grid(keypoints, {0.0f, 0.0f}, {640.0f, 480.0f});
  for (auto _ : state) {
    GridSearch search(grid, keypoints);
    for (const Keypoint& keypoint : keypoints) {
      benchmark::DoNotOptimize(
          search.FindNear(keypoint.undistorted, 15.0f, keypoint.level - 1, keypoint.level).data());
    }
  }
}

void Register(const std::vector<cv::Mat>& images) {
  const cv::Mat& image = images.front();
  benchmark::RegisterBenchmark("BesideOrb",
                               [images](benchmark::State& state) { BesideOrb(state, images); })
      ->Unit(benchmark::kMillisecond)
      ->MinTime(3.0);
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
  std::vector<cv::Mat> images;
  for (int i = 1; i < argc; ++i) {
    images.push_back(cv::imread(argv[i], cv::IMREAD_GRAYSCALE));
    if (images.back().empty()) {
      std::fprintf(stderr, "error: %s: the file cannot be read as an image\n", argv[i]);
      return 2;
    }
  }
  if (images.empty()) {
    images.push_back(hullslam::MakeImage());
  }
  hullslam::Register(images);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
