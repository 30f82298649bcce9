// SPDX-License-Identifier: GPL-3.0-or-later
// Renders a synthetic RGB-D sequence with exact ground truth of the camera and the objects.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "run/command_line.h"
#include "run/interrupt.h"
#include "run/program.h"
#include "synthetic/sequence_writer.h"

namespace {

using hullslam::kDone;
using hullslam::kFailed;
using hullslam::synthetic::SequenceOptions;

struct Arguments {
  std::string folder;
  std::string scene = "desk";
  std::optional<int> frames;
  SequenceOptions options;
  bool quiet = false;
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("OUT", arguments.folder,
                 "folder to create, with a TUM sequence and its ground truth")
      ->required();
  app.add_option("--scene", arguments.scene, "scene")
      ->check(CLI::IsMember(
          {"desk", "room", "lowtexture", "dynamic", "house", "twins", "rotation", "wall"}))
      ->capture_default_str();
  app.add_option("--frames", arguments.frames,
                 "number of frames (default: 300; 600 for room, 1800 for house, 930 for twins)")
      ->check(CLI::Range(1, 100000));
  app.add_option("--seed", arguments.options.seed, "seed of textures, hand motion and noise")
      ->capture_default_str();
  app.add_option("--rearranged", arguments.options.rearranged,
                 "a later visit of desk, room or house: some objects were moved, taken away and "
                 "added, chosen by this seed");
  auto* const readout_time =
      app.add_option("--readout-time", arguments.options.readout_time,
                     "seconds from the first to the last row of an image (rolling shutter)");
  hullslam::ExpectNumber(*readout_time->capture_default_str(), 0.0, 0.1);
  app.add_option("--threads", arguments.options.threads,
                 "number of threads, 0 for one per core; does not change the output")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  app.add_flag("--force", arguments.options.force, "replace an earlier synthetic sequence in OUT");
  app.add_flag("--quiet", arguments.quiet, "print nothing but errors");
  hullslam::AddVersionAndExitCodes(app, "done", "interrupted or failed (then nothing is written)",
                                   "bad usage or an OUT that may not be written");
}

int Render(Arguments& arguments) {
  SequenceOptions& options = arguments.options;
  options.scene = hullslam::synthetic::ParseSceneKind(arguments.scene);
  options.frames = arguments.frames.value_or(hullslam::synthetic::DefaultFrames(options.scene));
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const auto progress = [&](int done) {
    if (!arguments.quiet && (terminal || done % 50 == 0 || done == options.frames)) {
      std::fprintf(stderr, "%s%d/%d frames, %.1f frames/s%s", terminal ? "\r" : "", done,
                   options.frames, done / seconds(), terminal ? "" : "\n");
    }
    return !hullslam::IsInterrupted();
  };
  const bool finished = hullslam::synthetic::WriteSequence(arguments.folder, options, progress);
  if (!arguments.quiet && terminal) {
    std::fputc('\n', stderr);
  }
  if (!finished) {
    std::fprintf(stderr, "error: the program was interrupted; nothing was written\n");
    return kFailed;
  }
  if (!arguments.quiet) {
    std::printf("%s: %d frames of scene %s, seed %llu, in %.1f s\n", arguments.folder.c_str(),
                options.frames, arguments.scene.c_str(),
                static_cast<unsigned long long>(options.seed), seconds());
  }
  return kDone;
}

int Run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Renders a synthetic RGB-D sequence with exact ground truth of the camera and the "
      "objects.",
      "make_synthetic");
  AddOptions(app, arguments);
  if (!hullslam::ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  hullslam::CatchInterrupts();  // then an interrupted program can remove its unfinished sequence
  return Render(arguments);
}

}  // namespace

int main(int argc, char** argv) { return hullslam::RunMain(Run, argc, argv); }
