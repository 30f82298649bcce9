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

// Prints what a run of SLAM has found.
void PrintReport(const RunArguments& arguments, const RunSummary& summary,
                 const ObjectReport& objects);

// Why a run of `given` frames has failed although it came to its end; empty if it has not. `frames`
// are those that were tracked or lost.
std::string DescribeLoss(const RunArguments& arguments, const RunOptions& options, size_t given,
                         const RunSummary& summary, std::span<const TrackedFrame> frames);

}  // namespace hullslam
