// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace hullslam {
class StagingFolder;
}  // namespace hullslam

namespace hullslam::synthetic {

// A folder that is written under a temporary name next to its final place, and moved there when it
// is complete.
class OutputSwap {
 public:
  // Throws InputError if the folder cannot be created, or if `folder` exists and is not empty. With
  // `force` it may contain an earlier synthetic sequence, but nothing else.
  OutputSwap(const std::filesystem::path& folder, bool force);
  // Removes the temporary folder if it was not moved.
  ~OutputSwap();
  OutputSwap(const OutputSwap&) = delete;
  OutputSwap& operator=(const OutputSwap&) = delete;

  const std::filesystem::path& working_folder() const { return working_; }
  void WriteFile(const std::filesystem::path& relative, const std::string& content) const;
  // Moves the finished folder to its place. A replaced folder is removed afterwards.
  void Commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path working_;
  std::unique_ptr<StagingFolder> staging_;
};

}  // namespace hullslam::synthetic
