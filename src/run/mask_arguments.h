// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "hullslam/segmentation/segmenter.h"
#include "segmentation/sequence_masks.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds --masks and --masks-format, which write to `path` and `format`. Both must outlive the app.
void AddMaskArguments(CLI::App& app, std::filesystem::path& path, std::string& format);
// Adds --masks-right, after AddMaskArguments().
void AddRightMaskArgument(CLI::App& app, std::filesystem::path& path);
// Adds --mask-all, and with a stereo camera --mask-all-right.
void AddMaskAllArgument(CLI::App& app, std::filesystem::path& path);
void AddRightMaskAllArgument(CLI::App& app, std::filesystem::path& path);
// Adds --segment and --segment-every, after AddMaskArguments().
void AddNetworkArguments(CLI::App& app, std::filesystem::path& network, size_t& every);
// Adds the options of a network: --names, --classes, --min-score, --size, --threads and --boxes.
// `options` must outlive the app.
void AddSegmenterOptions(CLI::App& app, SegmenterOptions& options);
// Adds only the option for the format, under the given names, for programs that take the masks as a
// positional argument.
void AddMaskFormat(CLI::App& app, std::string& format, const std::string& names);

// The request for masks of the images of a sequence as they are read. `camera` is that of the
// images that the sequence gives. Throws InputError for a format without a path.
MaskRequest RequestOf(const std::filesystem::path& path, const std::string& format,
                      const ImageSequence& sequence, const PinholeCamera& camera);

}  // namespace hullslam
