// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/program.h"

#include <fcntl.h>
#include <glog/logging.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <future>
#include <system_error>

namespace hullslam {
namespace {

// This is a global variable, because a signal handler gets no argument from the program. The
// handler may only use lock-free variables.
static_assert(std::atomic<bool>::is_always_lock_free);
Cancellation interruption;

}  // namespace

void PrepareStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      // open() returns the lowest free descriptor, which is `stream`. It is opened for reading
      // only, so that writing to a closed stdout is still an error.
      [[maybe_unused]] const int opened =
          ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
    }
  }
  // Else nothing would be seen in a pipe or a file before the program ends.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  // Ceres logs with glog what the results of its solvers say too.
  FLAGS_minloglevel = google::GLOG_FATAL;
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

int CallWithStack(const std::function<int()>& work) {
  constexpr size_t kUsual = 8 << 20;
  // The stacks of threads have by default the limit of the first one.
  pthread_attr_t attributes;
  size_t stack = kUsual;
  if (::pthread_getattr_default_np(&attributes) != 0) {
    return work();
  }
  ::pthread_attr_getstacksize(&attributes, &stack);
  if (stack < kUsual) {
    ::pthread_attr_setstacksize(&attributes, kUsual);
    ::pthread_setattr_default_np(&attributes);
  }
  ::pthread_attr_destroy(&attributes);
  return stack < kUsual ? std::async(std::launch::async, work).get() : work();
}

void PrintFailure(const std::string& message) { PrintError("error: {}\n", message); }

int FailIfAny(std::initializer_list<std::string> failures) {
  int code = kDone;
  for (const std::string& failure : failures) {
    if (!failure.empty()) {
      PrintFailure(failure);
      code = kFailed;
    }
  }
  return code;
}

int FinishStdout(int code) {
  errno = 0;
  const bool is_flushed = std::fflush(stdout) == 0;
  const int reason = errno;
  if (is_flushed && std::ferror(stdout) == 0) {
    return code;
  }
  PrintError("error: stdout cannot be written{}\n",
             reason != 0 ? ": " + std::generic_category().message(reason) : std::string());
  return code == kDone ? kFailed : code;
}

void CatchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { interruption.Request(); };
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction former = {};
    sigaction(signal, nullptr, &former);
    if (former.sa_handler != SIG_IGN) {
      sigaction(signal, &action, nullptr);
    }
  }
}

const Cancellation& Interruption() { return interruption; }

bool IsInterrupted() { return interruption.IsRequested(); }

}  // namespace hullslam
