// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/datasets/dataset.h"
#include "hullslam/segmentation/segmenter.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// What the masks of a folder are made of.
struct SegmentSource {
  const std::filesystem::path& input;
  const DatasetChoices& choices;
  const ImageSequence& sequence;  // of the input
  const std::filesystem::path& network;
  const SegmenterOptions& options;
  const Segmenter& segmenter;
};

inline constexpr const char* kClassNames = "classes.txt";

// Makes the folder with a record of this (segment.json) and the names of the classes (kClassNames).
// A folder with the record of a former call is used again. Throws InputError for one with masks of
// another input or network, or made with other options, because they would be mixed, and for one
// with other files. What a killed call has left is no such file.
void PrepareMaskFolder(const std::filesystem::path& folder, const SegmentSource& source);

}  // namespace hullslam
