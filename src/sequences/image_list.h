// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// What the readers of sequences have in common. All throw InputError.

constexpr size_t kMostImages = 1'000'000;  // limit for the frames of a sequence

// Refuses a row with fewer than `count` columns. `names` are those of the columns, for the message.
void CheckColumns(const TextRow& row, size_t count, const char* names);

// The file of an image, which the list in `folder` names in a column.
std::filesystem::path ImageFile(const TextRow& row, size_t column,
                                const std::filesystem::path& folder);

// Adds a frame to those of a list. Refuses a stamp that does not come after the previous one, and
// more than kMostImages frames. The frame gets its index as its number.
void AddFrame(const TextRow& row, FramePaths frame, std::vector<FramePaths>& frames);

// Keeps the selected frames of the sequence; `available` becomes the number of all frames. The
// messages name the options --first, --last and --stride.
void SelectFrames(const std::filesystem::path& source, const FrameSelection& selection,
                  ImageSequence& sequence);

// The paths in a folder, sorted by name.
std::vector<std::filesystem::path> ListFolder(const std::filesystem::path& folder);

// If `folder` is one level too high or too low: "; did you mean FOLDER?" with the parent, or the
// only subfolder, that `is_sequence` accepts. Empty if there is no such folder, or more than one.
std::string SuggestFolder(const std::filesystem::path& folder,
                          const std::function<bool(const std::filesystem::path&)>& is_sequence);

// Refuses frames whose image, or whose depth image if there should be one, is no file.
void CheckImagesExist(const std::vector<FramePaths>& frames);

// Refuses an image that does not have the size of the camera. `name` is that of the image.
void CheckImageSize(const std::string& name, const cv::Mat& image, const PinholeCamera& camera);

}  // namespace hullslam
