// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/check.h"

#include <string>

namespace hullslam::internal {

void FailCheck(std::string_view what, const char* file, int line) {
  throw CheckError(std::string(file) + ":" + std::to_string(line) + ": " + std::string(what));
}

}  // namespace hullslam::internal
