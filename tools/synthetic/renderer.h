// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"
#include "synthetic/ray_caster.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// The images of an ideal camera, all of the same size. The centre of a pixel has integer
// coordinates.
struct RenderedFrame {
  cv::Mat colour;  // CV_32FC3, BGR, 0 to 255, edges smoothed by four rays per pixel
  // CV_32FC1, metres at the centre of the pixel: along z, or along the ray of a fisheye lens.
  cv::Mat depth;
  cv::Mat instance;  // CV_16SC1, index in Scene::objects, -1 for the background
  cv::Mat cosine;    // CV_32FC1, of the angle between surface normal and ray
  // CV_32FC1, cosine of the angle between the ray of a fisheye lens and the axis; else empty.
  cv::Mat axial = {};
};

// Renders frames of a scene. Several threads may render at the same time. Each frame has the same
// bits in every run.
class Renderer {
 public:
  // Keeps a reference to `scene`. Any lens is rendered exactly. `readout_time`: seconds from
  // the exposure of the top row of an image to that of the bottom row (rolling shutter).
  Renderer(const Scene& scene, const PinholeCamera& camera, double readout_time = 0.0);

  // `time` is that of the middle row. Objects stand still while the rows are exposed.
  RenderedFrame Render(double time) const;

 private:
  struct Eye;       // pose of the camera while some rows are exposed
  struct View;      // poses during one frame
  struct Fragment;  // the point that a ray hits
  // World frame; of length 1 along z, with a fisheye lens of length 1.
  Eigen::Vector3f Direction(const Eye& eye, float x, float y) const;
  Fragment Shade(const View& view, const Eye& eye, int part, float distance,
                 const Eigen::Vector3f& direction, int max_samples) const;
  View MakeView(double time) const;
  void RenderBlock(const View& view, int x0, int y0, RenderedFrame& frame, cv::Mat& facet) const;
  void RenderCentres(const View& view, RenderedFrame& frame, cv::Mat& facet) const;
  void SmoothEdges(const View& view, const cv::Mat& facet, RenderedFrame& frame) const;
  // Colour of `material` at a point. Point, normal and direction of the ray are given in the frame
  // of the part. Slanted surfaces use up to `max_samples` samples of the texture.
  Eigen::Vector3f TextureColour(const Material& material, const Eigen::Vector3f& point,
                                const Eigen::Vector3f& normal, const Eigen::Vector3f& direction,
                                float distance, int max_samples) const;

  const Scene& scene_;
  PinholeCamera camera_;
  double largest_angle_ = 0.0;  // of a fisheye lens
  double readout_time_;
  RayCaster caster_;
};

}  // namespace hullslam::synthetic
