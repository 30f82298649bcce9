// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace hullslam::synthetic {

// A folder that is filled under a temporary name beside its place and moved there when complete.
class OutputSwap {
 public:
  // Throws InputError when `folder` exists and is not empty, unless `force` and it holds nothing
  // but a former synthetic sequence; or when it cannot be made.
  OutputSwap(const std::filesystem::path& folder, bool force);
  // Removes what was not moved.
  ~OutputSwap();
  OutputSwap(const OutputSwap&) = delete;
  OutputSwap& operator=(const OutputSwap&) = delete;

  const std::filesystem::path& working_folder() const { return working_; }
  void WriteFile(const std::filesystem::path& relative, const std::string& content) const;
  // Moves the finished folder to its place; what is replaced is removed afterwards.
  void Commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path working_;
};

}  // namespace hullslam::synthetic
