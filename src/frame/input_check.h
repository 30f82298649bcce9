// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "features/extractor.h"
#include "hullslam/camera/depth.h"
#include "hullslam/frame/sensor.h"

namespace hullslam {

// Finds faults of the pairs of a stereo camera that a run would not notice: it compares keypoints
// of the two images wherever they are, not only in equal rows.
class PairCheck {
 public:
  static constexpr size_t kFewestMatches = 30;  // fewer say nothing

  // The matches of one pair, and how many of them are in other rows.
  struct PairRows {
    size_t matches = 0;
    size_t off = 0;
  };

  // The images are those that the run uses, CV_8UC1 of equal sizes.
  PairRows Add(const cv::Mat& left, const cv::Mat& right);
  // The same with the features of both images, which have this height, px.
  PairRows Add(const ExtractedFeatures& left, const ExtractedFeatures& right, int height);

  size_t matches() const { return rows_.size(); }
  // The fault of the pairs, for a message that begins with their name; nothing if they are as
  // they should be, or if there are too few matches to say so. Without `need_rows`, points may be
  // in other rows.
  std::optional<std::string> FindFault(bool need_rows = true) const;
  // A warning likewise for pairs that can be used, but would match better if they were calibrated:
  // the rows of a plane that is fitted to all matches differ by more than half a pixel.
  std::optional<std::string> FindDoubt() const;

 private:
  std::vector<double> columns_;          // left - right, px, of each match
  std::vector<double> rows_;             // left - right, px
  std::vector<Eigen::Vector3d> places_;  // of the left points: x, y, px, and 1
};

// Finds input that a run would take without a word, though it cannot be what the user meant: depth
// in another unit, pairs that are no pairs, cameras that do not take their images at the same time.
// Only the first frames are looked at, and later ones now and then.
class InputCheck {
 public:
  explicit InputCheck(const Sensor& sensor, const DepthOptions& depth);

  // Throws InputError for a depth image in metres (CV_32FC1) whose values cannot be metres.
  void CheckDepth(const cv::Mat& depth);
  // The features of both images of a pair, and the depths of the left ones, m, 0 where unknown.
  // Throws InputError for pairs that PairCheck finds a fault in.
  void CheckPair(const ExtractedFeatures& left, const ExtractedFeatures& right,
                 std::span<const float> depths);

  // Messages for the user about input that can be used. May be called by another thread.
  std::vector<std::string> warnings() const;
  void Warn(std::string warning);

 private:
  void CheckDepthsOfPairs();

  const Sensor& sensor_;
  const DepthOptions depth_;
  bool has_depth_ = false;  // a depth image was looked at
  size_t pairs_ = 0;        // that were given
  size_t compared_ = 0;     // that were compared
  size_t useful_ = 0;       // that had enough matches
  size_t off_ = 0;          // in which most points are in other rows
  bool is_late_ = false;    // a warning says so
  PairCheck pair_check_;
  std::vector<float> depths_;  // of the first pairs, m
  mutable std::mutex mutex_;   // guards the warnings
  std::vector<std::string> warnings_;
};

}  // namespace hullslam
