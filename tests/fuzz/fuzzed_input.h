// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "hullslam/util/error.h"

namespace hullslam {
namespace fs = std::filesystem;

[[noreturn]] inline void Finding(const std::string& what) {
  std::fprintf(stderr, "finding: %s\n", what.c_str());
  std::abort();
}

inline void Expect(bool good, const std::string& what) {
  if (!good) {
    Finding(what);
  }
}

// A file in memory. Its content is replaced for each input.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("input", MFD_CLOEXEC)) {
    Expect(descriptor_ >= 0, "memfd_create");
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  fs::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  void Write(std::string_view bytes) const {
    Expect(::ftruncate(descriptor_, 0) == 0, "ftruncate");
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), 0);
    Expect(written == static_cast<ssize_t>(bytes.size()), "pwrite");
  }

 private:
  int descriptor_;
};

// A temporary folder in which the file `name` is the input. The others are files of the folder
// `given` that are there too.
class InputFolder {
 public:
  explicit InputFolder(const std::string& name, const std::string& other = "",
                       const std::string& third = "") {
    std::string folder = fs::temp_directory_path() / "hullslam_fuzz_XXXXXX";
    Expect(::mkdtemp(folder.data()) != nullptr, "mkdtemp");
    path_ = folder;
    fs::create_symlink(file_.path(), path_ / name);
    for (const std::string& given : {other, third}) {
      if (!given.empty()) {
        fs::copy_file(fs::path(HULLSLAM_FUZZ_FOLDER) / "given" / given, path_ / given);
      }
    }
  }
  ~InputFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  const fs::path& path() const { return path_; }
  void Write(std::string_view bytes) const { file_.Write(bytes); }

 private:
  MemoryFile file_;
  fs::path path_;
};

// Runs a reader on its input.
template <typename Read>
void Try(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    Expect(message.find('\n') == std::string_view::npos, "a message of several lines");
    Expect(message.size() < 2000, "a message of " + std::to_string(message.size()) + " bytes");
  } catch (const std::exception& error) {
    Finding(std::string("another exception than InputError: ") + error.what());
  }
}

template <typename Read>
void TryFile(std::string_view bytes, const Read& read) {
  static const MemoryFile file;
  file.Write(bytes);
  Try([&] { read(file.path()); });
}

}  // namespace hullslam
