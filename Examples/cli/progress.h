// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace hullslam {

// Shows how far a run is on stderr: a bar that redraws itself on a terminal, else a line at every
// tenth of the run.
class Progress {
 public:
  Progress(size_t frames, bool quiet);

  // `done` counts from 1; `state` is asked for what to say besides where something is shown.
  void Show(size_t done, const std::function<std::string()>& state = {});
  // Ends the line of the bar, so that something else can be printed.
  void Clear();

 private:
  using Clock = std::chrono::steady_clock;

  size_t frames_;
  bool quiet_;
  bool is_terminal_;
  bool is_line_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
};

}  // namespace hullslam
