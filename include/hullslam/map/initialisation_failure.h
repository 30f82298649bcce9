// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>

namespace hullslam {

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
