// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/paths.h"
#include "support/temporary_folder.h"

namespace hullslam {

struct ProgramResult {
  int exit_code = -1;  // -1 if a signal ended the program
  std::string output;  // text on stdout
  std::string errors;  // text on stderr
};

inline std::filesystem::path ProgramPath(const std::string& name) { return ProgramFolder() / name; }

// Runs a command of the shell and returns its exit code; -1 if a signal ended it.
inline int RunShell(const std::string& command) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): tests run programs one after the other
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The shell command of a program, such as "rgbd_tum", or of a command of one, "hullslam view".
inline std::string ShellCommand(const std::string& name) {
  const size_t space = std::min(name.find(' '), name.size());
  return '\'' + ProgramPath(name.substr(0, space)).string() + '\'' + name.substr(space);
}

// Runs a program of this build, or a command of one, and waits for it to end. `setup` holds shell
// commands to run before it, such as "ulimit -f 8;".
inline ProgramResult RunProgram(const std::string& name, const std::vector<std::string>& arguments,
                                const std::string& setup = "") {
  const TemporaryFolder folder;
  const auto read = [&](const char* file) {
    std::ifstream stream(folder.path() / file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  std::string command = setup + ShellCommand(name);
  for (const std::string& argument : arguments) {
    command += " '" + argument + '\'';
  }
  command +=
      " >'" + (folder.path() / "out").string() + "' 2>'" + (folder.path() / "err").string() + '\'';
  const int exit_code = RunShell(command);
  return {exit_code, read("out"), read("err")};
}

}  // namespace hullslam
