// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/output_swap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "files/staging_folder.h"
#include "hullslam/util/error.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormer = "former";  // the sequence that is replaced, in the staging folder

bool IsFormerSequence(const fs::path& folder) {
  constexpr std::array<std::string_view, 8> kWritten = {
      "rgb",       "depth",       "masks",           "rgb.txt",
      "depth.txt", "camera.yaml", "groundtruth.txt", "groundtruth_objects.json"};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (std::find(kWritten.begin(), kWritten.end(), entry.path().filename().string()) ==
        kWritten.end()) {
      return false;
    }
  }
  std::ifstream file(folder / "groundtruth_objects.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  return json.is_object() && json.contains("generator") && json["generator"] == "make_synthetic";
}

void CheckReplaceable(const fs::path& folder, bool force) {
  const fs::file_status status = fs::status(folder);
  if (!fs::exists(status)) {
    return;
  }
  if (!fs::is_directory(status)) {
    throw InputError(folder.string() + ": exists and is not a folder");
  }
  if (fs::is_empty(folder)) {
    return;
  }
  if (!IsFormerSequence(folder)) {
    throw InputError(
        folder.string() +
        ": is not empty and is not (only) a sequence of make_synthetic; choose another folder");
  }
  if (!force) {
    throw InputError(folder.string() + ": already contains a sequence; --force replaces it");
  }
}

// Staging folders of an output folder have names with this prefix, in the folder beside it.
std::string Prefix(const fs::path& folder) {
  return fmt::format(".{}.partial-", folder.filename().string());
}

// Removes what killed processes have left. If one was killed between the two moves of Commit(), its
// sequence is complete and is moved to its place.
void CleanUp(const fs::path& folder) {
  for (const StagingFolder& abandoned :
       StagingFolder::Abandoned(folder.parent_path(), Prefix(folder))) {
    if (fs::exists(abandoned.path() / kFormer) && !fs::exists(folder)) {
      fs::rename(abandoned.content(), folder);
    }
  }
}

}  // namespace

OutputSwap::OutputSwap(const fs::path& folder, bool force) {
  try {
    folder_ = fs::weakly_canonical(fs::absolute(folder));
    if (folder_.filename().empty()) {
      folder_ = folder_.parent_path();  // the path ended in a slash
    }
    CleanUp(folder_);
    CheckReplaceable(folder_, force);
    fs::create_directories(folder_.parent_path());
    staging_ = std::make_unique<StagingFolder>(folder_.parent_path(), Prefix(folder_));
    working_ = staging_->content();
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be written: " + error.code().message());
  }
}

OutputSwap::~OutputSwap() = default;

void OutputSwap::WriteFile(const fs::path& relative, const std::string& content) const {
  const fs::path path = working_ / relative;
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    throw InputError((folder_ / relative).string() + ": cannot be written; is the disk full?");
  }
}

void OutputSwap::Commit() {
  const fs::path former = staging_->path() / kFormer;
  const bool replaces = fs::exists(folder_);
  std::error_code error;
  if (replaces) {
    fs::rename(folder_, former, error);
  }
  if (!error) {
    fs::rename(working_, folder_, error);
    if (error && replaces) {
      std::error_code ignored;  // only the first error is reported
      fs::rename(former, folder_, ignored);
    }
  }
  if (error) {
    throw InputError(folder_.string() + ": cannot be moved to its place: " + error.message());
  }
  staging_.reset();  // removes the former sequence
}

}  // namespace hullslam::synthetic
