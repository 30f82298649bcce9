// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hullslam/util/cancellation.h"

namespace hullslam {

// Lets SIGINT and SIGTERM ask for an end instead of ending the program; the second one ends it.
void CatchInterrupts();
const Cancellation& Interruption();
bool IsInterrupted();

}  // namespace hullslam
