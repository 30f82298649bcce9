// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"
#include "hullslam/io/tum_sequence.h"

namespace hullslam {

// A frame by the names that files of masks have for it.
struct MaskFrame {
  std::string stem;   // of the colour image's file, "1305031102.175304"
  size_t number = 0;  // of the colour image in the sequence, from 0
};

// The frames of a sequence, in its order.
std::vector<MaskFrame> MaskFrames(const TumSequence& sequence);

// What is known of one frame.
struct FrameMasks {
  std::vector<InstanceMask> masks;  // in the order of the file
  bool is_missing = false;          // there is no file, or no entry in the file, of this frame
  size_t without_area = 0;          // left out: outlines that enclose less than 1 px^2 in the image
  size_t crowds = 0;                // left out: groups that are marked as such
};

// The masks of a sequence, whatever their format. Every function may be called by several threads
// at a time.
class MaskSource {
 public:
  MaskSource() = default;
  virtual ~MaskSource() = default;
  MaskSource(const MaskSource&) = delete;
  MaskSource& operator=(const MaskSource&) = delete;

  virtual std::string format() const = 0;                   // its name, "yolo-seg"
  virtual bool Contains(const MaskFrame& frame) const = 0;  // else the frame is missing
  // The name of one entry, a file's or an image's, for messages; empty where there is none.
  virtual std::string Example() const = 0;
  // Throws InputError that names the file, and the line or entry, of what is malformed.
  virtual FrameMasks Read(const MaskFrame& frame) const = 0;
  // Throws what Read() would, in less time where there is a way.
  virtual void Check(const MaskFrame& frame) const { Read(frame); }
};

struct MaskRequest {
  std::filesystem::path path;  // a folder or a JSON file
  std::string format;          // one of MaskFormatNames(); empty: detected
  int width = 0;               // of the images, px
  int height = 0;
};

// yolo-seg, coco, label-png, paper, oa-slam, boxes (docs/masks.md).
std::vector<std::string> MaskFormatNames();

// Throws InputError where the format is unknown, or none or several fit, and where no frame has an
// entry, with the name of one of each side. `frames` must not be empty.
std::unique_ptr<const MaskSource> OpenMasks(const MaskRequest& request,
                                            std::span<const MaskFrame> frames);

// Checks all frames, the first fault throws; returns how many are missing.
size_t CheckMasks(const MaskSource& source, std::span<const MaskFrame> frames);

}  // namespace hullslam
