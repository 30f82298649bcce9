// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

struct SegmenterOptions {
  double min_score = 0.25;                // instances with a lower score are left out, 0 to 1
  std::vector<std::string> classes = {};  // only instances of these are given; empty: of all
  // A file with the name of one class per line. Empty: the names are in the file of the network.
  std::filesystem::path names = {};
  // The longer side of the image that the network sees, px; 0: as the network's input, or 640
  // if the network takes any size.
  int size = 0;
  // Threads with which OpenCV runs the network; 0: as many as this program has set (OpenCV takes
  // one per core).
  int threads = 0;
  bool use_boxes = false;  // accept a network that finds boxes but no masks
};

// A network for instance segmentation that makes masks of images: YOLOv8-seg, YOLO11-seg or
// YOLOv5-seg in a file of ONNX. docs/segmentation.md tells how to get one. OpenCV runs it, in a
// program of its own that this object starts and ends, so a network with which OpenCV crashes is an
// error and no crash.
class Segmenter {
 public:
  // Reads the network and runs it once. Throws InputError, with the shapes of its outputs if it
  // is a network of another kind, and if HullSLAM was built without HULLSLAM_WITH_SEGMENTATION.
  explicit Segmenter(const std::filesystem::path& network, const SegmenterOptions& options = {});
  ~Segmenter();
  Segmenter(const Segmenter&) = delete;
  Segmenter& operator=(const Segmenter&) = delete;

  // The instances in an image (CV_8UC3 or CV_8UC4 with blue first, or CV_8UC1), best score first,
  // in its pixels. Each has one outline, around its largest part. The same image gives the same
  // bits. To be called by one thread at a time. Throws InputError if the network cannot be run on
  // this image, or gives values that are not finite; then this image has no masks, and others can
  // be tried.
  std::vector<InstanceMask> Segment(const cv::Mat& image);

  // The names of the classes by their numbers.
  const std::vector<std::string>& class_names() const;
  const std::string& network_hash() const;  // XXH3 of the file, 16 hexadecimal digits
  bool gives_boxes() const;                 // the instances are boxes (SegmenterOptions::use_boxes)
  std::string Describe() const;  // "yolo.onnx: YOLOv8 or YOLO11 before decoding, 80 classes, ..."

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace hullslam
