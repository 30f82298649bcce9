// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "features/extractor.h"
#include "frame/input_check.h"
#include "hullslam/camera/depth.h"
#include "hullslam/features/feature_set.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/frame/sensor.h"
#include "util/task_runner.h"

namespace hullslam {

// The depth (m) of the surface that a keypoint shows; 0 if it is unknown or if the keypoint is at
// the border of a surface. `bf` is that of the camera, and `scale` is that of the keypoint's level.
//
// A corner is found where the pixels on a circle around it are brighter or darker than it. So its
// centre may be 3 px of its level away from the border that it moves with, on another surface. Such
// a depth is wrong in every view of the keypoint, so its error does not average out, and the map
// gets a wrong scale. The disparity of a plane is linear in the image, so at two opposite points of
// the circle its mean is that at the centre. The keypoint is at a border where one of these means
// differs by more than the noise of depth explains. Opposite points of which one is unknown are not
// compared. With DepthErrorModel::kRightColumn, as of ORB-SLAM2, borders have a depth too.
float KeypointDepth(const cv::Mat& depth, const RawKeypoint& keypoint, double scale, double bf,
                    const DepthOptions& options);

// Where the depths of an image come from. There is one source for each kind of sensor: a depth
// image, the right image of a pair, or none.
class DepthSource {
 public:
  struct Features {
    ExtractedFeatures extracted;
    std::vector<float> depths;  // m, one per keypoint; 0 where unknown
  };

  virtual ~DepthSource() = default;

  // Throws InputError unless the sensor has the images that come with the grey one.
  virtual void CheckImages(const ImageInput& image) const = 0;
  // The features of the grey image with their depths. `ignored` are the pixels of the grey and of
  // the right image where no features are wanted, as in FeatureExtractor.
  virtual Features Extract(FeatureExtractor& extractor, const ImageInput& image,
                           const std::array<cv::Mat, 2>& ignored, TaskRunner& runner) = 0;
  // A depth image that is valid in the region, as in ImageInput; empty if there is none. `depths`
  // are those of the keypoints of the image.
  virtual cv::Mat DepthIn(const cv::Rect& region, const ImageInput& image,
                          std::span<const float> depths, TaskRunner& runner) const = 0;
};

// The source for a kind of sensor. `sensor` and `check`, which gets the pairs, must outlive it.
std::unique_ptr<DepthSource> MakeDepthSource(const Sensor& sensor, const DepthOptions& depth,
                                             const FeatureOptions& features, InputCheck& check);

// Throws InputError, which calls the image `name`, unless it has the size of that of the camera and
// is CV_8UC1.
void CheckGreyImage(const char* name, const cv::Mat& image, const PinholeCamera& camera);

// Throws InputError unless the depth image has the shape of the image of the camera and a type that
// ImageInput allows.
void CheckDepthImage(const cv::Mat& depth, const PinholeCamera& camera);

}  // namespace hullslam
