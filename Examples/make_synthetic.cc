// SPDX-License-Identifier: GPL-3.0-or-later
// Renders synthetic RGB-D and stereo sequences with exact ground truth of the camera and the
// objects.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/settings/loaded_settings.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/program.h"
#include "synthetic/sequence_writer.h"
#include "synthetic/suite_writer.h"

namespace {

using hullslam::kDone;
using hullslam::kFailed;
using hullslam::synthetic::SequenceOptions;
using hullslam::synthetic::SuiteOptions;

constexpr double kLargestFisheye = 220.0;  // degrees; wider lenses are hardly made

struct Arguments {
  std::string folder;               // of one sequence
  std::string suite;                // folder of a suite; empty for one sequence
  std::optional<std::string> only;  // names of sequences of the suite, separated by commas
  std::string scene = "desk";
  std::string camera;  // a settings file; empty: the scene's
  std::optional<int> frames;
  SequenceOptions options;
  bool quiet = false;
};

std::string NamesOfSuite() {
  std::string names;
  for (const auto& sequence : hullslam::synthetic::SuiteSequences()) {
    names += (names.empty() ? "" : ", ") + std::string(sequence.name);
  }
  return names;
}

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  size_t begin = 0;
  for (size_t comma; (comma = text.find(',', begin)) != std::string::npos; begin = comma + 1) {
    parts.push_back(text.substr(begin, comma - begin));
  }
  if (parts.empty() || begin < text.size()) {
    parts.push_back(text.substr(begin));
  }
  return parts;
}

// The options of a single sequence. They cannot be combined with --suite.
void AddSequenceOptions(CLI::App& app, CLI::Option& suite, Arguments& arguments) {
  app.add_option("OUT", arguments.folder,
                 "folder to create, with a TUM sequence and its ground truth")
      ->excludes(&suite);
  app.add_option("--scene", arguments.scene, "scene")
      ->check(CLI::IsMember({"desk", "room", "lowtexture", "dynamic", "house", "twins", "rotation",
                             "wall", "turns", "pushed", "road"}))
      ->excludes(&suite)
      ->capture_default_str();
  app.add_option("--rearranged", arguments.options.rearranged,
                 "a later visit of desk, room or house: some objects were moved, taken away and "
                 "added, chosen by this seed")
      ->check(hullslam::WholeNumber(0))
      ->excludes(&suite);
  auto* const readout_time =
      app.add_option("--readout-time", arguments.options.readout_time,
                     "seconds from the top to the bottom row of an image (rolling shutter); "
                     "negative if the bottom row is exposed first")
          ->excludes(&suite);
  hullslam::ExpectNumber(*readout_time->capture_default_str(), -0.1, 0.1);
  auto* const fisheye =
      app.add_option("--fisheye", arguments.options.fisheye,
                     "render through a Kannala-Brandt lens with this field of view across the "
                     "width of the image, degrees; 0: through a pinhole of 62 degrees")
          ->type_name("DEGREES")
          ->excludes(&suite);
  hullslam::ExpectNumber(*fisheye->capture_default_str(), 0.0, kLargestFisheye);
  app.add_option("--camera", arguments.camera,
                 "render through the camera of this calibration (docs/settings.md), with its size, "
                 "lens and readout time")
      ->type_name("FILE")
      ->excludes(&suite)
      ->excludes(fisheye)
      ->excludes(readout_time);
}

void AddOptions(CLI::App& app, Arguments& arguments) {
  auto* const suite =
      app.add_option("--suite", arguments.suite,
                     "folder to create, with the ten sequences of the suite and suite.json, "
                     "instead of one sequence in OUT");
  app.add_option("--only", arguments.only,
                 "only these sequences of the suite, separated by commas: " + NamesOfSuite())
      ->type_name("NAME,...")
      ->needs(suite);
  AddSequenceOptions(app, *suite, arguments);
  app.add_option("--frames", arguments.frames,
                 "number of frames (default: 300; 600 for room, 1800 for house, 930 for twins), "
                 "in a suite of each sequence, at least 2")
      ->check(CLI::Range(1, 100000));
  app.add_option("--seed", arguments.options.seed,
                 "seed of textures, hand motion and noise; in a suite of the latter two")
      ->check(hullslam::WholeNumber(0))
      ->capture_default_str();
  auto* const stereo =
      app.add_option("--stereo", arguments.options.stereo_baseline,
                     "also write the images of a second camera, this far to the right of the first "
                     "one, m, into the folder right; 0: none")
          ->type_name("BASELINE");
  hullslam::ExpectNumber(*stereo->capture_default_str(), 0.0, 10.0);
  app.add_option("--threads", arguments.options.threads,
                 "number of threads, 0 for one per core; does not change the output")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  app.add_flag("--force", arguments.options.force,
               "replace an earlier synthetic sequence, or suite, in the folder");
  app.add_flag("--quiet", arguments.quiet, "print nothing but errors");
  hullslam::AddVersionAndExitCodes(app, "done", "interrupted or failed (then nothing is written)",
                                   "bad usage or a folder that may not be written");
}

// Shows how many of `frames` frames are finished.
class Progress {
 public:
  Progress(int frames, bool quiet) : frames_(frames), quiet_(quiet) {}

  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  // `what` comes before the numbers. Returns false if the user has interrupted the program.
  bool Show(std::string_view what, int done) {
    if (!quiet_ && (terminal_ || done % 50 == 0 || done == frames_)) {
      std::fprintf(stderr, "%s%.*s%d/%d frames, %.1f frames/s%s", terminal_ ? "\r" : "",
                   static_cast<int>(what.size()), what.data(), done, frames_, done / Seconds(),
                   terminal_ ? "\033[K" : "\n");
    }
    return !hullslam::IsInterrupted();
  }
  // Ends the line, and says if nothing was written. Returns the exit code.
  int End(bool finished) const {
    if (!quiet_ && terminal_) {
      std::fputc('\n', stderr);
    }
    if (!finished) {
      std::fprintf(stderr, "error: the program was interrupted; nothing was written\n");
    }
    return finished ? kDone : kFailed;
  }

 private:
  int frames_;
  bool quiet_;
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

int RenderOne(Arguments& arguments) {
  SequenceOptions& options = arguments.options;
  options.scene = hullslam::synthetic::ParseSceneKind(arguments.scene);
  options.frames = arguments.frames.value_or(hullslam::synthetic::DefaultFrames(options.scene));
  if (!arguments.camera.empty()) {
    const hullslam::SystemOptions settings = hullslam::LoadSettings(arguments.camera).options;
    options.camera = settings.camera;
    options.readout_time = settings.readout_time;
  }
  Progress progress(options.frames, arguments.quiet);
  const int code = progress.End(hullslam::synthetic::WriteSequence(
      arguments.folder, options, [&](int done) { return progress.Show("", done); }));
  if (code == kDone && !arguments.quiet) {
    std::printf("%s: %d frames of scene %s, seed %llu, in %.1f s\n", arguments.folder.c_str(),
                options.frames, arguments.scene.c_str(),
                static_cast<unsigned long long>(options.seed), progress.Seconds());
  }
  return code;
}

int RenderSuite(const Arguments& arguments) {
  const SuiteOptions options{
      .frames = arguments.frames.value_or(hullslam::synthetic::kSuiteFrames),
      .seed = arguments.options.seed,
      .only = arguments.only ? SplitAtCommas(*arguments.only) : std::vector<std::string>(),
      .force = arguments.options.force,
      .stereo_baseline = arguments.options.stereo_baseline,
      .threads = arguments.options.threads};
  if (options.frames < 2) {
    throw hullslam::InputError("--frames: 1 given, expected at least 2 for a suite");
  }
  const auto sequences = static_cast<int>(hullslam::synthetic::SelectSuite(options.only).size());
  Progress progress(sequences * options.frames, arguments.quiet);
  const int code = progress.End(hullslam::synthetic::WriteSuite(
      arguments.suite, options, [&](std::string_view name, int done) {
        return progress.Show(std::string(name) + ": ", done);
      }));
  if (code == kDone && !arguments.quiet) {
    std::printf("%s: %d sequences of %d frames, seed %llu, in %.1f s\n", arguments.suite.c_str(),
                sequences, options.frames, static_cast<unsigned long long>(options.seed),
                progress.Seconds());
  }
  return code;
}

int Run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Renders a synthetic RGB-D sequence with exact ground truth of the camera and the objects, "
      "or a suite of ten sequences.",
      std::filesystem::path(argv[0]).filename());
  AddOptions(app, arguments);
  if (!hullslam::ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  hullslam::CatchInterrupts();  // then an interrupted program can remove its unfinished sequence
  if (!arguments.suite.empty()) {
    return RenderSuite(arguments);
  }
  if (arguments.folder.empty()) {
    throw hullslam::InputError("expected OUT, the folder to create, or --suite OUT");
  }
  return RenderOne(arguments);
}

}  // namespace

int main(int argc, char** argv) { return hullslam::RunMain(Run, argc, argv); }
