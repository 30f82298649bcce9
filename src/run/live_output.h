// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/options.h"
#include "hullslam/system/system.h"
#include "run/run_arguments.h"
#include "segmentation/frame_source.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

class LiveView;

// Adds --view and --view-address.
void AddViewArguments(CLI::App& app, RunArguments& arguments);

// Adds --port and --view-address for a program whose pages do not change.
void AddPageArguments(CLI::App& app, int& port, std::string& address);

// The words of a command line, in which a --view without a port has the default port:
// "--view desk" becomes "--view=8320 desk".
std::vector<std::string> CompleteViewOption(int argc, char** argv);

// The live view of a run. Without --view it does nothing.
class LiveOutput {
 public:
  // Prints the address on stdout, also with --quiet, because the token in it cannot be guessed.
  // Throws InputError if the address or the port cannot be used.
  LiveOutput(const RunArguments& arguments, const SystemOptions& options,
             const ImageSequence& sequence, const std::optional<Trajectory>& groundtruth);
  ~LiveOutput();
  LiveOutput(const LiveOutput&) = delete;
  LiveOutput& operator=(const LiveOutput&) = delete;

  bool IsOn() const { return view_ != nullptr; }
  // Before each frame: waits while a user has paused the run, and switches to localisation only and
  // back. Returns how long it has waited. `on_pause` is called before it waits.
  std::chrono::steady_clock::duration BeforeFrame(FrameSource& frames, System& system,
                                                  const std::function<void()>& on_pause);
  // To be called with each report of the System.
  void NoteFrame(const FrameReport& report);
  // After each frame. It is the `number`-th one, counted from 1, and tracking took this time.
  void AfterFrame(const LoadedFrame& frame, size_t number, double track_ms, const System& system);
  // Before the map is adjusted at the end, and when all results are written.
  void BeginFinishing();
  void End(std::shared_ptr<const Map> map, const nlohmann::json& summary);

 private:
  std::unique_ptr<LiveView> view_;
  std::optional<FrameReport> report_;
  bool is_localising_ = false;
};

// Shows a page until a signal ends the program. Prints its address. Throws InputError as above.
void ServePage(const std::string& page, int port, const std::string& address);

}  // namespace hullslam
