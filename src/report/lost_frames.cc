// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/lost_frames.h"

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

TrackingFailure ReasonOf(const FrameNote& note) {
  switch (note.state) {
    case TrackingState::kNotInitialized:
      return TrackingFailure::kNoMapYet;
    case TrackingState::kTracked:
      return TrackingFailure::kNotJoined;
    default:
      return note.loss.value_or(TrackingFailure::kNotRecognised);
  }
}

}  // namespace

std::string_view AdviceFor(TrackingFailure reason) {
  switch (reason) {
    case TrackingFailure::kNoMapYet:
      return "begin with a sideways motion in front of a textured scene; in a car, which can only "
             "go forward, --set ORBextractor.nFeatures=2000";
    case TrackingFailure::kTooFewFeatures:
      return "the images are dark, blurred, covered or plain: more light, a shorter exposure, or "
             "--set ORBextractor.minThFAST=3";
    case TrackingFailure::kImagesMissing:
      return "record without gaps; the camera must see a known place again after a gap";
    case TrackingFailure::kTooFewLandmarks:
      return "more features: --set ORBextractor.nFeatures=2000";
    case TrackingFailure::kNotRecognised:
      return "move more slowly, record more images per second, or --set "
             "ORBextractor.nFeatures=2000";
    default:
      return "let the camera see an earlier place again, or write these parts with --keep-islands";
  }
}

void FrameStretch::Add(size_t number, double timestamp) {
  if (frames == 0) {
    first_frame = number;
    first_timestamp = timestamp;
  }
  last_frame = number;
  last_timestamp = timestamp;
  ++frames;
}

std::vector<LostStretch> FindLostStretches(std::span<const TrackedFrame> frames,
                                           std::span<const FrameNote> notes) {
  Check(frames.size() == notes.size(), "each frame needs a note");
  std::vector<LostStretch> stretches;
  std::optional<TrackingState> open;  // of the stretch that the frame before belongs to
  for (size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].state == TrackingState::kTracked) {
      open.reset();
      continue;
    }
    const FrameNote& note = notes[i];
    if (open != note.state) {
      stretches.emplace_back().reason = ReasonOf(note);
      open = note.state;
    }
    stretches.back().Add(note.number, frames[i].timestamp);
  }
  return stretches;
}

std::vector<FrameStretch> FindUnsureStretches(std::span<const TrackedFrame> frames,
                                              std::span<const FrameNote> notes) {
  Check(frames.size() == notes.size(), "each frame needs a note");
  std::vector<FrameStretch> stretches;
  bool is_open = false;  // whether the frame before belongs to the last stretch
  for (size_t i = 0; i < frames.size(); ++i) {
    const bool is_unsure = frames[i].state == TrackingState::kTracked && notes[i].is_unsure;
    if (is_unsure && !is_open) {
      stretches.emplace_back();
    }
    if (is_unsure) {
      stretches.back().Add(notes[i].number, frames[i].timestamp);
    }
    is_open = is_unsure;
  }
  return stretches;
}

}  // namespace hullslam
