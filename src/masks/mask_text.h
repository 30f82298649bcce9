// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/masks/mask_source.h"

namespace hullslam {

// The names, without `extension`, of all files with this extension in a folder. Throws InputError
// if the folder cannot be read.
std::set<std::string> ListFiles(const std::filesystem::path& folder, std::string_view extension);

// The base of all formats that are a folder with one text file per frame and one line per instance.
// Each format defines its own lines and file names.
class TextMasks : public MaskSource {
 public:
  explicit TextMasks(const MaskRequest& request);

  bool Contains(const MaskFrame& frame) const final;
  std::string Example() const final;
  FrameMasks Read(const MaskFrame& frame) const final;

 protected:
  virtual InstanceMask Parse(const TextRow& row) const = 0;
  // The name of the file of the frame, without its extension.
  virtual std::string FileName(const MaskFrame& frame) const { return frame.stem; }

  const MaskRequest& request() const { return request_; }
  // The class whose number is in a column of the row. Throws InputError for a number without a
  // class.
  const std::string& ClassName(const TextRow& row, size_t column) const;
  // The confidence in a column of the row. Throws InputError unless it is from 0 to 1.
  static double Score(const TextRow& row, size_t column);

 private:
  MaskRequest request_;
  std::vector<std::string> classes_;
  std::set<std::string> names_;
};

}  // namespace hullslam
