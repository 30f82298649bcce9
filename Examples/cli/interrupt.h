// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/cancellation.h"

namespace hullslam {

// From now on SIGINT and SIGTERM do not end the program, but request that it stops early. A second
// signal of the same kind ends it.
void CatchInterrupts();
// The request that the signals make.
const Cancellation& Interruption();
bool IsInterrupted();

}  // namespace hullslam
