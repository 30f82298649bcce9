// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/staged_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "lock";

[[noreturn]] void Fail(const char* what, const fs::path& path) {
  throw fs::filesystem_error(what, path, std::error_code(errno, std::generic_category()));
}

// Whether the open file still has this path. Another process may have removed the file between
// opening and locking.
bool IsStillAt(int descriptor, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

// The descriptor of the locked file; -1 if it cannot be opened, if another process has locked it,
// or if it was removed.
int OpenAndLock(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) {
    return -1;
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 || !IsStillAt(descriptor, file)) {
    ::close(descriptor);
    return -1;
  }
  return descriptor;
}

// Returns -1 with errno ENOENT if another process has taken the folder.
int CreateAndLock(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    return -1;
  }
  // On a file system without locks, the folder is used without one.
  const bool is_taken = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (is_taken || !IsStillAt(descriptor, file)) {
    ::close(descriptor);
    errno = ENOENT;
    return -1;
  }
  return descriptor;
}

// Removes a folder that contains at most the file of the lock, and throws the error that errno had
// before.
[[noreturn]] void FailAndRemove(const char* what, const fs::path& folder) {
  const int reason = errno;
  ::unlink((folder / kLockName).c_str());
  ::rmdir(folder.c_str());
  errno = reason;
  Fail(what, folder);
}

}  // namespace

StagingFolder::StagingFolder(const fs::path& parent, const std::string& prefix) {
  // Between its creation and its locking, a folder looks abandoned, and another process can take
  // it. Then the next attempt makes another folder.
  constexpr int kAttempts = 100;
  for (int attempt = 0; lock_ < 0 && attempt < kAttempts; ++attempt) {
    std::string name = (parent / (prefix + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr) {
      Fail("cannot create a folder", parent);
    }
    path_ = name;
    lock_ = CreateAndLock(path_ / kLockName);
    if (lock_ < 0 && errno != ENOENT) {
      FailAndRemove("cannot create a file", path_);
    }
  }
  if (lock_ < 0 || ::mkdir(content().c_str(), 0777) != 0) {
    FailAndRemove("cannot create a folder", path_);
  }
}

StagingFolder::StagingFolder(fs::path path, int lock) : path_(std::move(path)), lock_(lock) {}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept
    : path_(std::move(other.path_)),
      lock_(std::exchange(other.lock_, -1)),
      is_kept_(other.is_kept_) {}

StagingFolder::~StagingFolder() {
  if (lock_ >= 0 && is_kept_) {
    ::close(lock_);
  } else {
    Remove();
  }
}

void StagingFolder::Remove() {
  if (lock_ < 0) {
    return;
  }
  // The locked file is removed last: without it a folder that is not empty would be left for ever.
  std::error_code ignored;
  for (fs::directory_iterator entry(path_, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (entry->path().filename() != kLockName) {
      std::error_code unused;
      fs::remove_all(entry->path(), unused);
    }
  }
  fs::remove(path_ / kLockName, ignored);
  fs::remove(path_, ignored);
  ::close(std::exchange(lock_, -1));
}

std::vector<StagingFolder> StagingFolder::Abandoned(const fs::path& parent,
                                                    const std::string& prefix) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    const std::string name = entry->path().filename().string();
    if (name.starts_with(prefix) &&
        entry->symlink_status(ignored).type() == fs::file_type::directory) {
      found.push_back(entry->path());
    }
  }
  std::vector<StagingFolder> abandoned;
  for (const fs::path& folder : found) {
    const int lock = OpenAndLock(folder / kLockName);
    if (lock >= 0) {
      abandoned.push_back(StagingFolder(folder, lock));
    } else {
      ::rmdir(folder.c_str());  // only succeeds if it is empty, that is, if it was never locked
    }
  }
  return abandoned;
}

FolderLock::FolderLock(const fs::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    Fail("cannot open the folder", folder);
  }
  while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

FolderLock::~FolderLock() { ::close(descriptor_); }

bool WriteAll(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written >= 0) {
      content.remove_prefix(static_cast<size_t>(written));
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

void FailWriting(const std::filesystem::path& path, int code) {
  throw InputError(path.string() + ": cannot be written: " + std::generic_category().message(code));
}

void WriteSyncedFile(const std::filesystem::path& path, std::string_view content,
                     const std::filesystem::path& shown) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    FailWriting(shown, errno);
  }
  int failure = WriteAll(descriptor, content) && ::fsync(descriptor) == 0 ? 0 : errno;
  if (::close(descriptor) != 0 && failure == 0) {
    failure = errno;
  }
  if (failure != 0) {
    ::unlink(path.c_str());
    FailWriting(shown, failure);
  }
}

namespace {

// The file that a path stands for. Links are followed, also to a file that does not exist yet.
std::filesystem::path FollowLinks(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as in Linux
  std::error_code error;
  for (int i = 0; i < kMostLinks; ++i) {
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error) {
      return path;  // it is no link
    }
    path = path.parent_path() / target;
  }
  FailWriting(path, ELOOP);
}

// Waits until the disk knows the new name of a file, because a power cut could bring the earlier
// one back. Some file systems cannot do this; the file is complete there nevertheless.
void SyncFolder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

void CheckTarget(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    // Renaming would replace a device or a pipe by a file.
    throw InputError(path.string() + ": cannot be written: it is not a regular file");
  }
}

}  // namespace

StagedFile::StagedFile(std::filesystem::path path) : path_(FollowLinks(std::move(path))) {
  CheckTarget(path_);
  try {
    const std::filesystem::path parent = path_.has_parent_path() ? path_.parent_path() : ".";
    const std::string prefix = fmt::format(".{}.", path_.filename().string());
    StagingFolder::Abandoned(parent, prefix);  // removes what killed processes have left
    staging_ = std::make_unique<StagingFolder>(parent, prefix);
  } catch (const std::filesystem::filesystem_error& error) {
    FailWriting(path_, error.code().value());
  }
  descriptor_ = ::open(temporary().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    FailWriting(path_, errno);
  }
}

StagedFile::~StagedFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

std::filesystem::path StagedFile::temporary() const { return staging_->content() / "file"; }

void StagedFile::Write(std::string_view bytes) {
  if (!WriteAll(descriptor_, bytes)) {
    FailWriting(path_, errno);
  }
}

void StagedFile::Commit() {
  int failure = ::fsync(descriptor_) == 0 ? 0 : errno;
  if (::close(std::exchange(descriptor_, -1)) != 0 && failure == 0) {
    failure = errno;
  }
  if (failure == 0 && std::rename(temporary().c_str(), path_.c_str()) != 0) {
    failure = errno;
  }
  if (failure != 0) {
    FailWriting(path_, failure);
  }
  SyncFolder(path_);
}

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  StagedFile file(path);
  file.Write(content);
  file.Commit();
}

void ProbeFile(const std::filesystem::path& path) { StagedFile(path).Write("probe"); }

}  // namespace hullslam
