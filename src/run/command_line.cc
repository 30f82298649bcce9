// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/util/error.h"
#include "run/program.h"
#include "util/text.h"

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

// The long option that begins with `name`, or the one that is spelled most like it; empty if none
// is like it. The name is without dashes and a value.
std::string NearestOption(const CLI::App& app, std::string_view name) {
  std::string nearest;
  size_t least = std::max<size_t>(2, name.size() / 3) + 1;
  for (const CLI::Option* const option : app.get_options()) {
    for (const std::string& known : option->get_lnames()) {
      if (name.size() > 1 && known.starts_with(name)) {
        return known;
      }
      if (const size_t distance = EditDistance(name, known); distance < least) {
        least = distance;
        nearest = known;
      }
    }
  }
  return nearest;
}

// "; expected first: trajectory or objects" for a program whose subcommand is not given; else
// empty.
std::string SuggestSubcommand(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names.empty() || !app.get_subcommands().empty()
             ? std::string()
             : fmt::format("; expected first: {}", fmt::join(names, " or "));
}

// "; did you mean --masks?" for the first argument that is an unknown option; else empty.
std::string SuggestOption(const CLI::App& app) {
  for (const std::string& argument : app.remaining(true)) {
    if (!argument.starts_with("--")) {
      continue;
    }
    const std::string name = argument.substr(2, argument.find('=') - 2);
    for (const CLI::App* const parsed :
         {app.get_subcommands().empty() ? &app : app.get_subcommands().front(), &app}) {
      if (const std::string nearest = NearestOption(*parsed, name); !nearest.empty()) {
        return "; did you mean --" + nearest + "?";
      }
    }
  }
  return {};
}

}  // namespace

bool ParseCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::Success& request) {
    app.exit(request);
    return false;
  } catch (const CLI::ExtrasError& error) {
    throw InputError(error.what() + SuggestOption(app) + SuggestSubcommand(app));
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what() + SuggestSubcommand(app));
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

CLI::Validator WholeNumber(int least) {
  return CLI::Validator(
      [least](const std::string& text) {
        const bool is_whole =
            !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
        const bool is_zero = text.find_first_not_of('0') == std::string::npos;
        return is_whole && (least == 0 || !is_zero)
                   ? std::string()
                   : "'" + text + "', expected an integer >= " + std::to_string(least);
      },
      "");
}

void AddOutputArguments(CLI::App& app, std::filesystem::path& output, bool& overwrite) {
  app.add_option("--output", output,
                 "folder for the result files; replaces the former run of this program in it")
      ->capture_default_str();
  app.add_flag("--overwrite", overwrite,
               "also replace a run of another program in the folder of --output");
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
