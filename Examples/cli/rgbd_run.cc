// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/rgbd_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <thread>
#include <vector>

#include "cli/interrupt.h"
#include "cli/mask_arguments.h"
#include "cli/object_outputs.h"
#include "cli/program.h"
#include "cli/progress.h"
#include "hullslam/eval/ate.h"
#include "hullslam/eval/rpe.h"
#include "hullslam/io/atomic_file.h"
#include "hullslam/io/output_folder.h"
#include "hullslam/io/ply_file.h"
#include "hullslam/io/settings.h"
#include "hullslam/io/summary.h"
#include "hullslam/io/trajectory_file.h"
#include "hullslam/system/compose_trajectory.h"
#include "hullslam/system/prefetcher.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr size_t kImagesAhead = 4;
constexpr size_t kLostForGood = 30;  // the run has failed if the last 30 frames or more are lost

using Clock = std::chrono::steady_clock;

// An image, or the reason why it could not be loaded.
struct LoadedFrame {
  std::optional<ImageInput> image;
  std::string error;
};

struct RunResult {
  size_t given = 0;    // frames that were loaded or skipped before the run ended
  size_t skipped = 0;  // those of them with an image that cannot be read
  double seconds = 0.0;
  bool was_interrupted = false;
};

SystemOptions LoadOptions(const RunArguments& arguments) {
  const std::filesystem::path settings =
      arguments.settings.empty() ? FindDefaultSettings(arguments.sequence, FindConfigFolder())
                                 : arguments.settings;
  return ReadSettings(settings, arguments.overrides);
}

PipelineKind ChoosePipeline(const RunArguments& arguments) {
  if (!arguments.threaded) {
    return PipelineKind::kSequential;
  }
  return arguments.realtime ? PipelineKind::kRealtime : PipelineKind::kThreaded;
}

// An image that cannot be read is reported in LoadedFrame, so that the frame can be skipped. Masks
// that cannot be read end the run, because a frame without its masks would look like a frame
// without objects.
Prefetcher<LoadedFrame> StartLoading(const TumSequence& sequence, const PinholeCamera& camera,
                                     const SequenceMasks& masks) {
  return Prefetcher<LoadedFrame>(
      [&sequence, &camera, &masks, next = size_t{0}]() mutable -> std::optional<LoadedFrame> {
        if (next == sequence.frames.size()) {
          return std::nullopt;
        }
        LoadedFrame loaded;
        const size_t frame = next++;
        try {
          loaded.image = LoadRgbd(sequence.frames[frame], camera);
        } catch (const InputError& error) {
          loaded.error = error.what();
        }
        if (loaded.image) {
          loaded.image->masks = masks.Read(frame);
        }
        return loaded;
      },
      kImagesAhead);
}

// Waits until the time, counted from `start`, at which the camera took the frame.
void WaitForStamp(const TumSequence& sequence, double stamp, Clock::time_point start) {
  const std::chrono::duration<double> due(stamp - sequence.frames.front().timestamp);
  std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(due));
}

const char* Name(TrackingState state) {
  switch (state) {
    case TrackingState::kTracked:
      return "tracked";
    case TrackingState::kLost:
      return "LOST";
    default:
      return "initialising";
  }
}

std::string DescribeState(TrackingState state, const System& system) {
  const auto map = system.map();
  return fmt::format("{}  {} keyframes  {} landmarks", Name(state),
                     map != nullptr ? map->keyframes().size() : 0,
                     map != nullptr ? map->landmarks().size() : 0);
}

RunResult TrackAll(const RunArguments& arguments, const TumSequence& sequence,
                   const PinholeCamera& camera, const SequenceMasks& masks, System& system) {
  RunResult result;
  Progress progress(sequence.frames.size(), arguments.quiet);
  const Clock::time_point start = Clock::now();
  Prefetcher<LoadedFrame> images = StartLoading(sequence, camera, masks);
  while (!IsInterrupted()) {
    const std::optional<LoadedFrame> loaded = images.Next();
    if (!loaded) {
      break;
    }
    ++result.given;
    if (!loaded->image) {
      if (arguments.strict) {
        throw InputError(loaded->error);
      }
      progress.Clear();
      fmt::print(stderr, "warning: {}; this frame is skipped\n", loaded->error);
      ++result.skipped;
      continue;
    }
    if (arguments.realtime) {
      WaitForStamp(sequence, loaded->image->timestamp, start);
    }
    const TrackedFrame frame = system.Track(*loaded->image);
    progress.Show(result.given, [&] { return DescribeState(frame.state, system); });
  }
  progress.Clear();
  if (!arguments.quiet && !IsInterrupted()) {
    fmt::print(stderr, "finishing the map\n");  // the bundle adjustment of the whole map is slow
  }
  system.Finish(&Interruption());
  result.was_interrupted = IsInterrupted();
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

void Evaluate(const Trajectory& groundtruth, const Trajectory& trajectory,
              TrajectorySummary& summary) {
  const AteReport ate = EvaluateAte(groundtruth, trajectory);
  if (!ate.ok()) {
    fmt::print(stderr, "warning: the trajectory error cannot be computed: {}\n", ate.failure);
    return;
  }
  summary.ate_rmse_m = ate.errors.rmse;
  summary.scale = ate.reference_from_estimate.scale;
  summary.pairs = ate.pairs;
  summary.coverage = ate.coverage;
  const RpeReport rpe = EvaluateRpe(groundtruth, trajectory);
  if (rpe.ok()) {
    summary.rpe_rmse_m = rpe.translation.rmse;
    summary.rpe_rmse_deg = rpe.rotation.rmse;
  }
}

size_t CountLost(const System& system) {
  return static_cast<size_t>(std::count_if(
      system.frames().begin(), system.frames().end(),
      [](const TrackedFrame& frame) { return frame.state != TrackingState::kTracked; }));
}

RunSummary Summarize(const RunArguments& arguments, const SystemOptions& options,
                     const TumSequence& sequence, const RunResult& result, const System& system) {
  RunSummary summary;
  summary.trajectory.frames = result.given;
  summary.trajectory.skipped = result.skipped;
  summary.trajectory.unpaired = sequence.unpaired;
  summary.trajectory.lost = CountLost(system);
  summary.trajectory.tracked = system.frames().size() - summary.trajectory.lost;

  summary.timing.stages_ms = SummarizeStages(system.times());
  summary.timing.track_ms = summary.timing.stages_ms["track"];
  summary.timing.stages_ms.erase("track");
  summary.timing.total_s = result.seconds;
  summary.timing.frames_per_second =
      static_cast<double>(result.given) / std::max(result.seconds, 1e-9);
  summary.peak_memory_mb = PeakMemoryMb();
  if (const auto map = system.map()) {
    summary.map.keyframes = map->keyframes().size();
    summary.map.landmarks = map->landmarks().size();
  }
  summary.provenance.version = HULLSLAM_VERSION;
  summary.provenance.git = HULLSLAM_GIT;
  summary.provenance.settings_hash = HashSettings(options);
  summary.provenance.seed = arguments.seed;
  summary.provenance.pipeline = arguments.threaded ? "threaded" : "sequential";
  summary.provenance.sequence = arguments.sequence.string();
  return summary;
}

std::string MapPly(const Map& map, const Trajectory& keyframes) {
  std::vector<Eigen::Vector3d> landmarks;
  map.landmarks().ForEach(
      [&](LandmarkId, const Landmark& landmark) { landmarks.push_back(landmark.position); });
  std::vector<Eigen::Vector3d> centers;
  for (const StampedPose& pose : keyframes) {
    centers.push_back(pose.world_from_cam.translation);
  }
  return FormatMapPly(landmarks, centers);
}

// The files of objects are only written if the run has masks.
void WriteOutputs(const std::filesystem::path& folder, const Map& map, const Trajectory& trajectory,
                  const RunSummary& summary, const ObjectReport& objects) {
  const Trajectory keyframes = KeyframeTrajectory(map);
  std::vector<FileContent> files = {{folder / "trajectory.txt", FormatTrajectory(trajectory)},
                                    {folder / "keyframes.txt", FormatTrajectory(keyframes)},
                                    {folder / "map.ply", MapPly(map, keyframes)},
                                    {folder / "summary.json", FormatSummary(summary)}};
  if (summary.objects) {
    std::ranges::move(ObjectFiles(folder, objects), std::back_inserter(files));
  }
  WriteFilesAtomically(files);
}

void PrintReport(const RunArguments& arguments, const RunSummary& summary) {
  const TrajectorySummary& trajectory = summary.trajectory;
  fmt::print("{} frames: {} tracked, {} lost, {} skipped; {} images without depth\n",
             trajectory.frames, trajectory.tracked, trajectory.lost, trajectory.skipped,
             trajectory.unpaired);
  if (trajectory.ate_rmse_m) {
    fmt::print("ATE RMSE {:.4f} m ({} alignment, {} pairs of poses, coverage {:.1f} %)\n",
               *trajectory.ate_rmse_m, trajectory.alignment, trajectory.pairs,
               100.0 * trajectory.coverage.value_or(0.0));
  }
  if (trajectory.rpe_rmse_m && trajectory.rpe_rmse_deg) {
    fmt::print("RPE RMSE {:.4f} m, {:.3f} degrees over 1 s\n", *trajectory.rpe_rmse_m,
               *trajectory.rpe_rmse_deg);
  }
  fmt::print("{} keyframes, {} landmarks\n", summary.map.keyframes, summary.map.landmarks);
  if (summary.objects) {
    fmt::print("{}\n", DescribeObjects(*summary.objects));
  }
  fmt::print(
      "tracking {:.1f} ms per frame (median; mean {:.1f}, p95 {:.1f}); {:.1f} frames/s overall; "
      "peak memory {:.0f} MB\n",
      summary.timing.track_ms.median, summary.timing.track_ms.mean, summary.timing.track_ms.p95,
      summary.timing.frames_per_second, summary.peak_memory_mb);
  fmt::print("results are in {}\n", arguments.output.string());
}

bool IsLostForGood(const System& system) {
  const std::vector<TrackedFrame>& frames = system.frames();
  const auto last_tracked = std::find_if(
      frames.rbegin(), frames.rend(),
      [](const TrackedFrame& frame) { return frame.state == TrackingState::kTracked; });
  return last_tracked == frames.rend() ||
         static_cast<size_t>(last_tracked - frames.rbegin()) >= kLostForGood;
}

}  // namespace

int RunRgbd(const RunArguments& arguments, const TumSequence& sequence) {
  const SystemOptions options = LoadOptions(arguments);
  LoadRgbd(sequence.frames.front(), options.camera);  // finds images of a wrong type or size early
  const std::optional<Trajectory> groundtruth =
      sequence.groundtruth ? std::optional(ReadTrajectory(*sequence.groundtruth)) : std::nullopt;
  const SequenceMasks masks(
      {arguments.masks, arguments.masks_format, options.camera.width, options.camera.height},
      MaskFrames(sequence));
  PrepareOutputFolder(arguments.output);
  if (!arguments.quiet && masks.format()) {
    fmt::print("{}\n", masks.Describe());
  }
  if (!arguments.vocabulary.empty()) {
    fmt::print(stderr, "warning: {}: this version does not use the vocabulary\n",
               arguments.vocabulary.string());
  }
  CatchInterrupts();
  System system(options, ChoosePipeline(arguments));
  const RunResult result = TrackAll(arguments, sequence, options.camera, masks, system);

  RunSummary summary = Summarize(arguments, options, sequence, result, system);
  summary.provenance.masks_format = masks.format();
  const Trajectory trajectory = system.trajectory();
  if (groundtruth) {
    Evaluate(*groundtruth, trajectory, summary.trajectory);
  }
  const std::shared_ptr<const Map> map =
      system.map() != nullptr ? system.map() : std::make_shared<const Map>();
  const ObjectReport objects = CollectObjects(*map, options.camera, arguments.sequence);
  if (masks.format()) {
    summary.objects = SummarizeObjects(objects, system.object_counts());
  }
  WriteOutputs(arguments.output, *map, trajectory, summary, objects);
  if (result.was_interrupted) {
    fmt::print(stderr, "warning: the run was interrupted after {} of {} frames\n", result.given,
               sequence.frames.size());
  }
  if (!arguments.quiet) {
    PrintReport(arguments, summary);
  }
  if (!result.was_interrupted && IsLostForGood(system)) {
    fmt::print(stderr,
               "error: tracking was lost and did not recover: {} of {} frames have a pose\n",
               summary.trajectory.tracked, summary.trajectory.frames);
    return kFailed;
  }
  return kDone;
}

}  // namespace hullslam
