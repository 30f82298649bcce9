// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/logging.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace hullslam {

void AddDebugFlag(CLI::App& app) {
  app.add_flag_callback(
      "--debug",
      [] {
        spdlog::set_default_logger(spdlog::stderr_logger_mt("hullslam"));
        spdlog::set_pattern("%l: %v");
        spdlog::set_level(spdlog::level::debug);
      },
      "log to stderr what happens to each object, and why");
}

}  // namespace hullslam
