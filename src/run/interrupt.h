// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/cancellation.h"

namespace hullslam {

// From now on SIGINT, SIGTERM and SIGHUP do not end the program. Instead they request that it stops
// early and writes its results so far. Further signals change nothing, so they cannot destroy the
// results while they are written. A signal that was ignored when the program started (nohup does
// this) stays ignored.
void CatchInterrupts();
// Is requested when one of the signals arrives.
const Cancellation& Interruption();
bool IsInterrupted();

}  // namespace hullslam
