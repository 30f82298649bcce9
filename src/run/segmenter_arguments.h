// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/segmentation/segmenter.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds the options of a network: --names, --classes, --min-score, --size, --threads and --boxes.
// `options` must outlive the app.
void AddSegmenterOptions(CLI::App& app, SegmenterOptions& options);

}  // namespace hullslam
