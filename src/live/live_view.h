// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "live/live_inbox.h"
#include "live/live_messages.h"
#include "live/pause_gate.h"

namespace hullslam {

inline constexpr int kDefaultViewPort = 8320;

// Where browsers find a page.
struct ViewAddress {
  std::string address = "127.0.0.1";  // an IP address of this computer, or 0.0.0.0 for all
  int port = kDefaultViewPort;        // 0: any free one
};

// Functions of the program that the view calls, in threads of the view.
struct LiveCommands {
  // Saves the map. Returns a sentence that says where it is, or why it could not be saved.
  std::function<std::string(const Map& map)> save_map;
  // Tells the user that the view has failed, and why. May be empty.
  std::function<void(const std::string& reason)> warn = {};
};

// Serves one page that does not change, such as the report of a finished run, with the same rules
// as the live view. Throws InputError if the address or the port cannot be used.
class PageServer {
 public:
  PageServer(const ViewAddress& address, std::string page);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  // The address to open in a browser.
  const std::string& url() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Shows a run in browsers while it goes on. The run hands over each frame and never waits, unless a
// user pauses it. Messages are made in a thread of low priority, and only while a browser watches.
// A failure of the view ends the view and not the run.
class LiveView {
 public:
  // Throws InputError if the address or the port cannot be used.
  LiveView(const ViewAddress& address, LiveRun run, LiveCommands commands,
           const LiveMapLimits& limits = {});
  // Ends the connections.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  // The address to open in a browser, with the token for the controls.
  const std::string& url() const;

  // To be called after each frame.
  void Show(LiveFrame frame);
  // To be called before each frame: waits while a user has paused the run. See PauseGate::Pass().
  PauseGate::Clock::duration PassGate(const std::function<bool()>& is_cancelled,
                                      const std::function<void()>& on_pause);
  // Whether a user wants the map to stay as it is.
  bool IsLocalisationWanted() const;

  // All frames were tracked. Waits for a map that is being saved; no more are, until the run's own.
  void BeginFinishing();
  // The run has ended with this map (may be null) and this content of summary.json. Waits until the
  // browsers have got it, but not longer than two seconds. The pages keep what they show.
  void End(std::shared_ptr<const Map> map, nlohmann::json summary);

  // For measurements: bytes that were sent so far.
  uint64_t bytes_sent() const;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace hullslam
