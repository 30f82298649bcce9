// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/command_line.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "hullslam/util/error.h"

namespace hullslam {

bool ParseCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::Success& request) {
    app.exit(request);
    return false;
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }
}

void AddVersionAndExitCodes(CLI::App& app, const std::string& done, const std::string& failed,
                            const std::string& bad_input) {
  app.set_version_flag("--version", HULLSLAM_VERSION);
  app.footer("Exit codes: 0 " + done + ", 1 " + failed + ", 2 " + bad_input + ".");
}

void AddOverwriteFlag(CLI::App& app, bool& overwrite) {
  app.add_flag("--overwrite", overwrite,
               "also replace a run of another program in the folder of --output");
}

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

void AddOverrides(CLI::App& app, const std::string& name, const std::string& meaning,
                  std::vector<std::string>& overrides) {
  app.add_option(name, overrides, meaning)
      ->take_all()
      ->allow_extra_args(false);  // else it would also take the positional arguments after it
}

void AddOverrides(CLI::App& app, std::vector<std::string>& overrides) {
  AddOverrides(app, "--set", "key=value: overrides one setting; can be given several times",
               overrides);
}

}  // namespace hullslam
