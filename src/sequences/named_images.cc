// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/named_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

#include "files/paths.h"
#include "hullslam/util/error.h"
#include "sequences/image_list.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// How many units of a stamp of a clock are a second; 0 for the number of a frame.
double UnitsOfClock(std::string_view number) {
  if (number.find('.') != std::string_view::npos) {
    return 1.0;
  }
  switch (number.size()) {
    case 13:
      return 1e3;
    case 16:
      return 1e6;
    case 19:
      return 1e9;
    default:
      return 0.0;
  }
}

struct NamedImage {
  fs::path file;
  double number = 0.0;
  double units_per_second = 0.0;  // 0: the number of a frame
};

NamedImage ParseNamedImage(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::string_view text = LastNumber(stem);
  constexpr double kLargest = 1e19;
  NamedImage image{file};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), image.number);
  if (text.empty() || error != std::errc() || !(image.number < kLargest)) {
    throw InputError(file.string() +
                     ": the name has neither the number of a frame nor a time stamp; expected such "
                     "names, or a list with lines 'timestamp file'");
  }
  image.units_per_second = UnitsOfClock(text);
  return image;
}

// Refuses numbers that are too far apart for frames, such as microseconds since the start, and
// stamps that are too near to each other, such as "1.0007" for image 7 of camera 1.
void CheckSteps(const fs::path& folder, const NamedImages& images, double frames_per_second) {
  constexpr double kMostFrames = 100.0;
  constexpr double kLeastSeconds = 1e-3;
  if (images.frames.size() < 2) {
    return;
  }
  const double seconds = (images.frames.back().timestamp - images.frames.front().timestamp) /
                         static_cast<double>(images.frames.size() - 1);
  const double frames = seconds * frames_per_second;
  if (images.are_numbered ? frames > kMostFrames : seconds < kLeastSeconds) {
    throw InputError(fmt::format(
        "{}: the numbers in the names of its images are {:.4g} apart on average, so they are "
        "neither numbers of frames nor time stamps of a known unit; expected a list with lines "
        "'timestamp file'",
        folder.string(), images.are_numbered ? frames : seconds));
  }
}

}  // namespace

std::string_view LastNumber(std::string_view name) {
  const auto is_digit = [&](size_t i) { return IsDigit(name[i]); };
  size_t end = name.size();
  while (end > 0 && !is_digit(end - 1)) {
    --end;
  }
  size_t begin = end;
  while (begin > 0 && is_digit(begin - 1)) {
    --begin;
  }
  if (begin >= 2 && name[begin - 1] == '.' && is_digit(begin - 2)) {
    for (--begin; begin > 0 && is_digit(begin - 1);) {
      --begin;
    }
  }
  return name.substr(begin, end - begin);
}

std::vector<fs::path> ListImages(const fs::path& folder, std::string_view part) {
  constexpr std::array<std::string_view, 3> kRead = {".png", ".jpg", ".jpeg"};
  constexpr std::array<std::string_view, 7> kOthers = {".bmp", ".tif", ".tiff", ".webp",
                                                       ".pgm", ".ppm", ".gif"};
  std::vector<fs::path> images;
  for (const fs::path& file : ListFolder(folder)) {
    if (file.filename().string().find(part) == std::string::npos) {
      continue;
    }
    const std::string extension = LowerCase(file.extension().string());
    if (std::find(kOthers.begin(), kOthers.end(), extension) != kOthers.end()) {
      throw InputError(file.string() + ": is neither a PNG nor a JPEG image, expected only those");
    }
    if (std::find(kRead.begin(), kRead.end(), extension) != kRead.end()) {
      images.push_back(file);
    }
  }
  if (images.empty()) {
    throw InputError(folder.string() + ": has no PNG or JPEG images");
  }
  if (images.size() > kMostImages) {
    throw InputError(fmt::format("{}: more than {} images", folder.string(), kMostImages));
  }
  std::sort(images.begin(), images.end(), [](const fs::path& a, const fs::path& b) {
    return IsNaturallyBefore(a.filename().string(), b.filename().string());
  });
  return images;
}

NamedImages FindNamedImages(const fs::path& folder, double frames_per_second,
                            std::string_view part) {
  std::vector<NamedImage> images;
  for (const fs::path& file : ListImages(folder, part)) {
    images.push_back(ParseNamedImage(file));
    if (images.back().units_per_second != images.front().units_per_second) {
      throw InputError(fmt::format("{}: the number in the name is of another kind than that of {}",
                                   file.string(), images.front().file.filename().string()));
    }
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const NamedImage& a, const NamedImage& b) { return a.number < b.number; });
  NamedImages named{.are_numbered = images.front().units_per_second == 0.0};
  const double units = named.are_numbered ? frames_per_second : images.front().units_per_second;
  for (size_t i = 0; i < images.size(); ++i) {
    if (i > 0 && images[i].number == images[i - 1].number) {
      throw InputError(fmt::format("{}: the last number in the name is that of {} too",
                                   images[i].file.string(),
                                   images[i - 1].file.filename().string()));
    }
    named.frames.push_back({images[i].number / units, images[i].file, {}, i});
  }
  CheckSteps(folder, named, frames_per_second);
  return named;
}

}  // namespace hullslam
