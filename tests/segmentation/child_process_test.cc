// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr int kConnection = 3;

class ChildProcessTest : public testing::Test {
 protected:
  fs::path Script(const std::string& commands) const {
    const fs::path file = folder_.Write("script", "#!/bin/sh\n" + commands + "\n");
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }

  // The message with which a call that receives a byte fails.
  std::string EndOf(ChildProcess& child, const Patience& patience = {}) const {
    char byte = 0;
    try {
      child.Receive(&byte, 1, patience);
    } catch (const ChildProcess::Ended& error) {
      return error.what();
    }
    return "a byte was received";
  }

  TemporaryFolder folder_;
};

TEST_F(ChildProcessTest, BytesGoBothWays) {
  ChildProcess child(Script("head -c 5 <&3 | tr a-z A-Z >&3"), kConnection);
  EXPECT_TRUE(child.IsOwn());
  child.Send("hello", 5);
  std::string answer(5, ' ');
  child.Receive(answer.data(), answer.size());
  EXPECT_EQ(answer, "HELLO");
  EXPECT_EQ(EndOf(child), "it has ended early");
}

TEST_F(ChildProcessTest, ACrashIsAnErrorThatNamesTheSignal) {
  ChildProcess child(Script("ulimit -c 0; kill -SEGV $$"), kConnection);
  EXPECT_EQ(EndOf(child), "it has crashed (Segmentation fault)");
  EXPECT_THROW(child.Send("x", 1), ChildProcess::Ended);
  EXPECT_EQ(EndOf(child), "it has ended early") << "the status is known once";
}

TEST_F(ChildProcessTest, AProgramThatDoesNotAnswerIsEnded) {
  using namespace std::chrono_literals;
  ChildProcess busy(Script("while :; do :; done"), kConnection);
  EXPECT_EQ(EndOf(busy, {.work = 0s}), "it has taken more than 0 s of a processor");
  ChildProcess idle(Script("exec sleep 1000"), kConnection);
  EXPECT_EQ(EndOf(idle, {.idle = 0s}), "it has done nothing for 0 s");
}

// Locks and pipes of the caller would else last as long as the program.
TEST_F(ChildProcessTest, TheProgramHasNoOtherDescriptors) {
  constexpr int kOpen = 40;
  ASSERT_EQ(::dup2(STDERR_FILENO, kOpen), kOpen);
  ChildProcess child(
      Script("for fd in 1 3 4 40; do [ -e /proc/$$/fd/$fd ] && printf $fd >&3; done"), kConnection);
  std::string answer(2, ' ');
  child.Receive(answer.data(), answer.size());
  EXPECT_EQ(answer, "13");
  EXPECT_EQ(EndOf(child).substr(0, 12), "it has ended");
  ::close(kOpen);
}

TEST_F(ChildProcessTest, TheProgramEndsWithTheObject) {
  pid_t process = 0;
  {
    ChildProcess child(Script("printf '%08d' $$ >&3; exec sleep 1000"), kConnection);
    std::string answer(8, ' ');
    child.Receive(answer.data(), answer.size());
    process = static_cast<pid_t>(std::stoi(answer));
    EXPECT_EQ(::kill(process, 0), 0);
  }
  EXPECT_NE(::kill(process, 0), 0);
}

// As with Python's multiprocessing: the copy of the object must not end the program of the
// original.
TEST_F(ChildProcessTest, AForkedProcessDoesNotEndIt) {
  auto child = std::make_unique<ChildProcess>(Script("head -c 2 <&3 >&3"), kConnection);
  const pid_t forked = ::fork();
  if (forked == 0) {
    const bool is_own = child->IsOwn();
    child.reset();
    ::_exit(is_own ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(forked, &status, 0), forked);
  EXPECT_EQ(status, 0);
  child->Send("ok", 2);
  std::array<char, 2> answer{};
  child->Receive(answer.data(), answer.size());
  EXPECT_EQ(answer[1], 'k');
}

TEST_F(ChildProcessTest, AProgramThatCannotBeStartedIsAnError) {
  try {
    ChildProcess child(folder_.path() / "none", kConnection);
    FAIL() << "expected an error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("none: cannot be started: No such file"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace hullslam
