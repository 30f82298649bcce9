// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <mutex>
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

// Whether the text is a whole number above 0 without a decimal point, as the number of a track is.
bool IsTrackNumber(std::string_view text);

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
  virtual std::string FileName(const MaskFrame& frame) const;

  const MaskRequest& request() const { return request_; }
  // The class whose number is in a column of the row. Throws InputError for a number without a
  // class.
  const std::string& ClassName(const TextRow& row, size_t column) const;
  // The confidence in a column of the row. Throws InputError unless it is from 0 to 1.
  static double Score(const TextRow& row, size_t column);
  // Whether the last column of the row is the number of a track, as `yolo track` writes it behind
  // the outline (an even number of columns) or behind the confidence (an odd number). A line by
  // itself does not tell, because a coordinate, a confidence and a track may all be 1. So this
  // holds if the last columns of all lines of the folder with such a number of columns are whole
  // numbers above 0.
  bool HasTrack(const TextRow& row) const;

 private:
  // The answer for the even and for the odd numbers of columns; found when it is needed.
  struct TrackAnswer {
    std::once_flag once;
    bool has_tracks = false;
  };
  bool HaveTracks(bool is_odd) const;

  MaskRequest request_;
  std::vector<std::string> classes_;
  std::set<std::string> names_;
  mutable std::array<TrackAnswer, 2> tracks_;
};

}  // namespace hullslam
