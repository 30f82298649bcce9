// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/view_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string_view>
#include <thread>

#include "hullslam/map_files/map_file.h"
#include "run/command_line.h"
#include "run/program.h"
#include "system/make_sensor.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestPort = 65535;
constexpr const char* kAddressHelp =
    "IP address on which browsers can reach the view: 127.0.0.1 only from this computer, 0.0.0.0 "
    "from the whole network, where only the printed address with its token opens it";

bool IsNumber(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), IsDigit);
}

// The file of a map that a browser asks for. Without --save-map it is beside the output folder,
// because the end of the run removes what it has not written itself inside of it.
fs::path LiveMapFile(const RunArguments& arguments) {
  if (!arguments.save_map.empty()) {
    return arguments.save_map;
  }
  fs::path file = (arguments.output / "").parent_path();
  file += "-live.map";
  return file;
}

LiveRun DescribeRun(const RunArguments& arguments, const SystemOptions& options,
                    const ImageSequence& sequence, const std::optional<Trajectory>& groundtruth) {
  LiveRun run;
  run.title = (arguments.sequence / "").parent_path().filename().string();
  run.program = arguments.program;
  run.sequence = arguments.sequence.string();
  run.version = HULLSLAM_VERSION;
  run.sensor = MakeSensor(options);
  run.start = sequence.frames.front().timestamp;
  run.frame_count = sequence.frames.size();
  run.groundtruth = groundtruth.value_or(Trajectory());
  run.can_localise = !arguments.localization;
  return run;
}

void PrintAddress(const std::string& url) {
  Print("open this address in a browser: {}\n", url);
  std::fflush(stdout);
}

}  // namespace

void AddViewArguments(CLI::App& app, RunArguments& arguments) {
  ExpectNumber(
      *app.add_option(
              "--view", arguments.view_port,
              fmt::format("show the run in a browser while it goes on, and let it be paused "
                          "there; prints the address. The optional value is the port, 0 for "
                          "any free one (default: {}). The view ends with the run, and the "
                          "page keeps what it shows; see the program view for finished runs",
                          kDefaultViewPort))
           ->type_name("[PORT]"),
      0.0, kLargestPort);
  app.add_option("--view-address", arguments.view_address, kAddressHelp)->capture_default_str();
}

void AddPageArguments(CLI::App& app, int& port, std::string& address) {
  port = kDefaultViewPort;
  ExpectNumber(*app.add_option("--port", port, "port of the view, 0 for any free one")
                    ->capture_default_str(),
               0.0, kLargestPort);
  app.add_option("--view-address", address, kAddressHelp)->capture_default_str();
}

std::vector<std::string> CompleteViewOption(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  for (size_t i = 0; i < words.size(); ++i) {
    const bool has_port = i + 1 < words.size() && IsNumber(words[i + 1]);
    if (words[i] == "--view" && !has_port) {
      words[i] += fmt::format("={}", kDefaultViewPort);
    }
  }
  return words;
}

LiveOutput OpenLiveOutput(const RunArguments& arguments, const SystemOptions& options,
                          const ImageSequence& sequence,
                          const std::optional<Trajectory>& groundtruth) {
  if (arguments.view_port < 0) {
    return LiveOutput();
  }
  LiveOutput live({.address = {.address = arguments.view_address, .port = arguments.view_port},
                   .run = DescribeRun(arguments, options, sequence, groundtruth),
                   .map_file = LiveMapFile(arguments),
                   .settings = MapSettingsOf(options),
                   .warn = [](const std::string& reason) {
                     PrintError("warning: the live view has ended: {}\n", reason);
                   }});
  PrintAddress(live.url());
  return live;
}

void ServePage(const std::string& page, int port, const std::string& address) {
  constexpr std::chrono::milliseconds kStep(100);
  CatchInterrupts();
  const PageServer server({.address = address, .port = port}, page);
  PrintAddress(server.url());
  while (!IsInterrupted()) {
    std::this_thread::sleep_for(kStep);
  }
}

}  // namespace hullslam
