// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include "hullslam/masks/mask_source.h"

namespace hullslam {

// The folder in which the vectors of masks are: the masks' folder or, for a JSON file, the folder
// with its name without ".json".
std::filesystem::path EmbeddingFolder(const std::filesystem::path& masks);

// Adds to each mask its vector, if there is a file `<stem>.npy` of the frame: row i belongs to
// instance i of the frame in the mask file (groups of objects are not counted). A frame without
// such a file has no vectors. Returns `source` itself if no frame has one. Reading a frame throws
// InputError for a file that ReadNpy() refuses, another number of rows than instances, vectors of
// another length than in the first of these files, and a vector of zeros.
std::unique_ptr<const MaskSource> AddEmbeddings(std::unique_ptr<const MaskSource> source,
                                                const std::filesystem::path& folder,
                                                std::span<const MaskFrame> frames);

}  // namespace hullslam
