// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Prints `what` and whether it is good, and returns the latter.
bool Report(bool good, const char* what);

// Uses hullslam::core. Returns whether everything was as it should be.
bool CoreWorks();
