// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/staged_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "files/staging_folder.h"
#include "files/synced_file.h"
#include "hullslam/util/error.h"

namespace hullslam {
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
}

}  // namespace hullslam
