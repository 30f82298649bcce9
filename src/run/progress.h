// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace hullslam {

// Shows the progress of a run on stderr: as a bar that is redrawn if stderr is a terminal, else as
// one line per tenth of the run.
class Progress {
 public:
  Progress(size_t frames, bool quiet);

  // `done` is the number of frames that are done. `state` returns a text to show after it. It is
  // only called if something is shown.
  void Show(size_t done, const std::function<std::string()>& state = {});
  // Time that does not count, such as a pause.
  void Skip(std::chrono::steady_clock::duration time) { start_ += time; }
  // Ends the line of the bar, so that other text can be printed on the next line.
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
