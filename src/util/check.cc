// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/check.h"

#include <string>

namespace hullslam::internal {

void FailCheck(std::string_view what, const std::source_location& where) {
  throw CheckError(std::string(where.file_name()) + ":" + std::to_string(where.line()) + ": " +
                   std::string(what));
}

}  // namespace hullslam::internal
