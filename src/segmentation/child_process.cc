// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX asks for it

namespace hullslam {
namespace {

[[noreturn]] void FailStart(const std::filesystem::path& program, int code) {
  throw std::runtime_error(fmt::format("{}: cannot be started: {}", program.string(),
                                       std::generic_category().message(code)));
}

// What posix_spawn is to do in the new process.
class SpawnActions {
 public:
  SpawnActions(int connection, int descriptor) {
    posix_spawn_file_actions_init(&actions_);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
      posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", O_RDWR, 0);
    }
    posix_spawn_file_actions_adddup2(&actions_, connection, descriptor);
    // Others would stay open for as long as the program runs: locks, pipes, files of the user.
    posix_spawn_file_actions_addclosefrom_np(&actions_, descriptor + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnActions() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  int Spawn(const std::filesystem::path& program, pid_t& process) const {
    std::string name = program.string();
    const std::array<char*, 2> arguments = {name.data(), nullptr};
    return posix_spawn(&process, name.c_str(), &actions_, &attributes_, arguments.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

ChildProcess::ChildProcess(const std::filesystem::path& program, int descriptor)
    : owner_(::getpid()) {
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    FailStart(program, errno);
  }
  // dup2 would not clear the flag that closes the descriptor if it has the right number already.
  const int given = ::fcntl(ends[1], F_DUPFD_CLOEXEC, descriptor + 1);
  const int code = given < 0 ? errno : SpawnActions(given, descriptor).Spawn(program, process_);
  ::close(ends[1]);
  ::close(given);
  connection_ = ends[0];
  if (code != 0) {
    ::close(connection_);
    FailStart(program, code);
  }
}

ChildProcess::~ChildProcess() {
  ::close(connection_);
  if (process_ > 0 && IsOwn()) {
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

bool ChildProcess::IsOwn() const { return ::getpid() == owner_; }

void ChildProcess::FailEnded() {
  int status = 0;
  pid_t waited = -1;
  if (process_ > 0) {
    ::kill(process_, SIGKILL);  // if it goes on without the connection; else its status stays
    do {
      waited = ::waitpid(process_, &status, 0);
    } while (waited < 0 && errno == EINTR);
  }
  process_ = -1;
  // Where the user ignores SIGCHLD, the system does not keep the status.
  throw Ended(waited > 0 && WIFSIGNALED(status)
                  ? fmt::format("it has crashed ({})", ::strsignal(WTERMSIG(status)))
                  : std::string("it has ended early"));
}

void ChildProcess::End(const std::string& reason) {
  ::kill(process_, SIGKILL);
  try {
    FailEnded();
  } catch (const Ended&) {
    throw Ended(reason);
  }
}

void ChildProcess::Send(const void* bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    const ssize_t count =
        ::send(connection_, static_cast<const char*>(bytes) + done, size - done, MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) {
      FailEnded();
    }
    done += count > 0 ? static_cast<size_t>(count) : 0;
  }
}

std::chrono::nanoseconds ChildProcess::Work() const {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process_, &clock) != 0 || ::clock_gettime(clock, &time) != 0) {
    return {};
  }
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void ChildProcess::WaitForBytes(const Patience& patience, std::chrono::nanoseconds begin) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kStep(200);
  std::chrono::nanoseconds former = Work();
  Clock::time_point worked = Clock::now();
  while (true) {
    pollfd wait{.fd = connection_, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(kStep.count()));
    if (ready > 0 || (ready < 0 && errno != EINTR)) {
      return;
    }
    const std::chrono::nanoseconds work = Work();
    if (work != former) {
      worked = Clock::now();
    }
    former = work;
    if (work - begin > patience.work) {
      End(fmt::format("it has taken more than {} s of a processor", patience.work.count()));
    }
    if (Clock::now() - worked > patience.idle) {
      End(fmt::format("it has done nothing for {} s", patience.idle.count()));
    }
  }
}

void ChildProcess::Receive(void* bytes, size_t size, const Patience& patience) {
  const std::chrono::nanoseconds begin = Work();
  for (size_t done = 0; done < size;) {
    WaitForBytes(patience, begin);
    const ssize_t count = ::recv(connection_, static_cast<char*>(bytes) + done, size - done, 0);
    if (count == 0 || (count < 0 && errno != EINTR)) {
      FailEnded();
    }
    done += count > 0 ? static_cast<size_t>(count) : 0;
  }
}

}  // namespace hullslam
