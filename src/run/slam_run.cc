// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/slam_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eval/located_landmarks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"
#include "results/output_folder.h"
#include "results/ply_file.h"
#include "results/summary.h"
#include "run/datasets/given_groundtruth.h"
#include "run/frame_source.h"
#include "run/input_warnings.h"
#include "run/interrupt.h"
#include "run/live_output.h"
#include "run/map_session.h"
#include "run/mask_arguments.h"
#include "run/mcap_output.h"
#include "run/messages.h"
#include "run/object_outputs.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/report_output.h"
#include "run/run_report.h"
#include "run/summarize_run.h"
#include "run/vocabularies.h"
#include "system/compose_trajectory.h"
#include "system/make_sensor.h"
#include "util/counted.h"

namespace hullslam {
namespace {

using Clock = std::chrono::steady_clock;

PipelineKind ChoosePipeline(const RunArguments& arguments) {
  if (!arguments.threaded) {
    return PipelineKind::kSequential;
  }
  return arguments.realtime ? PipelineKind::kRealtime : PipelineKind::kThreaded;
}

// The numbers of islands; empty if the map has only one.
std::string DescribeIslands(const Map& map) {
  return map.islands_begun() > 1 ? fmt::format("  {} parts of the map, {} joined",
                                               map.islands_begun(), map.islands_joined())
                                 : "";
}

std::string DescribeState(TrackingState state, std::optional<InitialisationFailure> failure,
                          const System& system) {
  const auto map = system.map();
  if (failure) {
    return fmt::format("{}: {}", ToString(state), ToString(*failure));
  }
  return fmt::format("{}  {}  {}{}", ToString(state),
                     Counted(map != nullptr ? map->keyframes().size() : 0, "keyframe"),
                     Counted(map != nullptr ? map->landmarks().size() : 0, "landmark"),
                     map != nullptr ? DescribeIslands(*map) : "");
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

double Milliseconds(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
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

RunResult TrackAll(const RunArguments& arguments, const ImageSequence& sequence,
                   const PinholeCamera& camera, const SequenceMasks& masks, System& system,
                   LiveOutput& live) {
  RunResult result;
  Progress progress(sequence.frames.size(), arguments.quiet);
  std::optional<InitialisationFailure> failure;  // failure of the last frame
  system.SetFrameCallback([&](const FrameReport& report) {
    failure = report.failure;
    live.NoteReport(report);
    NoteFrame(report, arguments.selection,
              report.tracked.timestamp - sequence.frames.front().timestamp, result);
  });
  Clock::time_point start = Clock::now();
  FrameSource frames(arguments.realtime ? Pace::kRealtime : Pace::kFast, sequence, camera, masks,
                     system, live.IsOn());
  while (!IsInterrupted()) {
    // A pause does not count as time of the run.
    const Clock::duration waited =
        live.BeforeFrame(frames, system, [&progress] { progress.Clear(); });
    start += waited;
    progress.Skip(waited);
    std::optional<LoadedFrame> loaded = frames.Next();
    if (!loaded) {
      break;
    }
    ++result.given;
    if (!loaded->frame) {
      if (arguments.strict) {
        throw InputError(loaded->error);
      }
      progress.Clear();
      PrintError("warning: {}; this frame is skipped\n", loaded->error);
      ++result.skipped;
      continue;
    }
    const Clock::time_point begin = Clock::now();
    const TrackedFrame frame = system.Track(std::move(*loaded->frame));
    live.AfterFrame(*loaded, result.given, Milliseconds(Clock::now() - begin), system);
    progress.Show(result.given, [&] { return DescribeState(frame.state, failure, system); });
  }
  progress.Clear();
  system.SetFrameCallback({});
  live.BeginFinishing();
  FinishMap(arguments.quiet, system);
  result.was_interrupted = IsInterrupted();
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

std::string MapPly(const std::vector<Eigen::Vector3d>& landmarks, const Trajectory& keyframes) {
  std::vector<Eigen::Vector3d> centers;
  for (const StampedPose& pose : keyframes) {
    centers.push_back(pose.world_from_cam.translation);
  }
  return FormatMapPly(landmarks, centers);
}

// The islands that have files of their own.
std::span<const LeftIsland> KeptIslands(const RunArguments& arguments, const System& system) {
  return arguments.keep_islands ? std::span(system.left_islands()) : std::span<const LeftIsland>();
}

// Each island that was not joined has files of its own, named by its number.
void WriteIslands(OutputFolder& output, std::span<const LeftIsland> islands, const Sensor& sensor) {
  for (const LeftIsland& island : islands) {
    const std::string name = IslandSuffix(island.id);
    const Trajectory keyframes = KeyframeTrajectory(*island.map);
    output.Write({"trajectory" + name + ".txt", FormatTrajectory(island.trajectory)});
    output.Write({"keyframes" + name + ".txt", FormatTrajectory(keyframes)});
    output.Write(
        {"map" + name + ".ply", MapPly(LocateLandmarks(*island.map, sensor).positions, keyframes)});
  }
}

void WriteOutputs(OutputFolder& output, std::string map_ply,
                  const std::vector<TrajectoryPart>& poses,
                  const std::vector<TrajectoryPart>& keyframes, RunSummary summary,
                  const std::vector<FileContent>& object_files, const ImageSequence& sequence,
                  std::span<const LeftIsland> islands, const Sensor& sensor) {
  output.Write({"trajectory.txt", FormatTrajectory(poses)});
  output.Write({"keyframes.txt", FormatTrajectory(keyframes)});
  output.Write({"map.ply", std::move(map_ply)});
  WriteIslands(output, islands, sensor);
  if (sequence.converted_groundtruth) {
    output.Write({"groundtruth.txt", FormatTrajectory(*sequence.converted_groundtruth)});
  }
  for (const FileContent& file : object_files) {
    output.Write(file);
  }
  summary.files = output.names();
  output.Write({"summary.json", FormatSummary(summary)});
  output.Commit();
}

std::vector<std::filesystem::path> InputsOf(const RunArguments& arguments) {
  return {arguments.sequence,
          arguments.masks,
          arguments.settings,
          arguments.associations,
          arguments.vocabulary,
          arguments.load_map,
          arguments.groundtruth == "none" ? std::filesystem::path() : arguments.groundtruth};
}

void WarnOfInput(const RunArguments& arguments, const SystemOptions& options,
                 const ImageSequence& sequence, const ImageInput& first,
                 const SequenceMasks& masks) {
  WarnOfImplausibleDepth(sequence.frames.front().depth, first.depth, options.depth);
  if (options.sensor == SensorKind::kRgbd) {
    WarnOfUnregisteredDepth(sequence, options.camera);
  }
  WarnOfMisplacedMasks(sequence, options.camera, [&](size_t frame) { return masks.Read(frame); });
  WarnOfUnknownClasses(options.tracking, options.objects, masks);
  WarnOfLastFrame(arguments.selection, sequence);
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

ObjectReport ReportObjects(const RunArguments& arguments, const PinholeCamera& camera,
                           const Map& map, size_t earlier_sessions, const System& system) {
  ObjectReport objects = CollectObjects(map, camera, arguments.sequence);
  if (map.sessions().size() > earlier_sessions && earlier_sessions > 0) {
    objects.changes = system.object_changes();
  }
  return objects;
}

std::string DescribeInterruption(const RunResult& result, const ImageSequence& sequence) {
  return fmt::format(
      "the run was interrupted after {} of {} frames; the results so far were written",
      result.given, sequence.frames.size());
}

// Why the run failed; empty if it did not.
std::string DescribeFailure(const RunArguments& arguments, const RunOptions& options,
                            const ImageSequence& sequence, const RunResult& result,
                            const RunSummary& summary, const System& system) {
  return result.was_interrupted
             ? DescribeInterruption(result, sequence)
             : DescribeLoss(arguments, options, sequence.frames.size(), summary, system.frames());
}

}  // namespace

int RunSlam(const RunArguments& arguments, LoadedSettings settings, const ImageSequence& sequence,
            std::span<const std::string> notes) {
  CheckPresetHasMasks(settings, arguments.masks);
  SystemOptions& options = settings.options;
  options.vocabulary = ChooseVocabulary(arguments.vocabulary, arguments.quiet);
  options.seed = arguments.seed;
  // The first image is loaded now, so that a wrong type or size is reported early.
  const ImageInput first = sequence.load(sequence.frames.front(), options.camera);
  const std::optional<Trajectory> groundtruth = FindGroundtruth(sequence);
  const SequenceMasks masks(
      {arguments.masks, arguments.masks_format, options.camera.width, options.camera.height},
      MaskFrames(sequence));
  CatchInterrupts();
  CheckSavedFiles(arguments);
  SystemStart start = LoadStart(arguments, options);
  const size_t earlier_sessions = start.map.sessions().size();
  LiveOutput live(arguments, options, sequence, groundtruth);
  OutputFolder output(arguments.output, "summary.json", InputsOf(arguments),
                      {arguments.program, arguments.overwrite});
  WarnOfInput(arguments, options, sequence, first, masks);
  PrintInput(arguments, settings, notes, masks);
  System system(options, ChoosePipeline(arguments), std::move(start));
  const RunResult result = TrackAll(arguments, sequence, options.camera, masks, system, live);
  if (result.was_interrupted && result.given == 0) {
    PrintFailure("the run was interrupted before the first frame; nothing was written");
    return kFailed;
  }

  RunSummary summary = SummarizeRun(arguments, settings, sequence, result, system, groundtruth);
  summary.provenance.masks_format = masks.format();
  const Trajectory trajectory = system.trajectory();
  const std::shared_ptr<const Map> map =
      system.map() != nullptr ? system.map() : std::make_shared<const Map>();
  const ObjectReport objects =
      ReportObjects(arguments, options.camera, *map, earlier_sessions, system);
  std::vector<FileContent> object_files;
  if (masks.format()) {
    summary.objects = SummarizeObjects(objects, system.object_counts());
    object_files = ObjectFiles(objects, CollectScene(*map, objects, groundtruth));
  }
  const LocatedLandmarks landmarks = LocateLandmarks(*map, MakeSensor(options));
  summary.map.landmarks_at_infinity = landmarks.at_infinity;
  WriteOutputs(output, MapPly(landmarks.positions, KeyframeTrajectory(*map)),
               RunParts(arguments, earlier_sessions, trajectory), KeyframeParts(arguments, *map),
               summary, object_files, sequence, KeptIslands(arguments, system),
               MakeSensor(options));
  const std::string unsaved = SaveMap(arguments, options, *map);
  const std::string unsaved_island =
      SaveIslands(arguments, options, KeptIslands(arguments, system));
  const std::string unrecorded =
      WriteMcap(arguments, {&options, map.get(), &sequence, result.given, &trajectory, &objects});
  if (!arguments.quiet) {
    PrintReport(arguments, summary, objects);
  }
  live.End(map, nlohmann::json::parse(FormatSummary(summary)));
  const std::string unreported =
      arguments.report ? WriteReport(output.path(), *map, options, sequence, arguments.quiet) : "";
  return FailIfAny({DescribeFailure(arguments, options.run, sequence, result, summary, system),
                    unsaved, unsaved_island, unrecorded, unreported});
}

}  // namespace hullslam
