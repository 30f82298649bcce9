// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>

namespace hullslam {

// Why a frame has no pose. The first and the last reason are known at the end of a run; tracking
// gives the others.
enum class TrackingFailure {
  kNoMapYet,         // it comes before the first map, and is not found in it
  kTooFewFeatures,   // the image is dark, blurred, covered or without texture
  kImagesMissing,    // it comes much later than the frame before
  kTooFewLandmarks,  // the place was recognised, but tracking.min_inliers landmarks were not found
  kNotRecognised,    // the image shows nothing of the map, or the camera has moved too far
  kNotJoined,        // it is in an island that was not joined to the map
};

inline constexpr std::array kTrackingFailures = {
    TrackingFailure::kNoMapYet,      TrackingFailure::kTooFewFeatures,
    TrackingFailure::kImagesMissing, TrackingFailure::kTooFewLandmarks,
    TrackingFailure::kNotRecognised, TrackingFailure::kNotJoined};

// For messages: "too few features" and so on.
constexpr std::string_view ToString(TrackingFailure failure) {
  switch (failure) {
    case TrackingFailure::kNoMapYet:
      return "no map yet";
    case TrackingFailure::kTooFewFeatures:
      return "too few features";
    case TrackingFailure::kImagesMissing:
      return "images are missing";
    case TrackingFailure::kTooFewLandmarks:
      return "too few landmarks";
    case TrackingFailure::kNotRecognised:
      return "nothing recognised";
    default:
      return "not joined to the map";
  }
}

// Why a monocular camera has no map yet.
enum class InitialisationFailure {
  kTooFewFeatures,     // the image has little texture
  kTooFewMatches,      // the image shows too little of what earlier images showed
  kTooLittleParallax,  // the camera has not moved enough, or has only turned
  kAmbiguous,          // two different motions explain the images
  kTooFewPoints,       // the motion explains too few matches
  kNotConfirmed,       // the frames in between do not fit into the map
};

inline constexpr std::array kInitialisationFailures = {
    InitialisationFailure::kTooFewFeatures,    InitialisationFailure::kTooFewMatches,
    InitialisationFailure::kTooLittleParallax, InitialisationFailure::kAmbiguous,
    InitialisationFailure::kTooFewPoints,      InitialisationFailure::kNotConfirmed};

// For messages: "too little parallax" and so on.
constexpr std::string_view ToString(InitialisationFailure failure) {
  switch (failure) {
    case InitialisationFailure::kTooFewFeatures:
      return "too few features";
    case InitialisationFailure::kTooFewMatches:
      return "too few matches";
    case InitialisationFailure::kTooLittleParallax:
      return "too little parallax";
    case InitialisationFailure::kAmbiguous:
      return "ambiguous motion";
    case InitialisationFailure::kTooFewPoints:
      return "too few points";
    default:
      return "not confirmed by other frames";
  }
}

}  // namespace hullslam
