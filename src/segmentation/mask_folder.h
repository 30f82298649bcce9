// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

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

// The masks of a folder that are made or are to be made.
struct MaskFolderWork {
  size_t frames = 0;                             // that are asked for
  size_t done = 0;                               // that have a file now
  size_t made = 0;                               // by this call
  std::map<std::string, size_t> instances = {};  // by class, of this call
  std::vector<std::string> unread = {};          // faults of images without masks
  size_t failed = 0;                             // images that the network fails on
  std::string first_failure = {};
  // The frames that have no file yet, with its path. They are frames of the sequence.
  std::vector<std::pair<const FramePaths*, std::filesystem::path>> left = {};
};

// The work in a folder, of the first frame and every n-th frame after it.
MaskFolderWork FindMaskWork(const std::filesystem::path& folder, const ImageSequence& sequence,
                            size_t every);

// Makes the masks of one of the frames that are left. A frame without instances gets an empty file,
// so that the next call knows that it is done. A frame that the network fails on gets none.
void MakeMaskFile(const ImageSequence& sequence, size_t left, Segmenter& segmenter,
                  MaskFolderWork& work);

}  // namespace hullslam
