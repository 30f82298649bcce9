// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "hullslam/map_files/map_file.h"
#include "hullslam/system/system.h"
#include "live/live_view.h"

namespace hullslam {

// A run that is to be shown.
struct ShownRun {
  ViewAddress address = {};
  LiveRun run = {};
  std::filesystem::path map_file = {};                       // of the map that a browser asks for
  MapSettings settings = {};                                 // of this file
  std::function<void(const std::string& reason)> warn = {};  // is told why the view has ended
};

// The live view of a System: what is to be called before and after each frame.
class LiveOutput {
 public:
  LiveOutput();  // does nothing
  // Throws InputError if the address or the port cannot be used.
  explicit LiveOutput(ShownRun shown);
  ~LiveOutput();
  LiveOutput(LiveOutput&&) noexcept;
  LiveOutput& operator=(LiveOutput&&) = delete;

  bool IsOn() const { return view_ != nullptr; }
  // The address to open in a browser; empty if it does nothing.
  std::string url() const;
  // Before each frame: waits while a user has paused the run, and switches to localisation only and
  // back. Returns how long it has waited. `on_pause` is called before it waits.
  std::chrono::steady_clock::duration BeforeFrame(System& system,
                                                  const std::function<bool()>& is_cancelled,
                                                  const std::function<void()>& on_pause);
  // To be called with each report of the System.
  void NoteFrame(const FrameReport& report);
  // After each frame. The report and the map of `frame` are filled in.
  void AfterFrame(LiveFrame frame, const System& system);
  // Before the map is adjusted at the end, and when all results are written.
  void BeginFinishing();
  void End(std::shared_ptr<const Map> map, const nlohmann::json& summary);

 private:
  std::unique_ptr<LiveView> view_;
  std::optional<FrameReport> report_;
  bool is_localising_ = false;
};

}  // namespace hullslam
