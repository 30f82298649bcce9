// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/lost_frames.h"

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

LossReason ReasonOf(TrackingFailure failure) {
  switch (failure) {
    case TrackingFailure::kTooFewFeatures:
      return LossReason::kTooFewFeatures;
    case TrackingFailure::kImagesMissing:
      return LossReason::kImagesMissing;
    case TrackingFailure::kTooFewLandmarks:
      return LossReason::kTooFewLandmarks;
    default:
      return LossReason::kNotRecognised;
  }
}

LossReason ReasonOf(const FrameNote& note) {
  switch (note.state) {
    case TrackingState::kNotInitialized:
      return LossReason::kNoMapYet;
    case TrackingState::kTracked:
      return LossReason::kNotJoined;
    default:
      return ReasonOf(note.loss.value_or(TrackingFailure::kNotRecognised));
  }
}

}  // namespace

std::string_view ToString(LossReason reason) {
  switch (reason) {
    case LossReason::kNoMapYet:
      return "no map yet";
    case LossReason::kTooFewFeatures:
      return ToString(TrackingFailure::kTooFewFeatures);
    case LossReason::kImagesMissing:
      return ToString(TrackingFailure::kImagesMissing);
    case LossReason::kTooFewLandmarks:
      return ToString(TrackingFailure::kTooFewLandmarks);
    case LossReason::kNotRecognised:
      return ToString(TrackingFailure::kNotRecognised);
    default:
      return "not joined to the map";
  }
}

std::string_view AdviceFor(LossReason reason) {
  switch (reason) {
    case LossReason::kNoMapYet:
      return "begin with a sideways motion in front of a textured scene; in a car, which can only "
             "go forward, --set ORBextractor.nFeatures=2000";
    case LossReason::kTooFewFeatures:
      return "the images are dark, blurred, covered or plain: more light, a shorter exposure, or "
             "--set ORBextractor.minThFAST=3";
    case LossReason::kImagesMissing:
      return "record without gaps; the camera must see a known place again after a gap";
    case LossReason::kTooFewLandmarks:
      return "more features: --set ORBextractor.nFeatures=2000";
    case LossReason::kNotRecognised:
      return "move more slowly, record more images per second, or --set "
             "ORBextractor.nFeatures=2000";
    default:
      return "let the camera see an earlier place again, or write these parts with --keep-islands";
  }
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
      stretches.push_back({.first_frame = note.number,
                           .first_timestamp = frames[i].timestamp,
                           .reason = ReasonOf(note)});
      open = note.state;
    }
    LostStretch& stretch = stretches.back();
    stretch.last_frame = note.number;
    stretch.last_timestamp = frames[i].timestamp;
    ++stretch.frames;
  }
  return stretches;
}

}  // namespace hullslam
