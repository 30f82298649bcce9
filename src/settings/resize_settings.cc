// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/resize_settings.h"

#include <fmt/format.h>

#include <cmath>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "hullslam/util/option_table.h"
#include "util/text.h"

namespace hullslam {
namespace {

double NumberIn(const Range& range, const std::string& key, const std::string& text,
                const std::string& origin) {
  double value = 0.0;
  if (!ParseFinite(text, value) || !range.Contains(value)) {
    throw InputError(fmt::format("{}: {} is '{}', expected a number {}", origin, key,
                                 ShowText(text), range.ToString()));
  }
  return value;
}

}  // namespace

bool ResizeSettings::Take(const std::string& key, const std::string& text,
                          const std::string& origin) {
  const bool is_width = key == "Camera.newWidth";
  if (is_width || key == "Camera.newHeight") {
    const double value = NumberIn(Range::Between(16, 16384), key, text, origin);
    (is_width ? width_ : height_) = static_cast<int>(std::lround(value));
    return true;
  }
  if (key == "Camera.imageScale") {
    scale_ = NumberIn(Range::Between(0.01, 10.0), key, text, origin);
    return true;
  }
  return false;
}

bool ResizeSettings::Changes(const PinholeCamera& camera) const {
  const PinholeCamera resized = Resized(camera);
  return resized.width != camera.width || resized.height != camera.height;
}

PinholeCamera ResizeSettings::Resized(const PinholeCamera& camera) const {
  if (scale_ && (width_ || height_)) {
    throw InputError(
        "settings: Camera.imageScale is given beside Camera.newWidth or Camera.newHeight, expected "
        "only one of them");
  }
  PinholeCamera resized = camera;
  if (scale_) {
    resized.width = static_cast<int>(std::lround(camera.width * *scale_));
    resized.height = static_cast<int>(std::lround(camera.height * *scale_));
  } else {
    resized.width = width_.value_or(camera.width);
    resized.height = height_.value_or(camera.height);
  }
  const double x = static_cast<double>(resized.width) / camera.width;
  const double y = static_cast<double>(resized.height) / camera.height;
  resized.fx *= x;
  resized.fy *= y;
  resized.cx = (camera.cx + 0.5) * x - 0.5;
  resized.cy = (camera.cy + 0.5) * y - 0.5;
  resized.bf *= x;
  return resized;
}

}  // namespace hullslam
