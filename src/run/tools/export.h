// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The program `export`: writes a run or a map in a format of other programs (docs/exports.md). Its
// exit code. Throws InputError for bad usage or input.
int RunExport(int argc, char** argv);

}  // namespace hullslam
