// SPDX-License-Identifier: GPL-3.0-or-later
#include "datasets/training_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "features/extractor.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

bool IsImage(const fs::path& path) {
  const std::string extension = LowerCase(path.extension().string());
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

std::vector<fs::path> ImagesOf(const fs::path& folder) {
  std::vector<fs::path> images;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (IsImage(it->path())) {
      images.push_back(it->path());
    }
  }
  if (error) {
    throw InputError(folder.string() + ": " + error.message());
  }
  if (images.empty()) {
    throw InputError(folder.string() + ": has no PNG or JPEG images");
  }
  std::sort(images.begin(), images.end());
  return images;
}

std::vector<Descriptor> DescriptorsOf(const fs::path& path, FeatureExtractor& extractor) {
  constexpr int kLeastSide = 64;
  const cv::Mat image = ReadGreyImage(path);
  if (image.cols < kLeastSide || image.rows < kLeastSide) {
    throw InputError(fmt::format("{}: {}x{} px, expected at least {}x{} px", path.string(),
                                 image.cols, image.rows, kLeastSide, kLeastSide));
  }
  return extractor.Extract(image).descriptors;
}

}  // namespace

std::vector<fs::path> ListTrainingImages(const std::vector<fs::path>& arguments) {
  std::vector<fs::path> images;
  for (const fs::path& argument : arguments) {
    std::error_code error;
    if (fs::is_directory(argument, error)) {
      const std::vector<fs::path> inside = ImagesOf(argument);
      images.insert(images.end(), inside.begin(), inside.end());
    } else {
      images.push_back(argument);
    }
  }
  return images;
}

std::vector<std::vector<Descriptor>> ExtractDescriptors(
    const std::vector<fs::path>& paths, const FeatureOptions& features, TaskRunner& runner,
    const std::function<bool(size_t done)>& go_on) {
  constexpr size_t kBatch = 16;  // images between two reports of the progress
  std::vector<std::vector<Descriptor>> descriptors(paths.size());
  for (size_t begin = 0; begin < paths.size(); begin += kBatch) {
    const size_t count = std::min(kBatch, paths.size() - begin);
    runner.Run(count, [&](size_t i) {
      FeatureExtractor extractor(features);
      descriptors[begin + i] = DescriptorsOf(paths[begin + i], extractor);
    });
    if (!go_on(begin + count)) {
      break;
    }
  }
  return descriptors;
}

}  // namespace hullslam
