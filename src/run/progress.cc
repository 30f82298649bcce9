// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "run/program.h"

namespace hullslam {
namespace {

constexpr std::chrono::milliseconds kRedraw(100);
constexpr size_t kBarWidth = 24;

}  // namespace

Progress::Progress(size_t frames, bool quiet)
    : frames_(std::max<size_t>(frames, 1)),
      quiet_(quiet),
      is_terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::Show(size_t done, const std::function<std::string()>& state) {
  const Clock::time_point now = Clock::now();
  const bool is_tenth = done * 10 / frames_ != (done - 1) * 10 / frames_;
  const bool is_due = is_terminal_ ? now - shown_ >= kRedraw || done == frames_ : is_tenth;
  if (quiet_ || !is_due) {
    return;
  }
  shown_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = static_cast<double>(done) / std::max(elapsed, 1e-3);
  const std::string facts =
      fmt::format("frame {}/{}  {:.1f} frames/s  {:.0f} s left{}", done, frames_, rate,
                  static_cast<double>(frames_ - done) / rate, state ? "  " + state() : "");
  if (is_terminal_) {
    const std::string bar(done * kBarWidth / frames_, '#');
    PrintText(stderr, fmt::format("\r[{:.<{}}] {}\033[K", bar, kBarWidth, Printable(facts)));
    is_line_open_ = true;
  } else {
    PrintError("{}\n", facts);
  }
}

void Progress::Clear() {
  if (is_line_open_) {
    PrintText(stderr, "\n");
    is_line_open_ = false;
  }
}

}  // namespace hullslam
