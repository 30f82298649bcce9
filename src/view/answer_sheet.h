// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "scene/answer.h"
#include "view/view_model.h"

namespace hullslam {

// One picture of several answers (CV_8UC3, blue first): a row per answer with its rank, class, id
// and score, and with the cut-outs of the object with the outline of its mask. An object without
// cut-outs has a row without them.
cv::Mat DrawAnswers(std::span<const Answer> answers, const ViewModel& model);

}  // namespace hullslam
