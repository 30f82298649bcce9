// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "view/view_model.h"

namespace hullslam {

inline constexpr size_t kMostReportBytes = 20'000'000;

// Thins the model until its message has at most so many bytes: of the part that takes most, every
// second entry is left out, again and again. Notes of the model say what was thinned.
void ThinToFit(size_t most_bytes, ViewModel& model);

}  // namespace hullslam
