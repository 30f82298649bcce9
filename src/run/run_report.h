// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "hullslam/map/messages.h"
#include "hullslam/system/options.h"
#include "report/object_report.h"
#include "results/summary.h"
#include "run/run_arguments.h"

namespace hullslam {

// Prints the results of a SLAM run.
void PrintReport(const RunArguments& arguments, const RunSummary& summary,
                 const ObjectReport& objects);

// Says why a run of `given` frames that came to its end counts as failed: too many frames were
// lost. Empty if it does not count as failed. `frames` are the tracked and the lost frames.
std::string DescribeLoss(const RunArguments& arguments, const RunOptions& options, size_t given,
                         const RunSummary& summary, std::span<const TrackedFrame> frames);

}  // namespace hullslam
