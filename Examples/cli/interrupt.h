// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// Lets SIGINT and SIGTERM ask for an end instead of ending the program; the second one ends it.
void CatchInterrupts();
bool IsInterrupted();

}  // namespace hullslam
