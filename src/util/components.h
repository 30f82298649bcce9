// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace hullslam {

// Throws InputError unless this build has the component, such as "VIDEO" for HULLSLAM_WITH_VIDEO.
// `wish` is what the user asked for, the begin of the message: "--mcap" or "scan.mp4: is a video".
void RequireComponent(std::string_view component, std::string_view wish);

}  // namespace hullslam
