// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/slam_run.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/datasets/input_checks.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"
#include "masks/mask_all.h"
#include "results/output_folder.h"
#include "results/run_report.h"
#include "run/dataset_arguments.h"
#include "run/more_outputs.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/view_arguments.h"
#include "run/vocabularies.h"
#include "segmentation/frame_source.h"
#include "util/text.h"

namespace hullslam {
namespace {

using Clock = std::chrono::steady_clock;

PipelineKind ChoosePipeline(const RunArguments& arguments) {
  if (!arguments.threaded) {
    return PipelineKind::kSequential;
  }
  return arguments.realtime ? PipelineKind::kRealtime : PipelineKind::kThreaded;
}

// The bundle adjustment of a large map and the final poses of many frames take long. So their
// progress is shown.
void FinishMap(bool is_quiet, System& system) {
  constexpr std::chrono::seconds kStep(2);
  if (!is_quiet && !IsInterrupted()) {
    PrintError("finishing the map\n");
  }
  Clock::time_point shown = Clock::now();
  const auto is_due = [&] {
    const bool is_late = !is_quiet && Clock::now() - shown > kStep;
    shown = is_late ? Clock::now() : shown;
    return is_late;
  };
  system.Finish(
      &Interruption(),
      [&](int done, int most) {
        if (is_due()) {
          PrintError("finishing the map: iteration {} of at most {}\n", done, most);
        }
      },
      [&](int done, int most) {
        if (is_due()) {
          PrintError("finishing the poses: frame {} of {}\n", done, most);
        }
      });
}

// Notes what tracking tells about a frame that comes so long after the first one, s.
void NoteFrame(const FrameReport& report, const FrameSelection& selection, double time,
               RunResult& result) {
  if (report.failure) {
    ++result.initialisation.failures[std::string(ToString(*report.failure))];
  } else if (report.tracked.state == TrackingState::kTracked && !result.initialisation.seconds) {
    result.initialisation.seconds = time;
  }
  result.notes.push_back({.number = selection.first + (result.given - 1) * selection.stride,
                          .state = report.tracked.state,
                          .loss = report.loss,
                          .is_unsure = report.tracked.is_unsure});
}

// The masks from files, or from a network. In real time the network has none before tracking.
SequenceMasks OpenRunMasks(const RunArguments& arguments, const ImageSequence& sequence,
                           const PinholeCamera& camera) {
  if (arguments.segment.empty()) {
    MaskRequest request = RequestOf(arguments.masks, arguments.masks_format, sequence, camera);
    SequenceMasks masks(request, MaskFrames(sequence));
    if (!arguments.masks_right.empty()) {
      request.path = arguments.masks_right;
      masks.AddRight(request, RightMaskFrames(sequence));
    }
    return masks;
  }
  // In real time a second thread of the network would only take time from tracking.
  const SegmenterOptions options = {.threads = arguments.realtime ? 1 : 0};
  return SequenceMasks(std::make_unique<NetworkMasks>(
                           arguments.segment, options,
                           arguments.realtime ? 0 : arguments.segment_every, sequence, camera),
                       MaskFrames(sequence));
}

// Prints the warnings that are new since the last call. `printed` counts them.
void PrintNewWarnings(const System& system, size_t& printed, Progress& progress) {
  std::vector<std::string> warnings = system.warnings();
  if (printed < warnings.size()) {
    progress.Clear();
    warnings.erase(warnings.begin(), warnings.begin() + static_cast<std::ptrdiff_t>(printed));
    PrintWarnings(warnings);
    printed += warnings.size();
  }
}

// Tracks frames until an interruption or bad input (InputError). `shown` is the last failure.
void TrackFrames(const SlamRun& run, const std::optional<InitialisationFailure>& shown,
                 Clock::time_point& start, Progress& progress, RunResult& result) {
  FrameSource frames(run.arguments.realtime ? Pace::kRealtime : Pace::kFast, run.sequence,
                     run.settings.options.camera, run.masks, run.system, run.live.IsOn(),
                     &Interruption());
  size_t warnings = 0;
  MapSaver saver(run.arguments.save_map, MapSettingsOf(run.settings.options),
                 run.arguments.checkpoint, [](const std::string& why) { PrintWarnings({why}); });
  while (!IsInterrupted()) {
    // A pause does not count as time of the run.
    const Clock::duration waited = run.live.BeforeFrame(run.system, IsInterrupted, [&] {
      progress.Clear();
      frames.Pause();
    });
    frames.Resume();
    start += waited;
    progress.Skip(waited);
    std::optional<LoadedFrame> loaded = frames.Next();
    if (!loaded) {
      break;
    }
    ++result.given;
    if (!loaded->frame) {
      if (run.arguments.strict) {
        throw InputError(loaded->error);
      }
      progress.Clear();
      PrintError("warning: {}; this frame is skipped\n", loaded->error);
      ++result.skipped;
      continue;
    }
    const Clock::time_point begin = Clock::now();
    const TrackedFrame frame = frames.Track(*loaded);
    PrintNewWarnings(run.system, warnings, progress);
    saver.Offer(run.system.map());
    const std::chrono::duration<double, std::milli> time = Clock::now() - begin;
    run.live.AfterFrame({.grey = loaded->grey,
                         .number = result.given,
                         .build_ms = loaded->build_ms,
                         .track_ms = time.count()},
                        run.system);
    progress.Show(result.given,
                  [&] { return DescribeState(frame.state, shown, run.system.map().get()); });
  }
  frames.Finish();
}

void WarnOfFailedMasks(const SequenceMasks& masks) {
  const auto work = masks.network() != nullptr ? masks.network()->work() : NetworkMasks::Work();
  if (work.failures > 0) {
    PrintError("warning: the network fails on {}, which {} no masks; the first failure is {}\n",
               Counted(work.failures, "image"), work.failures == 1 ? "has" : "have",
               work.first_failure);
  }
}

RunResult TrackAll(const SlamRun& run) {
  RunResult result;
  System& system = run.system;
  Progress progress(run.sequence.frames.size(), run.arguments.quiet);
  std::optional<InitialisationFailure> failure;  // failure of the last frame
  system.SetFrameCallback([&](const FrameReport& report) {
    failure = report.failure;
    run.live.NoteFrame(report);
    NoteFrame(report, run.arguments.selection,
              report.tracked.timestamp - run.sequence.frames.front().timestamp, result);
  });
  Clock::time_point start = Clock::now();
  try {
    TrackFrames(run, failure, start, progress, result);
  } catch (const InputError& error) {
    // A frame that is refused changes nothing, so the results up to it can be written.
    result.input_failure = error.what();
    result.given = system.frames().size() + result.skipped;
  }
  progress.Clear();
  system.SetFrameCallback({});
  if (run.arguments.live_poses) {
    run.output.Write({"live_poses.txt", FormatLivePoses(system.frames())});
    if (!run.arguments.mcap.empty()) {
      result.live.assign(system.frames().begin(), system.frames().end());
    }
  }
  run.live.BeginFinishing();
  FinishMap(run.arguments.quiet, system);
  result.was_interrupted = IsInterrupted();
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  WarnOfFailedMasks(run.masks);
  return result;
}

std::vector<std::filesystem::path> InputsOf(const RunArguments& arguments) {
  return {arguments.sequence,
          arguments.masks,
          arguments.masks_right,
          arguments.mask_all,
          arguments.mask_all_right,
          arguments.segment,
          arguments.settings,
          arguments.associations,
          arguments.vocabulary,
          arguments.load_map,
          arguments.odometry,
          arguments.groundtruth == "none" ? std::filesystem::path() : arguments.groundtruth};
}

void WarnOfInput(const RunArguments& arguments, const SystemOptions& options,
                 const ImageSequence& sequence, const SequenceMasks& masks) {
  if (options.sensor == SensorKind::kRgbd) {
    PrintWarnings(CheckDepth(sequence, options.camera));
  }
  if (masks.network() == nullptr) {
    PrintWarnings(
        CheckMaskPlaces(sequence, options.camera, [&](size_t frame) { return masks.Read(frame); }));
  }
  PrintWarnings(CheckClasses(options, [&] { return masks.Labels(); }));
  PrintWarnings(CheckLastFrame(arguments.selection, sequence));
}

void PrintInput(const RunArguments& arguments, const LoadedSettings& settings,
                std::span<const std::string> notes, const SequenceMasks& masks) {
  const SystemOptions& options = settings.options;
  if (arguments.quiet) {
    return;
  }
  for (const std::string& note : notes) {
    Print("{}\n", note);
  }
  if (!settings.notes.camera_note.empty()) {
    Print("camera: {}\n", settings.notes.camera_note);
  }
  if (settings.preset) {
    Print("{}\n", DescribePreset(settings));
  }
  Print("up to {} features on {} levels in each image of {}x{} px\n",
        options.features.feature_count, options.features.level_count, options.camera.width,
        options.camera.height);
  if (masks.format()) {
    Print("{}\n", masks.Describe());
  }
}

// Reads the masks of all images into the options.
void ReadMasksOfAll(const RunArguments& arguments, const ImageSequence& sequence,
                    SystemOptions& options) {
  const auto read = [&](const std::filesystem::path& path, ImageSide side, cv::Mat& mask) {
    if (path.empty()) {
      return;
    }
    mask = ReadMaskAll(path, sequence, options.camera, side);
    const double ignored = IgnoredShare(mask);
    if (!arguments.quiet) {
      Print("one mask for all {}images: {}, {:.1f} % of the pixels are ignored\n",
            side == ImageSide::kRight ? "right " : "", path.string(), 100.0 * ignored);
    }
    constexpr double kMuch = 0.5;
    if (ignored > kMuch) {
      PrintError(
          "warning: {} ignores {:.0f} % of the pixels of each image: its black ones; are black and "
          "white exchanged?\n",
          path.string(), 100.0 * ignored);
    }
  };
  read(arguments.mask_all, ImageSide::kLeft, options.mask_all);
  read(arguments.mask_all_right, ImageSide::kRight, options.mask_all_right);
}

}  // namespace

int RunSlam(const RunArguments& arguments, LoadedSettings settings, const ImageSequence& sequence,
            std::span<const std::string> notes) {
  CheckPresetHasMasks(settings, arguments.segment.empty() ? arguments.masks : arguments.segment);
  SystemOptions& options = settings.options;
  options.vocabulary = ChooseVocabulary(arguments.vocabulary, arguments.quiet);
  options.seed = arguments.seed;
  // The first image is loaded now, so that a wrong type or size is reported early.
  sequence.load(sequence.frames.front(), options.camera);
  ReadMasksOfAll(arguments, sequence, options);
  const std::optional<Trajectory> groundtruth = FindGroundtruth(sequence);
  const SequenceMasks masks = OpenRunMasks(arguments, sequence, options.camera);
  CatchInterrupts();
  CheckSavedFiles(arguments);
  SystemStart start = LoadStart(arguments, options);
  const size_t earlier_sessions = start.map.sessions().size();
  LiveOutput live = OpenLiveOutput(arguments, options, sequence, groundtruth);
  OutputFolder output(arguments.output, "summary.json", InputsOf(arguments),
                      {arguments.program, arguments.overwrite});
  WarnOfInput(arguments, options, sequence, masks);
  PrintInput(arguments, settings, notes, masks);
  System system(options, ChoosePipeline(arguments), std::move(start));
  const SlamRun run = {.arguments = arguments,
                       .settings = settings,
                       .sequence = sequence,
                       .masks = masks,
                       .groundtruth = groundtruth,
                       .system = system,
                       .live = live,
                       .output = output,
                       .earlier_sessions = earlier_sessions};
  const RunResult result = TrackAll(run);
  options.depth = system.options().depth;
  if (result.input_failure && system.frames().empty()) {
    throw InputError(*result.input_failure);
  }
  if (result.was_interrupted && result.given == 0) {
    return FailIfAny({"the run was interrupted before the first frame; nothing was written"});
  }
  return FinishSlam(run, result);
}

}  // namespace hullslam
