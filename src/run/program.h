// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <initializer_list>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/util/cancellation.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {

// Messages of a program. Unlike fmt::print(), they never throw: a full disk or a closed pipe behind
// stdout or stderr must not end a run. RunMain() checks stdout at the end of the program.

// The text as it is, for what the program itself controls a terminal with.
inline void PrintText(std::FILE* stream, const std::string& text) {
  [[maybe_unused]] const size_t written = std::fwrite(text.data(), 1, text.size(), stream);
}

// Names of files and of classes come from outside, so both functions replace what is not printable.

// For a report of any number of lines.
template <typename... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  PrintText(stdout, Printable(fmt::format(format, std::forward<Values>(values)...), "\n"));
}

// For a message of one line, which ends in "\n". No name in it can begin another line.
template <typename... Values>
void PrintError(fmt::format_string<Values...> format, Values&&... values) {
  std::string line = fmt::format(format, std::forward<Values>(values)...);
  const bool has_end = line.ends_with('\n');
  if (has_end) {
    line.pop_back();
  }
  PrintText(stderr, Printable(line) + (has_end ? "\n" : ""));
}

inline void PrintWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    PrintError("warning: {}\n", warning);
  }
}

enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2 };

// A stream that was closed by the caller is opened to /dev/null, because otherwise the next file
// that the program opens would take its place and receive the messages. A closed pipe or a file
// that may not grow becomes an error of the write instead of the end of the program. Each line of
// stdout is written when it is complete. The log of Ceres does not go to stderr.
void PrepareStreams();

// Prints one line, "error: MESSAGE", on stderr.
void PrintFailure(const std::string& message);

// Prints the failures that are not empty. Returns kFailed if there is one, else kDone.
int FailIfAny(std::initializer_list<std::string> failures);

// Writes out what is still buffered for stdout. Returns `code`. If some of the output could not be
// written, prints the reason on stderr and returns kFailed instead of kDone.
int FinishStdout(int code);

// Calls `work` and returns its result. If the stack of the program is limited to less than usual
// (ulimit -s), `work` has a thread with a usual one, as all threads that start later.
int CallWithStack(const std::function<int()>& work);

// Calls `run(argc, argv)` and returns its exit code. Turns an exception into one line on stderr and
// an exit code.
template <typename Run>
int RunMain(const Run& run, int argc, char** argv) {
  PrepareStreams();
  int code = kFailed;
  try {
    code = CallWithStack([&] { return run(argc, argv); });
  } catch (const InputError& error) {
    PrintFailure(error.what());
    code = kBadInput;
  } catch (const std::bad_alloc&) {
    PrintFailure("there is not enough memory");
  } catch (const std::exception& error) {
    PrintFailure(error.what());
  }
  return FinishStdout(code);
}

// The revision that this program was configured from, as `git describe` gives it; empty outside of
// a clone.
std::string GitRevision();

// From now on SIGINT, SIGTERM and SIGHUP do not end the program. Instead they request that it stops
// early and writes its results so far. Further signals change nothing, so they cannot destroy the
// results while they are written. A signal that was ignored when the program started (nohup does
// this) stays ignored.
void CatchInterrupts();
// Is requested when one of the signals arrives.
const Cancellation& Interruption();
bool IsInterrupted();

}  // namespace hullslam
