// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/correction.h"

namespace hullslam {

CorrectionOutcome ApplyCorrection(Map&, const MapCorrection&, const ScaleLevels&) { return {}; }

}  // namespace hullslam
