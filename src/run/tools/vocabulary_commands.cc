// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/training_images.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "map_files/train_vocabulary.h"
#include "run/command_line.h"
#include "run/program.h"
#include "run/progress.h"
#include "run/tools/commands.h"
#include "run/vocabularies.h"
#include "util/task_runner.h"

namespace hullslam {

int RunConvertVocabulary(int argc, char** argv) {
  CLI::App app(
      "Converts a vocabulary between the text format of ORB-SLAM2 and the binary form of HullSLAM.",
      argv[0]);
  std::filesystem::path input;
  std::filesystem::path output;
  std::string form;
  bool quiet = false;
  app.add_option("IN", input, "vocabulary in either form; its content tells which")->required();
  app.add_option("OUT", output, "vocabulary file to write; replaces an earlier one")->required();
  AddVocabularyForm(app, form);
  app.add_flag("--quiet", quiet, "print nothing but errors");
  AddVersionAndExitCodes(
      app, "done", "the program failed (then nothing is written)",
      "bad usage, an IN that is no vocabulary, or an OUT that cannot be written");
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const VocabularyForm output_form = FormOf(output, form);
  const Vocabulary vocabulary = LoadVocabulary(input, quiet);
  WriteVocabulary(output, vocabulary, output_form);
  if (!quiet) {
    Print("{}: {}\n", output.string(), Describe(vocabulary));
  }
  return kDone;
}

namespace {

namespace fs = std::filesystem;

struct TrainVocabularyArguments {
  std::vector<fs::path> images;
  fs::path output;
  std::string form;
  VocabularyTraining training;
  FeatureOptions features = {.keep_edges = true};  // RGB-D runs keep them, so words must fit them
  int threads = 0;
  bool quiet = false;
};

void AddOptions(CLI::App& app, TrainVocabularyArguments& arguments) {
  app.add_option("IMAGES", arguments.images,
                 "PNG or JPEG images, or folders of them (subfolders are not searched)")
      ->required();
  app.add_option("--output", arguments.output, "vocabulary file to write; replaces an earlier one")
      ->required();
  AddVocabularyForm(app, arguments.form);
  app.add_option("--branching", arguments.training.branching, "most children of a node")
      ->check(CLI::Range(2, Vocabulary::kMostBranching).description(""))
      ->capture_default_str();
  app.add_option("--levels", arguments.training.levels,
                 "levels of the tree; it has at most branching^levels words")
      ->check(CLI::Range(1, Vocabulary::kMostLevels).description(""))
      ->capture_default_str();
  app.add_option("--features", arguments.features.feature_count, "ORB features per image")
      ->check(CLI::Range(1, 100'000).description(""))
      ->capture_default_str();
  app.add_option("--seed", arguments.training.seed, "seed of the first cluster centres")
      ->check(WholeNumber(0))
      ->capture_default_str();
  app.add_option("--threads", arguments.threads,
                 "number of threads, 0 for one per core; does not change the vocabulary")
      ->check(CLI::Range(0, 256).description(""))
      ->capture_default_str();
  app.add_flag("--quiet", arguments.quiet, "do not show the progress");
  AddVersionAndExitCodes(app, "done", "interrupted or failed (then nothing is written)",
                         "bad usage, an image that cannot be read, or no features in the images");
}

std::optional<Vocabulary> Train(const TrainVocabularyArguments& arguments,
                                const std::vector<fs::path>& paths) {
  ParallelRunner runner(arguments.threads);
  Progress progress(paths.size(), arguments.quiet);
  size_t shown = 0;
  const std::vector<std::vector<Descriptor>> images =
      ExtractDescriptors(paths, arguments.features, runner, [&](size_t done) {
        while (shown < done) {
          progress.Show(++shown);
        }
        return !IsInterrupted();
      });
  progress.Clear();
  if (IsInterrupted()) {
    return std::nullopt;
  }
  size_t count = 0;
  for (const std::vector<Descriptor>& image : images) {
    count += image.size();
  }
  if (count == 0) {
    throw InputError("no features were found in the images");
  }
  if (!arguments.quiet) {
    PrintError("{} features in {} images\n", count, images.size());
  }
  return TrainVocabulary(images, arguments.training, runner, &Interruption(),
                         [&](int done, int most) {
                           if (!arguments.quiet) {
                             PrintError("level {} of {} is done\n", done, most);
                           }
                         });
}

}  // namespace

int RunTrainVocabulary(int argc, char** argv) {
  CLI::App app("Trains a vocabulary of visual words on images.", argv[0]);
  TrainVocabularyArguments arguments;
  AddOptions(app, arguments);
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const VocabularyForm form = FormOf(arguments.output, arguments.form);
  const std::vector<fs::path> images = ListTrainingImages(arguments.images);
  CatchInterrupts();
  const std::optional<Vocabulary> vocabulary = Train(arguments, images);
  if (!vocabulary) {
    PrintFailure("the program was interrupted; nothing was written");
    return kFailed;
  }
  WriteVocabulary(arguments.output, *vocabulary, form);
  Print("{}: {}\n", arguments.output.string(), Describe(*vocabulary));
  return kDone;
}

}  // namespace hullslam
