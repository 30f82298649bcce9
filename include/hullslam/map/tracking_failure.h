// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>

namespace hullslam {

// Why a frame has no pose although there is a map.
enum class TrackingFailure {
  kTooFewFeatures,   // the image is dark, blurred, covered or without texture
  kImagesMissing,    // it comes much later than the frame before
  kTooFewLandmarks,  // the place was recognised, but tracking.min_inliers landmarks were not found
  kNotRecognised,    // the image shows nothing of the map, or the camera has moved too far
};

inline constexpr std::array kTrackingFailures = {
    TrackingFailure::kTooFewFeatures, TrackingFailure::kImagesMissing,
    TrackingFailure::kTooFewLandmarks, TrackingFailure::kNotRecognised};

// For messages: "too few features" and so on.
constexpr std::string_view ToString(TrackingFailure failure) {
  switch (failure) {
    case TrackingFailure::kTooFewFeatures:
      return "too few features";
    case TrackingFailure::kImagesMissing:
      return "images are missing";
    case TrackingFailure::kTooFewLandmarks:
      return "too few landmarks";
    default:
      return "nothing recognised";
  }
}

}  // namespace hullslam
