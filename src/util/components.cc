// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/components.h"

#include <string>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// The names of the components of this build, each between two blanks.
constexpr std::string_view kComponents = " " HULLSLAM_COMPONENTS " ";

}  // namespace

void RequireComponent(std::string_view component, std::string_view wish) {
  const std::string name(component);
  if (kComponents.find(" " + name + " ") == std::string_view::npos) {
    throw InputError(std::string(wish) + ", but this HullSLAM was built without the component " +
                     name + " (expected: cmake -D HULLSLAM_WITH_" + name + "=ON)");
  }
}

}  // namespace hullslam
