// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Functions that the readers of sequences share. All throw InputError.

constexpr size_t kMostImages = 1'000'000;  // limit for the frames of a sequence

// Refuses a row with fewer than `count` columns. `names` lists the names of the columns for the
// message.
void CheckColumns(const TextRow& row, size_t count, const char* names);

// The path of an image. A column of the row has its path relative to `folder`.
std::filesystem::path ImageFile(const TextRow& row, size_t column,
                                const std::filesystem::path& folder);

// The frames of a list, as far as they are used.
struct ListedFrames {
  std::vector<FramePaths> frames;
  size_t rows = 0;
  size_t repeated = 0;  // rows with the stamp of the row before
  size_t earlier = 0;   // rows whose stamp is before an earlier row's
  std::string fault;    // describes the first row that is not used
};

// Appends a frame to `list` and sets its number to its index. A frame whose stamp does not come
// after the previous one is only counted; returns whether it is used. Refuses more than kMostImages
// frames.
bool AddFrame(const TextRow& row, FramePaths frame, ListedFrames& list);
// The frames of a complete list. Describes the rows that are not used in one warning. Refuses a
// list without frames, and one with more than a tenth of its rows out of order, because this is no
// fault of single rows.
std::vector<FramePaths> TakeFrames(const std::filesystem::path& path, ListedFrames list,
                                   std::vector<std::string>& warnings);

// The mean number of images per second; `fallback` for a single stamp.
double MeanRate(const std::vector<FramePaths>& frames, double fallback);

// Keeps only the selected frames and sets `available` to the number of frames before. The messages
// name the options --first, --last and --stride.
void SelectFrames(const std::filesystem::path& source, const FrameSelection& selection,
                  ImageSequence& sequence);

// The paths in a folder, sorted by name.
std::vector<std::filesystem::path> ListFolder(const std::filesystem::path& folder);

// If `folder` is one level too high or too low: "; did you mean FOLDER?" with the parent, or the
// only subfolder, that `is_sequence` accepts. Empty if there is no such folder, or more than one.
std::string SuggestFolder(const std::filesystem::path& folder,
                          const std::function<bool(const std::filesystem::path&)>& is_sequence);

// Refuses a frame if the file of its image, of its depth image or of its right image is missing.
// The paths of the last two may be empty.
void CheckImagesExist(const std::vector<FramePaths>& frames);
// Leaves out frames of which a file is missing, with one warning. Refuses the sequence if they are
// more than a tenth.
void LeaveOutMissing(ImageSequence& sequence);

// Refuses an image that does not have the size of the camera. `name` names the image in the
// message.
void CheckImageSize(const std::string& name, const cv::Mat& image, const PinholeCamera& camera);

// Time stamps that differ by at most this much are of the same moment, s: files round them.
inline constexpr double kSameMoment = 1e-3;

// The frame of the sequence whose time stamp is nearest to this one; null if that is of another
// moment. It lives as long as the sequence.
const FramePaths* FindFrameAt(const ImageSequence& sequence, double timestamp);

// The image of a frame in colour, CV_8UC3 with blue first, in raw pixels. A grey image has three
// equal channels. To be called like ImageSequence::load. Throws InputError if the image cannot be
// read or does not have the size of the camera.
cv::Mat LoadColour(const ImageSequence& sequence, const FramePaths& frame,
                   const PinholeCamera& camera);

}  // namespace hullslam
