// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

// The names that mask files use for a frame.
struct MaskFrame {
  std::string stem;   // stem of the file of the colour image: "1305031102.175304"
  size_t number = 0;  // index of the colour image in the sequence, from 0
  // For a frame of a video, the name that Ultralytics gives its labels: "kitchen_1" for the first
  // frame of kitchen.mp4.
  std::string video_name = {};
};

// The frames of a sequence, in order.
std::vector<MaskFrame> MaskFrames(const ImageSequence& sequence);
// The same of the right images, which may have names of their own.
std::vector<MaskFrame> RightMaskFrames(const ImageSequence& sequence);

// The masks of one frame.
struct FrameMasks {
  std::vector<InstanceMask> masks;  // in the order of the file
  std::vector<size_t> rows;         // of each mask: its index in the file, without crowds
  bool is_missing = false;          // the frame has no file, or no entry in the file
  size_t without_area = 0;  // ignored masks without an outline of at least 1 px^2 in the image
  size_t crowds = 0;        // ignored masks that are marked as a group of objects
};

// The masks of a sequence in any format. All functions may be called from several threads at once.
class MaskSource {
 public:
  MaskSource() = default;
  virtual ~MaskSource() = default;
  MaskSource(const MaskSource&) = delete;
  MaskSource& operator=(const MaskSource&) = delete;

  virtual std::string format() const = 0;                   // the name of the format: "yolo-seg"
  virtual bool Contains(const MaskFrame& frame) const = 0;  // whether the frame has a file or entry
  // The name of one entry (a file or an image), for messages; empty if there is none.
  virtual std::string Example() const = 0;
  // Throws InputError that names the file, and the line or entry, of malformed data.
  virtual FrameMasks Read(const MaskFrame& frame) const = 0;
};

struct MaskRequest {
  std::filesystem::path path;  // a folder or a JSON file
  std::string format;          // one of MaskFormatNames() (open_masks.h); empty: it is detected
  int width = 0;               // width of the images, px
  int height = 0;
};

struct MaskCounts {
  size_t without_masks = 0;  // frames that are missing, or whose file or entry has no mask
  size_t missing = 0;        // frames without a file or entry
  size_t without_area = 0;   // ignored masks of all frames; see FrameMasks
};

// Reads the masks of all frames and throws the first error, which names the frame.
// If the size of the images is given, ValidateMasks() checks them too.
MaskCounts CheckMasks(const MaskSource& source, std::span<const MaskFrame> frames,
                      const MaskRequest& size = {});

}  // namespace hullslam
