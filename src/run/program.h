// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <functional>
#include <initializer_list>
#include <new>
#include <string>

#include "hullslam/util/error.h"

namespace hullslam {

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

}  // namespace hullslam
