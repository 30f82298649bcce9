// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "datasets/view_images.h"
#include "frame/detection/detection_builder.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/segmentation/network_masks.h"
#include "results/summary.h"

namespace hullslam {

// The masks of a sequence. The constructor checks all of them. If the path is empty, there are no
// masks.
class SequenceMasks {
 public:
  // Throws InputError if OpenMasks() or CheckMasks() refuses the masks.
  SequenceMasks(const MaskRequest& request, std::vector<MaskFrame> frames);
  // Masks that are made when they are read.
  SequenceMasks(std::unique_ptr<const NetworkMasks> network, std::vector<MaskFrame> frames);

  // Adds the masks of the right images of a stereo camera.
  void AddRight(const MaskRequest& request, std::vector<MaskFrame> frames);

  // The masks of the frame with this index. May be called by another thread.
  std::vector<InstanceMask> Read(size_t frame) const;
  std::vector<InstanceMask> ReadRight(size_t frame) const;
  // Null for masks from files. Those of a network are in the pixels of the images as loaded.
  const NetworkMasks* network() const { return network_; }
  // The classes of all masks of all frames, which are all read, or those that the network knows.
  std::set<std::string> Labels() const;
  std::optional<std::string> format() const;
  size_t without_masks() const { return counts_.without_masks; }  // frames
  std::string Describe() const;  // "masks: PATH (yolo-seg), 6 of 798 frames have none ..."

 private:
  std::string path_;
  std::vector<MaskFrame> frames_;
  std::unique_ptr<const MaskSource> source_;
  const NetworkMasks* network_ = nullptr;  // the source, if it is a network
  MaskCounts counts_;
  std::unique_ptr<const SequenceMasks> right_;  // null without masks of right images
};

// The instances of one class: how many there are, and how many give a detection.
struct ClassCount {
  size_t instances = 0;
  size_t kept = 0;
  double score_sum = 0.0;
};

// The numbers of frames and masks, and of the detections that the masks give.
struct MaskStatistics {
  size_t frames = 0;
  size_t missing = 0;
  size_t without_masks = 0;
  size_t without_image = 0;
  size_t without_depth = 0;
  size_t instances = 0;
  size_t crowds = 0;
  size_t without_area = 0;
  std::array<size_t, kDetectionRejectionCount> rejections{};
  size_t detections = 0;
  size_t cut = 0;
  size_t lines = 0;
  size_t one_sided = 0;
  std::map<std::string, ClassCount> classes;
  std::vector<std::string> faults;
};

// The masks of a sequence, and how they become detections.
struct CheckedSource {
  const ImageSequence& sequence;
  const MaskSource& source;
  const MaskRequest& request;  // of the source
  const PinholeCamera& camera;
  const DetectionBuilder& builder;
};

// The masks of one frame in the image that the sequence gives, and their detections.
struct CheckedFrame {
  FrameMasks masks;
  ViewImages view;
  DetectionResult result;
};

// Counts a frame and its masks. Throws InputError if its masks or images cannot be read, or if its
// masks do not fit the images; what was read is counted.
CheckedFrame CheckFrame(const CheckedSource& checked, const FramePaths& paths,
                        const MaskFrame& names, bool with_image, MaskStatistics& counts);

// A network and its work, for summary.json.
NetworkSummary SummarizeNetwork(const NetworkMasks& network);

// The counts as lines of text, and the table of classes.
std::string DescribeCounts(const MaskStatistics& counts);
std::string DescribeClasses(const MaskStatistics& counts);

}  // namespace hullslam
