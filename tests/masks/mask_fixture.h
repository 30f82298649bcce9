// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/masks/open_masks.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {

// Masks in a temporary folder, for images of 640x480 px and two frames, "1.5" and "2.5".
class MaskFixture : public ::testing::Test {
 protected:
  explicit MaskFixture(std::string format) : format_(std::move(format)) {}

  // A path in the folder "masks", or the folder itself if `name` is empty.
  std::filesystem::path Path(const std::string& name = "") const {
    return name.empty() ? folder_.path() / "masks" : folder_.path() / "masks" / name;
  }
  void Write(const std::string& name, std::string_view content) const {
    folder_.Write("masks/" + name, content);
  }
  std::unique_ptr<const MaskSource> Open(const std::string& name = "") const {
    return OpenMasks({.path = Path(name), .format = format_, .width = 640, .height = 480}, frames_);
  }
  FrameMasks ReadFrame(size_t frame, const std::string& name = "") const {
    return Open(name)->Read(frames_.at(frame));
  }
  void ExpectRefusal(const std::vector<std::string>& parts, const std::string& name = "") const {
    ExpectInputError([&] { CheckMasks(*Open(name), frames_); }, parts);
  }

  static double Area(const std::vector<Eigen::Vector2d>& outline) {
    double twice = 0.0;
    for (size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d& next = outline[(i + 1) % outline.size()];
      twice += outline[i].x() * next.y() - outline[i].y() * next.x();
    }
    return std::abs(twice) / 2.0;
  }

  TemporaryFolder folder_;
  std::string format_;
  std::vector<MaskFrame> frames_ = {{"1.5", 0}, {"2.5", 1}};
};

}  // namespace hullslam
