// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/read_only_vfs.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// What SQLite knows as a file: it allocates szOsFile bytes and looks at the first member only.
struct VfsFile {
  sqlite3_file base;
  int descriptor;  // -1 for a log that does not exist
};

VfsFile& FileOf(sqlite3_file* file) { return *reinterpret_cast<VfsFile*>(file); }

int CloseFile(sqlite3_file* file) {
  if (FileOf(file).descriptor >= 0) {
    ::close(FileOf(file).descriptor);
  }
  return SQLITE_OK;
}

// SQLite expects zeros instead of bytes behind the end.
int ReadBytes(sqlite3_file* file, void* bytes, int count, sqlite3_int64 offset) {
  const int descriptor = FileOf(file).descriptor;
  auto* const begin = static_cast<char*>(bytes);
  auto left = static_cast<size_t>(count);
  while (left > 0 && descriptor >= 0) {
    const size_t filled = static_cast<size_t>(count) - left;
    const ssize_t read =
        ::pread(descriptor, begin + filled, left, offset + static_cast<sqlite3_int64>(filled));
    if (read < 0 && errno != EINTR) {
      return SQLITE_IOERR_READ;
    }
    if (read == 0) {
      break;
    }
    left -= static_cast<size_t>(std::max<ssize_t>(read, 0));
  }
  std::memset(begin + static_cast<size_t>(count) - left, 0, left);
  return left == 0 ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
}

int SizeOf(sqlite3_file* file, sqlite3_int64* size) {
  struct stat status {};
  if (FileOf(file).descriptor >= 0 && ::fstat(FileOf(file).descriptor, &status) != 0) {
    return SQLITE_IOERR_FSTAT;
  }
  *size = status.st_size;
  return SQLITE_OK;
}

sqlite3_io_methods MakeMethods() {
  sqlite3_io_methods methods{};
  methods.iVersion = 1;  // without shared memory
  methods.xClose = CloseFile;
  methods.xRead = ReadBytes;
  methods.xWrite = [](sqlite3_file*, const void*, int, sqlite3_int64) { return SQLITE_READONLY; };
  methods.xTruncate = [](sqlite3_file*, sqlite3_int64) { return SQLITE_READONLY; };
  methods.xSync = [](sqlite3_file*, int) { return SQLITE_OK; };
  methods.xFileSize = SizeOf;
  methods.xLock = [](sqlite3_file*, int) { return SQLITE_OK; };
  methods.xUnlock = [](sqlite3_file*, int) { return SQLITE_OK; };
  methods.xCheckReservedLock = [](sqlite3_file*, int* is_reserved) {
    *is_reserved = 0;
    return SQLITE_OK;
  };
  methods.xFileControl = [](sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; };
  methods.xSectorSize = [](sqlite3_file*) { return 4096; };
  methods.xDeviceCharacteristics = [](sqlite3_file*) { return 0; };
  return methods;
}

// O_NONBLOCK: opening a FIFO that no program writes to would wait for ever.
int OpenToRead(const char* path, int flags) {
  const int descriptor = ::open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | flags);
  struct stat status {};
  if (descriptor >= 0 && (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))) {
    ::close(descriptor);
    errno = EINVAL;
    return -1;
  }
  return descriptor;
}

int OpenFile(sqlite3_vfs*, const char* path, sqlite3_file* file, int flags, int* opened_flags) {
  static const sqlite3_io_methods methods = MakeMethods();
  if (path == nullptr) {
    sqlite3_vfs* const system = sqlite3_vfs_find(nullptr);
    return system->xOpen(system, path, file, flags, opened_flags);
  }
  file->pMethods = nullptr;  // then SQLite does not close the file
  const bool is_log = (flags & SQLITE_OPEN_WAL) != 0;
  if (!is_log && (flags & SQLITE_OPEN_MAIN_DB) == 0) {
    return SQLITE_CANTOPEN;
  }
  const int descriptor = OpenToRead(path, is_log ? O_NOFOLLOW : 0);
  if (descriptor < 0 && !(is_log && errno == ENOENT)) {
    return SQLITE_CANTOPEN;
  }
  FileOf(file) = {{&methods}, descriptor};
  if (opened_flags != nullptr) {
    *opened_flags = (flags & ~(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE)) | SQLITE_OPEN_READONLY;
  }
  return SQLITE_OK;
}

int DeleteNothing(sqlite3_vfs*, const char*, int) { return SQLITE_OK; }

// SQLite asks whether a log or a journal exists, and then opens it. Of both, only a log is known.
int FindLog(sqlite3_vfs*, const char* path, int, int* exists) {
  struct stat status {};
  const bool is_log = std::string_view(path).ends_with("-wal");
  *exists = is_log && ::lstat(path, &status) == 0 && status.st_size > 0 ? 1 : 0;
  return SQLITE_OK;
}

int KeepPath(sqlite3_vfs*, const char* path, int room, char* full) {
  const int length = std::snprintf(full, static_cast<size_t>(room), "%s", path);
  return length < room ? SQLITE_OK : SQLITE_CANTOPEN;
}

}  // namespace

const char* ReadOnlyVfs() {
  static sqlite3_vfs vfs = [] {
    const sqlite3_vfs* const system = sqlite3_vfs_find(nullptr);
    Check(system != nullptr, "SQLite has no functions for files");
    sqlite3_vfs made = *system;
    made.pNext = nullptr;
    made.zName = "hullslam_read_only";
    made.szOsFile = std::max(system->szOsFile, static_cast<int>(sizeof(VfsFile)));
    made.xOpen = OpenFile;
    made.xDelete = DeleteNothing;
    made.xAccess = FindLog;
    made.xFullPathname = KeepPath;
    return made;
  }();
  static const int code = sqlite3_vfs_register(&vfs, 0);
  Check(code == SQLITE_OK, "SQLite takes no functions for files");
  return vfs.zName;
}

}  // namespace hullslam
