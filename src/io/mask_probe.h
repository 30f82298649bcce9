// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hullslam {

// What a path to masks looks like, from which each format tells whether it is meant.
struct MaskProbe {
  std::filesystem::path path;
  bool is_folder = false;
  // Of a folder: the columns of the first line that a text file beside classes.txt holds, as many
  // as are shown here, and their number.
  std::vector<std::string> row;
  size_t columns = 0;
  bool has_images = false;  // PNG files
  bool has_classes_json = false;
  bool has_paper_folder = false;  // segmentation_txt
  // Of a file: the first of the keys "annotations", "image_id" and "detections" in it.
  std::string json_key;
};

// Throws InputError where the path does not exist or cannot be read.
MaskProbe ProbeMasks(const std::filesystem::path& path);

// Whether all numbers of the row from `column` on lie within 0 and 1, but for rounding.
bool IsNormalized(const MaskProbe& probe, size_t column);

}  // namespace hullslam
