// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/paths.h"
#include "files/staged_file.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Names = std::set<std::string>;

constexpr const char* kPrefix = ".hullslam-";  // prefix of the names of staging folders
constexpr const char* kReady =
    "ready";  // name of the folder with the files of a complete run, inside a staging folder
constexpr std::array<const char*, 2> kIndexes = {"summary.json", "pictures.json"};
// What other programs make of a run: the pictures of scripts/plot_run.py, the report and the
// surface of `hullslam mesh`. They are removed together with the files of the run.
constexpr std::array<const char*, 4> kDrawnNames = {"run.png", "overlays.png", "report.html",
                                                    kSurfaceFile};

bool IsPlainName(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

// The kind of a path that is no link. Only this program writes to a staging folder, and it makes
// no links there. They would lead to files of others, which must stay as they are.
fs::file_type TypeOf(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type();
}

// The content of an index; null if there is none.
nlohmann::json ReadIndex(const fs::path& index) {
  std::error_code error;
  constexpr uintmax_t kMostBytes = 64'000'000;
  if (!fs::is_regular_file(index, error) || fs::file_size(index, error) > kMostBytes) {
    return nullptr;
  }
  std::ifstream file(index);
  return nlohmann::json::parse(file, nullptr, false);
}

// The names of the files of the run with this index, and of what was drawn of it. Empty if there is
// no such index, or if no run wrote it.
Names NamesOfRun(const fs::path& index) {
  const nlohmann::json json = ReadIndex(index);
  if (!json.is_object()) {
    return {};
  }
  Names names(kDrawnNames.begin(), kDrawnNames.end());
  names.insert(index.filename().string());
  if (!json.contains("files") || !json["files"].is_array()) {
    return {};
  }
  for (const nlohmann::json& name : json["files"]) {
    if (name.is_string() && IsPlainName(name.get<std::string>())) {
      names.insert(name.get<std::string>());
    }
  }
  return names;
}

void CreateFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": cannot be used as output folder: " +
                     (error ? error.message() : "it is a file"));
  }
}

// Refuses a folder with files that no run wrote, because they would be lost or mixed with files of
// the run.
void CheckEntries(const fs::path& folder, const std::string& index) {
  const Names of_run = NamesOfRun(folder / index);
  const std::vector<std::string> kept = OutputFolder::KeptNames();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPrefix) || std::ranges::count(kept, name) > 0) {
      continue;
    }
    if (!of_run.contains(name)) {
      throw InputError(fmt::format(
          "{}: cannot be used as output folder: it contains '{}', which is not from a former run; "
          "choose an empty or a new folder",
          folder.string(), name));
    }
    if (!entry.is_regular_file()) {
      throw InputError(entry.path().string() + ": cannot be written: it is not a regular file");
    }
  }
}

// Refuses to replace the run of another program. Runs of versions that did not say their program
// may be replaced.
void CheckOwner(const fs::path& index, const OutputOwner& owner) {
  const nlohmann::json json = ReadIndex(index);
  const nlohmann::json::json_pointer key("/provenance/program");
  if (owner.program.empty() || owner.may_replace_others || !json.contains(key) ||
      !json[key].is_string()) {
    return;
  }
  const auto former = json[key].get<std::string>();
  if (former != owner.program) {
    throw InputError(
        fmt::format("{}: has a run of {}, which this run of {} would replace; choose another "
                    "folder with --output, or give --overwrite",
                    index.parent_path().string(), ShowText(former), owner.program));
  }
}

void Move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be written: {}; the results of the run are in {}",
                                 to.string(), error.message(), from.parent_path().string()));
  }
}

// Moves the files of a run from the folder `ready` to the output folder and removes files of the
// former run. If it is interrupted, it can be called again: the former index is removed before any
// file is replaced, and the new one is moved last.
void MoveFiles(const fs::path& ready, const fs::path& folder) {
  const auto* const found = std::ranges::find_if(
      kIndexes, [&](const char* name) { return TypeOf(ready / name) == fs::file_type::regular; });
  if (found == kIndexes.end()) {
    return;  // the index is moved last, so all files have been moved
  }
  const fs::path index = *found;
  Names names = NamesOfRun(ready / index);
  for (const char* const name : kDrawnNames) {
    names.erase(name);
  }
  for (const std::string& former : NamesOfRun(folder / index)) {
    if (!names.contains(former)) {
      std::error_code ignored;
      fs::remove(folder / former, ignored);
    }
  }
  std::error_code ignored;
  fs::remove(folder / index, ignored);
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(ready)) {
    if (entry.path().filename() != index && TypeOf(entry.path()) == fs::file_type::regular) {
      files.push_back(entry.path());
    }
  }
  for (const fs::path& file : files) {
    Move(file, folder / file.filename());
  }
  Move(ready / index, folder / index);
}

// Moves the remaining files of runs that were killed while they moved them, and removes the files
// of runs that were killed before.
void CleanUp(const fs::path& folder) {
  for (StagingFolder& abandoned : StagingFolder::Abandoned(folder, kPrefix)) {
    const fs::path ready = abandoned.path() / kReady;
    if (TypeOf(ready) == fs::file_type::directory) {
      abandoned.Keep();  // if a file cannot be moved, the results stay where they are
      MoveFiles(ready, folder);
      abandoned.Remove();
    }
  }
}

}  // namespace

void CheckApartFromInputs(const fs::path& folder, std::span<const fs::path> inputs) {
  for (const fs::path& path : inputs) {
    std::error_code error;
    if (path.empty()) {
      continue;
    }
    if (IsSameOrInside(path, folder)) {
      throw InputError(
          fmt::format("{}: cannot be used as output folder: it contains {}, which this run reads",
                      folder.string(), path.string()));
    }
    if (fs::is_directory(CanonicalPath(path), error) && IsSameOrInside(folder, path)) {
      throw InputError(
          fmt::format("{}: cannot be used as output folder: it is inside {}, which this run reads",
                      folder.string(), path.string()));
    }
  }
}

OutputFolder::OutputFolder(const fs::path& folder, std::string index,
                           std::span<const fs::path> inputs, const OutputOwner& owner)
    : folder_(folder), index_(std::move(index)) {
  Check(std::ranges::find(kIndexes, index_) != kIndexes.end(), "this index is not known");
  CheckApartFromInputs(folder, inputs);
  CreateFolder(folder);
  try {
    const FolderLock lock(folder);
    CleanUp(folder);
    CheckEntries(folder, index_);
    CheckOwner(folder / index_, owner);
    staging_ = std::make_unique<StagingFolder>(folder, kPrefix);
    const fs::path probe = staging_->content() / "probe";
    WriteSyncedFile(probe, "probe", folder / index_);
    fs::remove(probe);
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() +
                     ": cannot be used as output folder: " + error.code().message());
  }
}

OutputFolder::~OutputFolder() = default;

void OutputFolder::Write(const FileContent& file) {
  Check(staging_ != nullptr && IsPlainName(file.name), "a file of a run needs a plain name");
  WriteSyncedFile(staging_->content() / file.name, file.content, folder_ / file.name);
  names_.push_back(file.name);
}

void OutputFolder::Commit() {
  Check(staging_ != nullptr && std::ranges::count(names_, index_) == 1,
        "the index of a run has not been written");
  try {
    const FolderLock lock(folder_);
    const fs::path ready = staging_->path() / kReady;
    fs::rename(staging_->content(), ready);
    staging_->Keep();
    MoveFiles(ready, folder_);
    staging_->Remove();
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder_.string() + ": cannot be written: " + error.code().message());
  }
  staging_.reset();
}

std::vector<std::string> OutputFolder::KeptNames() { return {"log.txt"}; }

}  // namespace hullslam
