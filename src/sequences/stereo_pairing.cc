// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/stereo_pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "sequences/image_list.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// The camera may move by a twentieth of its way between two images, a pixel or two.
constexpr double kMostShare = 0.05;
constexpr double kMilliseconds = 1e3;  // per s

// The median of how much later the nearest right image is, s, over some of the left images.
double Delay(std::span<const double> left, std::span<const double> right) {
  std::vector<double> delays;
  for (const double stamp : left) {
    delays.push_back(right[NearestStamp(right, stamp)] - stamp);
  }
  return Median(std::move(delays));
}

// Two clocks with different rates: the delay changes from the begin to the end. It is only told
// from single late images by the median of several.
void CheckDrift(const std::string& origin, const StampedCamera& left, const StampedCamera& right,
                double most) {
  constexpr size_t kFewest = 10;
  const size_t count = std::max(kFewest, left.stamps.size() / 10);
  if (left.stamps.size() < 2 * count || right.stamps.empty()) {
    return;
  }
  const double at_begin = Delay(left.stamps.first(count), right.stamps);
  const double at_end = Delay(left.stamps.last(count), right.stamps);
  if (std::abs(at_end - at_begin) > most) {
    throw InputError(fmt::format(
        "{}: the stamps of {} and {} drift apart: the right images are {:.1f} ms later at the "
        "begin "
        "and {:.1f} ms later at the end, expected synchronised cameras",
        origin, left.name, right.name, kMilliseconds * at_begin, kMilliseconds * at_end));
  }
}

}  // namespace

std::vector<IndexPair> PairStereoStamps(const std::string& origin, const StampedCamera& left,
                                        const StampedCamera& right, double frames_per_second,
                                        std::vector<std::string>& warnings) {
  const double most = kMostShare / frames_per_second;
  CheckDrift(origin, left, right, most);
  const std::vector<IndexPair> pairs = PairStampsGreedily(left.stamps, right.stamps, most);
  const size_t count = left.stamps.size();
  if (2 * pairs.size() < count) {
    throw InputError(fmt::format(
        "{}: {} of {} images of {} have one of {} within {:.1f} ms, the smallest gap is {:.1f} ms; "
        "expected synchronised cameras",
        origin, pairs.size(), count, left.name, right.name, kMilliseconds * most,
        kMilliseconds * SmallestGap(left.stamps, right.stamps)));
  }
  if (pairs.size() < count || pairs.size() < right.stamps.size()) {
    warnings.push_back(fmt::format(
        "{}: {} of {} images of {} and {} of {} of {} have no partner within {:.1f} ms and are "
        "left "
        "out",
        origin, count - pairs.size(), count, left.name, right.stamps.size() - pairs.size(),
        right.stamps.size(), right.name, kMilliseconds * most));
  }
  return pairs;
}

namespace {

cv::Mat Half(const cv::Mat& both, int half) {
  const int width = both.cols / 2;
  return both.colRange(half * width, (half + 1) * width).clone();
}

}  // namespace

void LoadWithoutDepth(ImageSequence& sequence) {
  std::vector<std::filesystem::path> images;
  for (const FramePaths& frame : sequence.frames) {
    images.push_back(frame.image);
    if (!frame.right.empty()) {
      images.push_back(frame.right);
    }
  }
  const uint16_t brightest = BrightestOf(images);
  sequence.load = [brightest](const FramePaths& frame, const PinholeCamera& camera) {
    ImageInput image{frame.timestamp, ReadGreyImage(frame.image, brightest), cv::Mat()};
    image.right = frame.right.empty() ? cv::Mat() : ReadGreyImage(frame.right, brightest);
    CheckImageSize(frame.image.string(), image.grey, camera);
    if (!frame.right.empty()) {
      CheckImageSize(frame.right.string(), image.right, camera);
    }
    return image;
  };
  sequence.load_colour = [brightest](const FramePaths& frame) {
    return ReadColourImage(frame.image, brightest);
  };
}

void SplitHalves(ImageSequence& sequence) {
  sequence.load = [load = sequence.load](const FramePaths& frame, const PinholeCamera& camera) {
    PinholeCamera of_both = camera;
    of_both.width *= 2;
    ImageInput pair = load(frame, of_both);
    pair.right = Half(pair.grey, 1);
    pair.grey = Half(pair.grey, 0);
    return pair;
  };
  sequence.load_colour = [load = sequence.load_colour](const FramePaths& frame) {
    return Half(load(frame), 0);
  };
}

void RectifyPairs(const std::shared_ptr<const StereoRectifier>& rectifier,
                  ImageSequence& sequence) {
  if (rectifier == nullptr) {
    return;
  }
  const Rigid3& turn = rectifier->rectified_from_left();
  const Eigen::Quaterniond& q = turn.rotation;
  const bool is_turned = q.w() != 1.0;  // not if the pair is rectified as read
  AddWarp({.choice = {"rectified_from_left",
                      fmt::format("{:.9f} {:.9f} {:.9f} {:.9f}", q.x(), q.y(), q.z(), q.w())},
           .image = [rectifier](const cv::Mat& image, ImageSide side,
                                bool /*is_nearest*/) { return rectifier->Rectify(image, side); },
           .pixel = [rectifier](const Eigen::Vector2d& pixel,
                                ImageSide side) { return rectifier->Rectify(pixel, side); },
           .after_from_before = is_turned ? std::optional(turn) : std::nullopt,
           .rectifier = rectifier},
          sequence);
}

}  // namespace hullslam
