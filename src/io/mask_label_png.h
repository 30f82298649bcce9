// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/io/mask_source.h"
#include "io/mask_probe.h"

namespace hullslam {

// label-png: `<stem>.png` with an instance's number in each of its pixels, 16 bit, 0 for none, and
// classes.json that says what they are: {"1": "cup", "2": {"class": "tv", "score": 0.9}} for all
// frames and, before that, {"frames": {"<stem>": {"1": "mouse"}}} for one.
bool IsLabelPng(const MaskProbe& probe);
std::unique_ptr<MaskSource> OpenLabelPng(const MaskRequest& request);

}  // namespace hullslam
