// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace hullslam {

// A program of this build, or a command of one ("hullslam view"), in a process of its own, whose
// output the test can read line by line while it runs.
class RunningProgram {
 public:
  // The program starts with the signal `ignored` ignored, as with nohup; 0: no signal is ignored.
  RunningProgram(const std::string& name, std::vector<std::string> arguments, int ignored = 0) {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error("cannot create a pipe");
    }
    const size_t space = std::min(name.find(' '), name.size());
    if (space < name.size()) {
      arguments.insert(arguments.begin(), name.substr(space + 1));
    }
    arguments.insert(arguments.begin(), ProgramPath(name.substr(0, space)).string());
    std::vector<char*> words;
    for (std::string& argument : arguments) {
      words.push_back(argument.data());
    }
    words.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
      if (ignored != 0) {
        ::signal(ignored, SIG_IGN);
      }
      ::dup2(pipe[1], STDERR_FILENO);
      ::dup2(pipe[1], STDOUT_FILENO);
      ::execv(words[0], words.data());
      ::_exit(127);
    }
    ::close(pipe[1]);
    output_ = ::fdopen(pipe[0], "r");
  }
  ~RunningProgram() { std::fclose(output_); }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  // The next line of its output; empty at the end.
  std::string ReadLine() {
    std::array<char, 1000> line{};
    return std::fgets(line.data(), line.size(), output_) != nullptr ? line.data() : "";
  }

  // The next line that begins with this text; empty if there is none.
  std::string ReadLine(const std::string& begin) {
    std::string line = ReadLine();
    while (!line.empty() && !line.starts_with(begin)) {
      line = ReadLine();
    }
    return line;
  }

  void Send(int signal) const { ::kill(process_, signal); }

  // Waits until the program has ended and returns the exit code; -1 if a signal ended it.
  int Wait() {
    while (!ReadLine().empty()) {
    }
    int status = 0;
    ::waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = -1;
  std::FILE* output_ = nullptr;
};

}  // namespace hullslam
