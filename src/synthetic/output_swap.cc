// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/output_swap.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "hullslam/util/error.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

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

fs::path Beside(const fs::path& folder, const std::string& what) {
  return folder.parent_path() /
         fmt::format(".{}.{}-{}", folder.filename().string(), what, getpid());
}

}  // namespace

OutputSwap::OutputSwap(const fs::path& folder, bool force) {
  try {
    folder_ = fs::weakly_canonical(fs::absolute(folder));
    if (folder_.filename().empty()) {
      folder_ = folder_.parent_path();  // the path ended in a slash
    }
    CheckReplaceable(folder_, force);
    working_ = Beside(folder_, "partial");
    fs::remove_all(working_);
    fs::create_directories(working_);
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be written: " + error.code().message());
  }
}

OutputSwap::~OutputSwap() {
  std::error_code ignored;  // after Commit() there is nothing to remove
  fs::remove_all(working_, ignored);
}

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
  const fs::path former = Beside(folder_, "former");
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
  if (replaces) {
    fs::remove_all(former, error);
  }
}

}  // namespace hullslam::synthetic
