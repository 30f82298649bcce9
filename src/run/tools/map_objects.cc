// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/view_images.h"
#include "eval/object_metrics.h"
#include "files/plausible.h"
#include "hullslam/datasets/input_checks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/known_pose_mapper.h"
#include "hullslam/util/error.h"
#include "results/object_file.h"
#include "results/output_folder.h"
#include "results/run_report.h"
#include "results/summarize_run.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/more_outputs.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"
#include "scene/make_scene.h"
#include "system/compose_trajectory.h"
#include "system/frame_chooser.h"

namespace hullslam {
namespace {

constexpr const char* kProgram = "map_objects";
constexpr double kMaxGapOfPoses =
    0.1;  // s, between the two poses from which a pose is interpolated

struct MapObjectsArguments {
  std::filesystem::path sequence;
  std::filesystem::path poses;
  std::filesystem::path masks;
  std::string masks_format;
  std::filesystem::path settings;
  AnyDatasetArguments any;
  std::string preset;
  std::vector<std::string> overrides;
  std::filesystem::path output =
      "out_objects";  // not the default of rgbd_tum, whose folder may contain the poses to be used
  FrameChoice choice;
  bool overwrite = false;
  bool without_depth = false;
  bool report = false;
  bool quiet = false;
};

void AddArguments(CLI::App& app, MapObjectsArguments& arguments) {
  const DatasetHelp help = HelpOfAnyDataset();
  app.add_option("SEQUENCE", arguments.sequence,
                 help.sequence + "; the images in a list of TUM may be missing")
      ->required();
  app.add_option("--poses", arguments.poses, "trajectory of the camera in TUM format")->required();
  AddAnyDatasetOptions(app, arguments.any);
  AddMaskArguments(app, arguments.masks, arguments.masks_format);
  app.get_option("--masks")->required();
  AddSettingsArgument(app, help.settings, arguments.settings);
  AddPresetArgument(app, arguments.preset);
  AddOverrides(app, arguments.overrides);
  AddOutputArguments(app, arguments.output, arguments.overwrite);
  auto* const min_distance = app.add_option(
      "--min-distance", arguments.choice.min_distance,
      "a frame is used if the camera has moved this far since the last used frame, m; a "
      "quarter of it is enough if a mask has moved by half of its size");
  ExpectNumber(*min_distance->capture_default_str(), 0.0, kMostMetres);
  auto* const min_angle =
      app.add_option("--min-angle", arguments.choice.min_angle,
                     "a frame is also used if the camera has turned this far since then, degrees");
  ExpectNumber(*min_angle->capture_default_str(), 0.0, 360.0);
  app.add_flag("--without-depth", arguments.without_depth, "do not use the depth images");
  AddReportFlag(app, arguments.report);
  AddDebugFlag(app);
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  AddVersionAndExitCodes(app, "done",
                         "the run failed or was interrupted (the results up to then are written, "
                         "and summary.json says so)");
}

// Chooses the frames to use. Throws InputError if no frame has a pose.
ChosenViews ChooseMappedViews(const MapObjectsArguments& arguments, const ImageSequence& sequence,
                              const Trajectory& poses, const SequenceMasks& masks) {
  ChosenViews chosen =
      ChooseViews(StampsOf(sequence.frames), poses, kMaxGapOfPoses, arguments.choice,
                  [&](size_t frame) { return masks.Read(frame); });
  if (chosen.views.empty()) {
    throw InputError(
        fmt::format("{}: no frame of {} has a pose, expected poses before and after a frame "
                    "that are at most {} s apart",
                    arguments.poses.string(), arguments.sequence.string(), kMaxGapOfPoses));
  }
  return chosen;
}

struct MappingInputs {
  OpenedDataset opened;
  Trajectory poses;
  std::optional<Trajectory> groundtruth;  // tells only which direction is upwards
};

MappingInputs OpenMappingInputs(const MapObjectsArguments& arguments) {
  MappingInputs inputs;
  inputs.opened = OpenAnyDataset(arguments.any, {.path = arguments.sequence,
                                                 .settings = arguments.settings,
                                                 .preset = arguments.preset,
                                                 .overrides = arguments.overrides,
                                                 .need_images = false});
  SystemOptions& options = inputs.opened.settings.options;
  options.sensor = SensorKind::kRgbd;  // the poses are in metres, also without depth
  if (!options.objects.enabled) {
    throw InputError(fmt::format(
        "objects.enabled is false{}, expected true, because map_objects does nothing else than map "
        "objects",
        arguments.preset.empty() ? "" : " (--preset " + arguments.preset + ")"));
  }
  const ImageSequence& sequence = inputs.opened.sequence;
  inputs.poses = AsLoaded(sequence, ReadTrajectory(arguments.poses));
  PrintWarnings(sequence.warnings);
  inputs.groundtruth = FindGroundtruth(sequence);
  return inputs;
}

void PrintInputs(const MappingInputs& inputs, const SequenceMasks& masks) {
  for (const std::string& note : inputs.opened.notes) {
    Print("{}\n", note);
  }
  if (inputs.opened.settings.preset) {
    Print("{}\n", DescribePreset(inputs.opened.settings));
  }
  Print("{}\n", masks.Describe());
}

// Adds the views to the mapper. Returns false if a signal ended it early. Throws InputError for a
// view that cannot be used; the views before it have been added.
bool MapViews(const MapObjectsArguments& arguments, const OpenedDataset& opened,
              const std::vector<ChosenView>& views, const SequenceMasks& masks, Progress& progress,
              KnownPoseMapper& run) {
  const ImageSequence& sequence = opened.sequence;
  const SystemOptions& options = opened.settings.options;
  for (const ChosenView& view : views) {
    if (IsInterrupted()) {
      return false;
    }
    const FramePaths& frame = sequence.frames[view.frame];
    const bool has_depth = !arguments.without_depth && !frame.depth.empty();
    const cv::Mat depth =
        has_depth ? ReadView(sequence, frame, options.camera, false).depth : cv::Mat();
    std::vector<InstanceMask> found = masks.Read(view.frame);
    FitMasks(sequence.warps, ImageSide::kLeft, found);
    run.AddView(frame.timestamp, view.world_from_cam, std::move(found), depth);
    progress.Show(view.frame + 1);
  }
  return true;
}

// How the mapping ended.
struct MappingEnd {
  bool was_interrupted = false;
  std::optional<std::string> input_failure = {};  // what was wrong with a view
};

MappingEnd MapAll(const MapObjectsArguments& arguments, const OpenedDataset& opened,
                  const std::vector<ChosenView>& views, const SequenceMasks& masks,
                  KnownPoseMapper& run) {
  Progress progress(opened.sequence.frames.size(), arguments.quiet);
  MappingEnd end;
  try {
    end.was_interrupted = !MapViews(arguments, opened, views, masks, progress, run);
  } catch (const InputError& error) {
    if (run.map().keyframes().empty()) {
      progress.Clear();
      throw;
    }
    end.input_failure = error.what();
  }
  progress.Clear();
  return end;
}

RunSummary Summarize(const MapObjectsArguments& arguments, const MappingInputs& inputs,
                     const SequenceMasks& masks, const KnownPoseMapper& run, size_t without_pose,
                     const MappingEnd& end) {
  RunSummary summary;
  summary.trajectory.frames = inputs.opened.sequence.frames.size();
  summary.trajectory.tracked = inputs.opened.sequence.frames.size() - without_pose;
  summary.trajectory.lost = without_pose;
  summary.trajectory.coverage = static_cast<double>(summary.trajectory.tracked) /
                                static_cast<double>(summary.trajectory.frames);
  summary.trajectory.alignment = "none";
  summary.peak_memory_mb = PeakMemoryMb();
  summary.map.keyframes = run.map().keyframes().size();
  summary.provenance = SummarizeSettings(
      inputs.opened.settings,
      {.was_interrupted = end.was_interrupted, .input_failure = end.input_failure});
  summary.provenance.program = kProgram;
  summary.provenance.version = HULLSLAM_VERSION;
  summary.provenance.pipeline = "objects";
  summary.provenance.masks_format = masks.format();
  summary.provenance.sequence = arguments.sequence.string();
  summary.provenance.dataset = inputs.opened.sequence.dataset;
  summary.provenance.sequence_choices = inputs.opened.sequence.choices;
  return summary;
}

void WriteOutputs(OutputFolder& output, const OpenedDataset& opened, const KnownPoseMapper& run,
                  const ObjectResults& report, const Scene& scene, RunSummary summary) {
  output.Write({"settings.yaml", FormatSettings(opened.settings.options)});
  for (const FileContent& file : ObjectFiles(report, scene)) {
    output.Write(file);
  }
  // Written because `evaluate` and plot_run.py expect a trajectory in the folder of every run.
  const std::string poses =
      FormatTrajectory(AsRead(opened.sequence, KeyframeTrajectory(run.map())));
  output.Write({"trajectory.txt", poses});
  output.Write({"keyframes.txt", poses});
  summary.files = output.names();
  output.Write({"summary.json", FormatSummary(summary)});
  output.Commit();
}

// Why the run ended before its end; empty if it did not.
std::string DescribeEnd(const RunSummary& summary, size_t views) {
  if (!summary.provenance.input_failure && !summary.provenance.interrupted) {
    return {};
  }
  return fmt::format("{} after {} of {} views; the results so far were written",
                     summary.provenance.input_failure
                         ? *summary.provenance.input_failure + "; the run ended"
                         : "the run was interrupted",
                     summary.map.keyframes, views);
}

std::vector<std::filesystem::path> InputsOf(const MapObjectsArguments& arguments) {
  return {arguments.sequence, arguments.poses, arguments.masks, arguments.settings};
}

}  // namespace

int RunMapObjects(int argc, char** argv) {
  CLI::App app("Maps objects from masks and known camera poses. Colour images are not needed.",
               argv[0]);
  MapObjectsArguments arguments;
  AddArguments(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const MappingInputs inputs = OpenMappingInputs(arguments);
  const SystemOptions& options = inputs.opened.settings.options;
  const PinholeCamera& camera = options.camera;
  const ImageSequence& sequence = inputs.opened.sequence;
  const SequenceMasks masks(RequestOf(arguments.masks, arguments.masks_format, sequence, camera),
                            MaskFrames(sequence));
  const auto& frames = sequence.frames;
  const auto [views, without_pose] = ChooseMappedViews(arguments, sequence, inputs.poses, masks);
  CatchInterrupts();
  OutputFolder output(arguments.output, "summary.json", InputsOf(arguments),
                      {kProgram, arguments.overwrite});
  PrintWarnings(CheckClasses(options, [&] { return masks.Labels(); }));
  PrintWarnings(CheckMaskPlaces(sequence, camera, [&](size_t frame) { return masks.Read(frame); }));
  if (!arguments.quiet) {
    PrintInputs(inputs, masks);
  }
  const auto start = std::chrono::steady_clock::now();
  KnownPoseMapper run(options);
  const MappingEnd end = MapAll(arguments, inputs.opened, views, masks, run);
  PrintWarnings(run.warnings());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

  const ObjectResults report = MeasuredObjects(run.map(), camera, arguments.sequence);
  RunSummary summary = Summarize(arguments, inputs, masks, run, without_pose, end);
  ObjectCounts counts = run.counts();
  counts.frames_without_masks = masks.without_masks();
  counts.frames_with_masks = frames.size() - masks.without_masks();
  summary.objects = SummarizeObjects(report, counts);
  summary.timing.total_s = seconds.count();
  const Scene scene = MakeScene(run.map(), report, inputs.groundtruth);
  WriteOutputs(output, inputs.opened, run, report, scene, summary);
  if (!arguments.quiet) {
    Print("{}{} views of {} frames ({} without a pose) in {:.1f} s\n{}\nresults are in {}\n",
          DescribeMapped(run.map(), report), summary.map.keyframes, summary.trajectory.frames,
          without_pose, seconds.count(), DescribeObjects(*summary.objects, "m"),
          arguments.output.string());
  }
  const std::string unreported =
      arguments.report ? WriteReport(output.path(), run.map(), options, sequence, arguments.quiet)
                       : "";
  const int code = FailIfAny({DescribeEnd(summary, views.size()), unreported});
  return end.input_failure ? kBadInput : code;
}

}  // namespace hullslam
