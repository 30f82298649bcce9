// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace hullslam {

// When a program is ended that sends nothing.
struct Patience {
  std::chrono::seconds work{120};  // of a processor, since it is waited for
  std::chrono::seconds idle{60};   // without any work
};

// A program with which this process talks through a connection. It has no other descriptors, and
// signals of the terminal do not reach it. It ends when the connection is closed.
class ChildProcess {
 public:
  // The program has ended or was ended; the message says how: "it has crashed (Segmentation
  // fault)".
  class Ended : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
  };

  // The program gets its end of the connection as this descriptor. Throws std::runtime_error if it
  // cannot be started.
  ChildProcess(const std::filesystem::path& program, int descriptor);
  // Ends the program.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Sends bytes or receives all of them. Throws Ended if the program ends before.
  void Send(const void* bytes, size_t size);
  void Receive(void* bytes, size_t size, const Patience& patience = {});

  // False in a process that was forked from the one that started the program.
  bool IsOwn() const;

 private:
  [[noreturn]] void FailEnded();
  [[noreturn]] void End(const std::string& reason);
  // The time that the program has worked, by all its threads.
  std::chrono::nanoseconds Work() const;
  // `begin` is the work before.
  void WaitForBytes(const Patience& patience, std::chrono::nanoseconds begin);

  pid_t process_ = -1;
  pid_t owner_ = -1;
  int connection_ = -1;
};

}  // namespace hullslam
