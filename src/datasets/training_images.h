// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "hullslam/features/feature_options.h"
#include "hullslam/features/feature_set.h"
#include "util/task_runner.h"

namespace hullslam {

// The PNG and JPEG images among the arguments, which are files and folders, in this order. Those of
// a folder are sorted by name; its subfolders are not searched. Throws InputError for a folder
// without images.
std::vector<std::filesystem::path> ListTrainingImages(
    const std::vector<std::filesystem::path>& arguments);

// The descriptors of each image, from which a vocabulary is trained. `go_on` is told how many
// images are done; if it returns false, the last images are missing. Throws InputError for an image
// that cannot be read or is too small.
std::vector<std::vector<Descriptor>> ExtractDescriptors(
    const std::vector<std::filesystem::path>& paths, const FeatureOptions& features,
    TaskRunner& runner, const std::function<bool(size_t done)>& go_on);

}  // namespace hullslam
