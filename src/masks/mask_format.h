// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_probe.h"

namespace hullslam {

// A format of mask files. Each format has its own file, which defines one constant of this type.
// The table in open_masks.cc lists all formats.
struct MaskFormat {
  std::string_view name;  // the name of --masks-format
  // How the format is recognised if its name is not given: a folder by its files, a JSON file by
  // its keys. A format is a folder or a file and sets only one of the two.
  bool (*is_meant)(const MaskProbe& folder) = nullptr;
  std::span<const std::string_view> json_keys = {};  // one of them comes first in the file
  std::unique_ptr<MaskSource> (*open)(const MaskRequest& request) = nullptr;
};

// MaskFormat::open of a class that is made from the request.
template <typename Masks>
std::unique_ptr<MaskSource> OpenAs(const MaskRequest& request) {
  return std::make_unique<Masks>(request);
}

}  // namespace hullslam
