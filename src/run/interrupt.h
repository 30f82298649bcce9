// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/cancellation.h"

namespace hullslam {

// From now on SIGINT, SIGTERM and SIGHUP do not end the program, but request that it stops early
// and writes what it has. Further signals change nothing, so they cannot destroy the results while
// they are written. A signal that the caller of the program ignores, as nohup does, stays ignored.
void CatchInterrupts();
// The request that the signals make.
const Cancellation& Interruption();
bool IsInterrupted();

}  // namespace hullslam
