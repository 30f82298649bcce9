// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <iostream>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/frame/mask_image.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/known_pose_mapper.h"
#include "hullslam/system/relocaliser.h"
#include "hullslam/system/system.h"
#include "support/paths.h"
#include "support/plane_sequence.h"

// The names that the C++ examples of the documents use without declaring them. Each example runs in
// a folder of its own, which has the files that the examples read.
class DocsExample : public testing::Test {
 protected:
  DocsExample() {
    std::filesystem::copy_file(hullslam::SourceFolder() / "config" / "TUM1.yaml",
                               folder_.path() / "TUM1.yaml");
    std::filesystem::create_directory_symlink(sequence_.path(),
                                              folder_.path() / "rgbd_dataset_freiburg1_xyz");
    std::filesystem::current_path(folder_.path());
    const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(sequence_.path());
    for (const hullslam::FramePaths& frame : sequence.frames) {
      stamps.push_back(frame.timestamp);
      images.push_back(cv::imread(frame.image.string()));
      depths.push_back(cv::imread(frame.depth.string(), cv::IMREAD_UNCHANGED));
      cv::Mat right;  // 12 columns to the right: all things look equally far away
      cv::copyMakeBorder(images.back().colRange(12, images.back().cols), right, 0, 0, 0, 12,
                         cv::BORDER_REPLICATE);
      right_images.push_back(right);
      masks.push_back(masks_);
      const double x = 0.01 * static_cast<double>(poses.size());  // m, as in the sequence
      poses.push_back({Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0)});
      inputs.push_back(sequence.load(frame, options.camera));
      system.Track(inputs.back());
    }
  }
  ~DocsExample() override { std::filesystem::current_path(before_); }

 private:
  static hullslam::SystemOptions MakeOptions(const std::filesystem::path& sequence) {
    hullslam::SystemOptions made = hullslam::ReadSettings(sequence / "camera.yaml");
    made.vocabulary = std::make_shared<const hullslam::Vocabulary>(
        hullslam::ReadVocabulary(hullslam::FindDefaultVocabulary()));
    return made;
  }

  const std::filesystem::path before_ = std::filesystem::current_path();
  const hullslam::TemporaryFolder folder_;
  const hullslam::PlaneSequence sequence_;
  const std::vector<hullslam::InstanceMask> masks_ = {
      {.label = "cup",
       .outlines = {{{250.0, 180.0}, {390.0, 180.0}, {390.0, 300.0}, {250.0, 300.0}}}}};

 protected:
  hullslam::SystemOptions options = MakeOptions(sequence_.path());
  hullslam::System system{options, hullslam::PipelineKind::kSequential};  // has tracked all frames
  // One entry per frame.
  std::vector<double> stamps;
  std::vector<cv::Mat> images;
  std::vector<cv::Mat> depths;
  std::vector<cv::Mat> right_images;
  std::vector<std::vector<hullslam::InstanceMask>> masks;
  std::vector<hullslam::Rigid3> poses;  // world_from_cam
  std::vector<hullslam::ImageInput> inputs;
};
