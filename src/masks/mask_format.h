// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string_view>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_probe.h"

namespace hullslam {

// A format of mask files. Each format has its own file, which defines one constant of this type.
// The table in open_masks.cc lists all formats.
struct MaskFormat {
  std::string_view name;                     // the name of --masks-format
  bool (*is_meant)(const MaskProbe& probe);  // whether the files look like this format
  std::unique_ptr<MaskSource> (*open)(const MaskRequest& request);
};

}  // namespace hullslam
