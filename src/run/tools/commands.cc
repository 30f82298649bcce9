// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/tools/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/program.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr const char* kRun = "Run SLAM";
constexpr const char* kPrepare = "Prepare a sequence or a vocabulary";
constexpr const char* kMap = "Map objects where the camera's poses are known";
constexpr const char* kShow = "Look at a finished run or a saved map";
constexpr const char* kMeasure = "Measure how good the results are";
constexpr const char* kConvert = "Use the results in other programs";

constexpr std::array kCommands = {
    Command{kRun, "run", "runs SLAM on a sequence of any kind", RunRun},
    Command{kPrepare, "calibrate", "calibrates a camera from recordings of anything", RunCalibrate},
    Command{kPrepare, "check-masks", "checks the masks of a sequence, and can draw them",
            RunCheckMasks},
    Command{kPrepare, "segment", "makes masks of images with a network", RunSegment},
    Command{kPrepare, "make-synthetic", "renders a sequence whose poses and objects are known",
            nullptr},
    Command{kPrepare, "train-vocabulary", "trains a vocabulary of visual words on images",
            RunTrainVocabulary},
    Command{kPrepare, "convert-vocabulary",
            "converts a vocabulary between text, as ORB-SLAM2 has it, and the binary form",
            RunConvertVocabulary},
    Command{kMap, "map-objects", "maps objects from masks and poses; needs no images",
            RunMapObjects},
    Command{kShow, "view", "shows it in a browser, or writes its report", RunView},
    Command{kShow, "query", "answers questions about its objects", RunQueryObjects},
    Command{kMeasure, "evaluate", "the errors of a trajectory, or of mapped objects", RunEvaluate},
    Command{kMeasure, "relocalise", "how often single frames are found in a map", RunRelocalise},
    Command{kConvert, "export", "writes them for COLMAP, nerfstudio, Blender, g2o and others",
            RunExport},
    Command{kConvert, "mesh", "makes a coloured surface from their depth images", RunMesh},
};

}  // namespace

std::span<const Command> Commands() { return kCommands; }

namespace {

const Command* FindByName(std::string_view name) {
  for (const Command& command : Commands()) {
    if (name == command.name) {
      return &command;
    }
  }
  return nullptr;
}

// Whether the user who wrote `word` may mean this command. Some tools were programs with the names
// of their files, such as check_masks and query_objects.
bool IsMeant(std::string_view word, std::string_view name) {
  return !word.empty() &&
         (name.starts_with(word) || IsMisspelt(word, name) || word.starts_with(name));
}

// The error about a word that is no command. It names the command that the user may have meant.
[[noreturn]] void RefuseCommand(std::string_view word) {
  std::string nearest;
  for (const Command& command : Commands()) {
    if (IsMeant(word, command.name)) {
      nearest = fmt::format("; did you mean {}?", command.name);
      break;
    }
  }
  throw InputError(
      fmt::format("'{}' is no command{} (hullslam --help lists the commands)", word, nearest));
}

// Starts the program of a command in place of this one.
[[noreturn]] void StartProgram(const Command& command, std::vector<char*> words) {
  std::string name = command.name;
  std::replace(name.begin(), name.end(), '-', '_');
  const auto file = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  words.push_back(nullptr);
  ::execv(file.c_str(), words.data());
  throw std::system_error(errno, std::generic_category(), file.string());
}

// Runs a command with its arguments. `called` is how the user called it, for --help.
int RunCommand(const Command& command, std::string called, int argc, char** argv) {
  std::vector<char*> words = {called.data()};
  words.insert(words.end(), argv, argv + argc);
  if (command.run == nullptr) {
    StartProgram(command, words);
  }
  return command.run(static_cast<int>(words.size()), words.data());
}

bool IsOwnOption(std::string_view word) {
  return word == "--help" || word == "-h" || word == "--version";
}

// Prints the help or the version. Without any argument, the help is an answer to bad usage.
int RunWithoutCommand(int argc, char** argv) {
  CLI::App app(
      "HullSLAM: SLAM and its tools. `run` finds out what kind of sequence it is given; each kind "
      "also has a program of its own, such as rgbd_tum.",
      "hullslam");
  for (const Command& command : Commands()) {
    app.add_subcommand(command.name, command.meaning)->group(command.wish);
  }
  app.get_formatter()->label("SUBCOMMAND", "COMMAND [ARGUMENTS]");
  app.require_subcommand(1);
  AddVersionAndExitCodes(app, "done", "the command failed");
  app.footer("hullslam COMMAND --help tells more.\n" + app.get_footer());
  if (argc < 2) {
    Print("{}", app.help());
    return kBadInput;
  }
  ParseCommandLine(app, argc, argv);
  return kDone;
}

}  // namespace

int RunHullslam(int argc, char** argv) {
  const std::string called = std::filesystem::path(argc > 0 ? argv[0] : "").filename();
  if (argc < 2 || IsOwnOption(argv[1])) {
    return RunWithoutCommand(argc, argv);
  }
  const Command* const command = FindByName(argv[1]);
  if (command == nullptr) {
    RefuseCommand(argv[1]);
  }
  return RunCommand(*command, called + " " + command->name, argc - 2, argv + 2);
}

}  // namespace hullslam
