// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/open_network.h"

#include "util/components.h"

namespace hullslam {

std::unique_ptr<Network> OpenNetwork(std::string_view /*bytes*/) {
  RequireComponent("SEGMENTATION", "a network was to make masks");
  return nullptr;
}

}  // namespace hullslam
