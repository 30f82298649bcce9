// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/command_line.h"

#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <mutex>
#include <string_view>

#include "hullslam/util/error.h"
#include "run/messages.h"

namespace hullslam {
namespace {

// Prints the messages of the library's log like those of the program.
class MessageSink final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    PrintError("{}", std::string_view(line.data(), line.size()));
  }
  void flush_() override {}
};

}  // namespace

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

void ExpectNumber(CLI::Option& option, double least, double most) {
  option.check(CLI::Validator(
      [least, most](const std::string& text) {
        double value = 0.0;
        const bool is_good =
            CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
        return is_good
                   ? std::string()
                   : fmt::format("'{}', expected a number from {:g} to {:g}", text, least, most);
      },
      ""));
}

void AddDebugFlag(CLI::App& app) {
  app.add_flag_callback(
      "--debug",
      [] {
        spdlog::set_default_logger(
            std::make_shared<spdlog::logger>("hullslam", std::make_shared<MessageSink>()));
        spdlog::set_pattern("%l: %v");
        spdlog::set_level(spdlog::level::debug);
      },
      "log to stderr what happens to each object and loop, and why, and adjustments that fail");
}

void AddOverrides(CLI::App& app, const std::string& name, const std::string& meaning,
                  std::vector<std::string>& overrides) {
  app.add_option(name, overrides, meaning)
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);  // else it would also take the positional arguments after it
}

void AddOverrides(CLI::App& app, std::vector<std::string>& overrides) {
  AddOverrides(app, "--set", "key=value: overrides one setting; can be given several times",
               overrides);
}

}  // namespace hullslam
