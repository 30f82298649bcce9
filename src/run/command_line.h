// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace hullslam {

// The parts of the command line that all programs share. The headers of this folder only declare
// CLI::App, because compiling CLI11 takes seconds.

// Parses the command line. Returns true if the program should go on, and false after options such
// as --help. Throws InputError if the command line cannot be parsed. If an option is not known, the
// message names the one that is spelled most like it.
bool ParseCommandLine(CLI::App& app, int argc, char** argv);

// Adds --version, and adds the meaning of the exit codes to the end of --help. Subcommands that are
// added later show the exit codes too.
void AddVersionAndExitCodes(CLI::App& app, const std::string& done = "done",
                            const std::string& failed = "the program failed",
                            const std::string& bad_input = "bad usage or input");

// Refuses values of an option that are not a number from `least` to `most`. (CLI::Range accepts
// "nan".)
void ExpectNumber(CLI::Option& option, double least, double most);

// Accepts integers that are at least `least` (0 or 1). Without this check CLI11 would turn -1 into
// the largest unsigned number.
CLI::Validator WholeNumber(int least);

// Adds --output, the folder for the results of a run, and --overwrite, without which the run does
// not replace one of another program.
void AddOutputArguments(CLI::App& app, std::filesystem::path& output, bool& overwrite);

// Adds --debug, which sends the library's log to stderr, including its debug messages on what
// happens to each object.
void AddDebugFlag(CLI::App& app);

// Adds an option such as --set, which takes key=value and can be given several times. `meaning` is
// its help. `overrides` must outlive the app.
void AddOverrides(CLI::App& app, const std::string& name, const std::string& meaning,
                  std::vector<std::string>& overrides);
void AddOverrides(CLI::App& app, std::vector<std::string>& overrides);  // --set

}  // namespace hullslam
