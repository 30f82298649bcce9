// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "synthetic/sequence_plan.h"

namespace hullslam::synthetic {

// A sequence of the suite. It plays the part of a sequence of the paper (Yu et al. 2025).
struct SuiteSequence {
  std::string_view name;
  std::string_view plays;    // the name of that sequence in the paper's tables
  std::string_view special;  // what is special about it, a sentence for the user
  DatasetForm form = DatasetForm::kTum;
  double readout_time = 0.0;  // s, of the rolling shutter
  // The scene, always the same, without the path of the camera. Whatever moves in it does so in the
  // given number of frames.
  Scene (*furnish)(int frames) = nullptr;
  // The path of the camera (world from camera at a time in seconds), without the motion of the
  // hand.
  std::function<Rigid3(double)> (*path)(int frames) = nullptr;
};

inline constexpr int kSuiteFrames = 300;

// All sequences in the order of the paper's tables.
std::span<const SuiteSequence> SuiteSequences();

// The sequences with these names, in the order of the suite; all of them if there are no names.
// Throws InputError, which lists the names, for a name that no sequence has.
std::vector<const SuiteSequence*> SelectSuite(std::span<const std::string> names);

// The plan of a sequence. Its path is made for 300 frames: fewer frames are the beginning of it,
// and with more frames the camera moves more slowly. Another seed gives another rendering of the
// same scene: the hand moves in another way and the sensor has other noise.
SequencePlan PlanOf(const SuiteSequence& sequence, int frames, uint64_t seed);

}  // namespace hullslam::synthetic
