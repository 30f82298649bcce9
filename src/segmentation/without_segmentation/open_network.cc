// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/open_network.h"

#include "util/components.h"

namespace hullslam {

std::unique_ptr<Network> OpenNetwork(std::string /*bytes*/, int /*threads*/) {
  RequireComponent("SEGMENTATION", "masks are to be made");
  return nullptr;
}

}  // namespace hullslam
