// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/masks/mask_source.h"

namespace hullslam {

// Facts about the files at a path. From these each format decides whether the files have this
// format. If some files of a folder have the names of frames, the others do not count: lists of
// labels, notes and the like.
struct MaskProbe {
  std::filesystem::path path;
  bool is_folder = false;
  // For a folder: the columns of the first line found in a text file other than classes.txt, and
  // their number. Lines with a few columns only, as networks write them for masks without area,
  // count if there are no others. `row` has only the first columns if there are very many.
  std::vector<std::string> row;
  size_t columns = 0;
  size_t texts = 0;         // text files other than classes.txt
  std::string row_file;     // the name of the text file with that line
  bool has_images = false;  // has PNG files
  size_t jsons = 0;         // JSON files other than classes.json
  bool has_classes_json = false;
  bool has_names_of_frames = false;  // files are named as frames, and only they count
  bool has_paper_folder = false;     // has a folder segmentation_txt
  std::string json_key;              // for a file: the one of the given keys that comes first
};

// Searches a file for the keys. Throws InputError if the path does not exist or cannot be read.
MaskProbe ProbeMasks(const std::filesystem::path& path,
                     std::span<const std::string_view> json_keys = {},
                     std::span<const MaskFrame> frames = {});

// Says why no format fits and what the user can do. The text continues a message, so it begins with
// a small letter. `json_keys` describes the keys of all formats. Throws InputError if the file is
// not JSON.
std::string DescribeMisfit(const MaskProbe& probe, const std::string& json_keys);

// Whether all numbers of the row, from the column with index `column` on, are between 0 and 1 up to
// rounding. The last one may also be the number of a track.
bool IsNormalized(const MaskProbe& probe, size_t column);

}  // namespace hullslam
