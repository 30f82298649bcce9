// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/relocalisation.h"
#include "hullslam/eval/ate.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/relocaliser.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"
#include "run/vocabularies.h"

namespace hullslam {
namespace {

constexpr double kMaxPoseGap = 0.1;  // s, between the two poses from which a pose is interpolated

struct RelocaliseArguments {
  std::filesystem::path sequence;
  std::filesystem::path masks;
  std::string masks_format;
  std::filesystem::path vocabulary;
  std::filesystem::path settings;
  std::filesystem::path groundtruth;  // empty: that of the sequence
  AnyDatasetArguments any;
  std::string preset;
  std::vector<std::string> overrides;
  std::vector<std::string> query_overrides;
  std::string map_frames = ":";
  std::string query_frames = ":";
  size_t queries = 200;
  uint64_t seed = 0;
  bool list = false;
  bool quiet = false;
};

void AddArguments(CLI::App& app, RelocaliseArguments& arguments) {
  const DatasetHelp help = HelpOfAnyDataset();
  app.add_option("SEQUENCE", arguments.sequence, help.sequence)->required();
  app.add_option("--groundtruth", arguments.groundtruth,
                 "true trajectory (" + help.groundtruth + ")")
      ->type_name("FILE");
  AddAnyDatasetOptions(app, arguments.any);
  AddMaskArguments(app, arguments.masks, arguments.masks_format);
  AddVocabularyArgument(app, arguments.vocabulary);
  AddSettingsArgument(app, help.settings, arguments.settings);
  AddPresetArgument(app, arguments.preset);
  AddOverrides(app, arguments.overrides);
  AddOverrides(app, "--query-set",
               "key=value: overrides one setting for the queries only; can be given several times",
               arguments.query_overrides);
  app.add_option("--map-frames", arguments.map_frames,
                 "FIRST:LAST, inclusive: frames that the map is made from, counted from 0; a "
                 "missing number is the first or last frame of the sequence")
      ->capture_default_str();
  app.add_option("--query-frames", arguments.query_frames,
                 "FIRST:LAST: frames that the queries are chosen from")
      ->capture_default_str();
  app.add_option("--queries", arguments.queries,
                 "number of frames to choose, at random and each at most once")
      ->check(CLI::Range(size_t{1}, size_t{1'000'000}).description(""))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "seed of all random choices")
      ->check(WholeNumber(0))
      ->capture_default_str();
  app.add_flag("--list", arguments.list, "also print one line per query");
  AddDebugFlag(app);
  app.add_flag("--quiet", arguments.quiet, "do not show the progress");
  AddVersionAndExitCodes(app, "done, however many queries succeeded",
                         "no map was made, or the program was interrupted");
}

// Opens the sequence with the settings of the map or of the queries. Warnings are printed only for
// the queries: their overrides contain those of the map.
OpenedDataset OpenInput(const RelocaliseArguments& arguments, const FoundDataset& found,
                        bool for_queries) {
  DatasetRequest request{.path = arguments.sequence,
                         .sensor = found.sensor,
                         .settings = arguments.settings,
                         .preset = arguments.preset,
                         .overrides = arguments.overrides,
                         .choices = arguments.any.choices};
  if (for_queries) {
    request.overrides.insert(request.overrides.end(), arguments.query_overrides.begin(),
                             arguments.query_overrides.end());
  }
  OpenedDataset opened = for_queries ? OpenDatasetLoudly(*found.dataset, request)
                                     : OpenDataset(*found.dataset, request);
  opened.settings.options.seed = arguments.seed;
  return opened;
}

Trajectory NeedGroundtruth(const RelocaliseArguments& arguments, const FoundDataset& found,
                           ImageSequence& sequence) {
  if (!arguments.groundtruth.empty()) {
    UseGivenGroundtruth(arguments.groundtruth, found.dataset->expected_stamps, sequence);
  }
  std::optional<Trajectory> groundtruth = ReadGroundtruth(sequence);
  if (!groundtruth) {
    throw InputError(arguments.sequence.string() +
                     ": has no ground truth such as groundtruth.txt, expected --groundtruth FILE");
  }
  return std::move(*groundtruth);
}

// Everything that is read before the first frame.
struct RelocaliseInputs {
  ImageSequence sequence;
  Trajectory groundtruth;
  SystemOptions map_options;
  SystemOptions query_options;
  SequenceMasks masks;
  FrameSelection map_frames;
  std::vector<size_t> queries;  // indices of frames, increasing
};

// Chooses frames of the range that have a true pose.
std::vector<size_t> ChooseFrames(const RelocaliseArguments& arguments,
                                 const ImageSequence& sequence, const Trajectory& groundtruth,
                                 const FrameSelection& range) {
  std::vector<size_t> frames;
  for (size_t i = range.first; i <= range.last; ++i) {
    if (InterpolatePose(groundtruth, sequence.frames[i].timestamp, kMaxPoseGap)) {
      frames.push_back(i);
    }
  }
  if (frames.empty()) {
    throw InputError(fmt::format("{}: no frame of --query-frames {} has a true pose",
                                 arguments.sequence.string(), arguments.query_frames));
  }
  return ChooseQueries(std::move(frames), arguments.queries, arguments.seed);
}

RelocaliseInputs LoadInputs(const RelocaliseArguments& arguments) {
  const FoundDataset found =
      FindDataset(arguments.sequence, arguments.any.sensor, arguments.any.choices);
  OpenedDataset opened = OpenInput(arguments, found, false);
  ImageSequence sequence = std::move(opened.sequence);
  Trajectory groundtruth = NeedGroundtruth(arguments, found, sequence);
  SystemOptions map_options = std::move(opened.settings.options);
  SystemOptions query_options = OpenInput(arguments, found, true).settings.options;
  const FrameSelection map_frames =
      ParseFrameRange("--map-frames", arguments.map_frames, sequence.frames.size());
  const FrameSelection query_frames =
      ParseFrameRange("--query-frames", arguments.query_frames, sequence.frames.size());
  std::vector<size_t> queries = ChooseFrames(arguments, sequence, groundtruth, query_frames);
  SequenceMasks masks(
      RequestOf(arguments.masks, arguments.masks_format, sequence, map_options.camera),
      MaskFrames(sequence));
  map_options.vocabulary = ChooseVocabulary(arguments.vocabulary, arguments.quiet);
  query_options.vocabulary = map_options.vocabulary;
  return {std::move(sequence),      std::move(groundtruth), std::move(map_options),
          std::move(query_options), std::move(masks),       map_frames,
          std::move(queries)};
}

ImageInput LoadFrame(const RelocaliseInputs& inputs, const PinholeCamera& camera, size_t frame) {
  ImageInput image = inputs.sequence.load(inputs.sequence.frames[frame], camera);
  image.masks = inputs.masks.Read(frame);
  FitMasks(inputs.sequence.warps, ImageSide::kLeft, image.masks);
  return image;
}

// The map of the first frames, and the transform between its world and that of the ground truth.
struct MadeMap {
  std::shared_ptr<const Map> map;
  PointAlignment truth_from_map;
};

// Null if the frames cannot be tracked, or after an interrupt; the reason is printed.
std::optional<MadeMap> MakeMap(const RelocaliseArguments& arguments,
                               const RelocaliseInputs& inputs) {
  System system(inputs.map_options, PipelineKind::kSequential);
  const FrameSelection& range = inputs.map_frames;
  Progress progress(range.last - range.first + 1, arguments.quiet);
  for (size_t i = range.first; i <= range.last && !IsInterrupted(); ++i) {
    system.Track(LoadFrame(inputs, inputs.map_options.camera, i));
    progress.Show(i - range.first + 1);
  }
  progress.Clear();
  system.Finish(&Interruption());
  if (IsInterrupted()) {
    PrintFailure("the program was interrupted");
    return std::nullopt;
  }
  const AteResult ate = EvaluateAte(inputs.groundtruth, system.trajectory(),
                                    {.alignment = AlignmentOf(inputs.map_options.sensor)});
  if (!ate.ok()) {
    PrintFailure("the map cannot be compared with the ground truth: " + ate.failure);
    return std::nullopt;
  }
  const Map& map = *system.map();
  size_t mapped = 0;
  for (const auto& [id, object] : map.objects()) {
    mapped += object.state == ObjectState::kMapped ? 1 : 0;
  }
  Print("map of frames {} to {}: {} keyframes, {} landmarks, {} objects; ATE RMSE {:.4f} m\n",
        range.first, range.last, map.keyframes().size(), map.landmarks().size(), mapped,
        ate.errors.rmse);
  return MadeMap{system.map(), AlignWithRotations(inputs.groundtruth, system.trajectory(),
                                                  ate.reference_from_estimate)};
}

// Looks for a frame in the map.
QueryResult RunQuery(const RelocaliseInputs& inputs, const MadeMap& made,
                     const Relocaliser& relocaliser, System& builder, size_t frame) {
  const BuiltFrame built = builder.Build(LoadFrame(inputs, inputs.query_options.camera, frame));
  const Rigid3 truth =
      InterpolatePose(inputs.groundtruth, inputs.sequence.frames[frame].timestamp, kMaxPoseGap)
          .value();
  return Relocalise(relocaliser, *made.map, *built.frame, made.truth_from_map, truth);
}

}  // namespace

int RunRelocalise(int argc, char** argv) {
  CLI::App app(
      "Measures how well single frames are found in a map of other frames of the same sequence.\n"
      "Their true poses are those of the ground truth, aligned with the trajectory of the map.",
      argv[0]);
  RelocaliseArguments arguments;
  AddArguments(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const RelocaliseInputs inputs = LoadInputs(arguments);
  CatchInterrupts();
  const std::optional<MadeMap> made = MakeMap(arguments, inputs);
  if (!made) {
    return kFailed;
  }
  System builder(inputs.query_options, PipelineKind::kSequential);
  const Relocaliser relocaliser(inputs.query_options, made->map);
  std::vector<QueryResult> results;
  Progress progress(inputs.queries.size(), arguments.quiet);
  for (const size_t frame : inputs.queries) {
    if (IsInterrupted()) {
      PrintFailure("the program was interrupted");
      return kFailed;
    }
    results.push_back(RunQuery(inputs, *made, relocaliser, builder, frame));
    if (arguments.list) {
      progress.Clear();
      Print("frame {}: {}", frame, DescribeQuery(results.back()));
    }
    progress.Show(results.size());
  }
  progress.Clear();
  Print("{}", DescribeQueries(results));
  return kDone;
}

}  // namespace hullslam
