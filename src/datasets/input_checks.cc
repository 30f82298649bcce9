// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/datasets/input_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "eval/image_registration.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

// A warning about the classes of a setting that no mask has.
void AddUnknown(const char* key, std::set<std::string> classes, const std::set<std::string>& labels,
                std::vector<std::string>& warnings) {
  for (const std::string& label : labels) {
    classes.erase(label);
  }
  if (!classes.empty()) {
    warnings.push_back(fmt::format(
        "{} has '{}', but no mask has this class; {}", key, fmt::join(classes, "', '"),
        labels.empty() ? std::string("there are no masks")
                       : fmt::format("classes of the masks: {}", fmt::join(labels, ", "))));
  }
}

// The images of the run are rectified, and so are the masks, because they belong to the images as
// read. Masks that fit the images only before that are those of other images. A rectification that
// moves them by a pixel or two changes the contrast less.
void RefuseMasksOfRectifiedImages(double as_given, double fitted) {
  constexpr double kLeast = 1.5;  // as for turned images
  if (as_given > kLeast * std::max(fitted, 1.0)) {
    throw InputError(
        fmt::format("the masks fit the rectified or resized images (contrast {:.2f}) and not the "
                    "images as read "
                    "({:.2f}), expected masks of the images as read",
                    as_given, fitted));
  }
}

}  // namespace

std::vector<std::string> CheckDepth(const ImageSequence& sequence, const PinholeCamera& camera) {
  constexpr size_t kFrames = 7;
  constexpr size_t kLeastEdges = 2000;  // px
  // 1 if depth and colour have nothing to do with each other. Parts of freiburg1_xyz and renderings
  // of desks have 1.47 or more; with the depth scaled by a tenth most have 1.33 or less. Moved by
  // 20 px they may have 1.5, but then 2.0 elsewhere; what is registered has 0.7 times as much above
  // 1 elsewhere.
  constexpr double kLeastContrast = 1.35;
  constexpr double kLeastShare = 0.6;
  DepthRegistration registration;
  const size_t step = std::max<size_t>(1, sequence.frames.size() / kFrames);
  for (size_t i = 0; i < sequence.frames.size(); i += step) {
    try {
      const ImageInput image = sequence.load(sequence.frames[i], camera);
      if (!image.depth.empty()) {
        registration.Add(image.grey, image.depth);
      }
    } catch (const InputError&) {  // the run will report this image
      continue;
    }
  }
  if (registration.edges() < kLeastEdges) {
    return {};
  }
  const double least =
      std::max(kLeastContrast, 1.0 + kLeastShare * (registration.ContrastElsewhere() - 1.0));
  if (registration.Contrast() >= least) {
    return {};
  }
  return {fmt::format(
      "the borders in the depth images are not where those in the colour images are (contrast "
      "{:.2f}, expected at least {:.2f}); are the depth images registered to the colour images?",
      registration.Contrast(), least)};
}

std::vector<std::string> CheckClasses(const SystemOptions& options,
                                      const std::function<std::set<std::string>()>& labels) {
  constexpr double kLargeSize = 3.0;  // m; few objects that are mapped are larger
  std::vector<std::string> warnings;
  std::set<std::string> dynamic = SplitNames(options.tracking.dynamic_classes);
  for (const std::string& name : SplitNames(SystemOptions().tracking.dynamic_classes)) {
    dynamic.erase(name);
  }
  std::set<std::string> sized;
  for (const auto& [name, size] : options.objects.sizes) {
    sized.insert(name);
    if (size > kLargeSize) {
      warnings.push_back(
          fmt::format("objects.sizes says that the longest side of '{}' is {:g} m; sizes are in "
                      "metres, is this one right?",
                      name, size));
    }
  }
  if (!dynamic.empty() || !sized.empty()) {
    const std::set<std::string> known = labels();
    AddUnknown("tracking.dynamic_classes", dynamic, known, warnings);
    AddUnknown("objects.sizes", sized, known, warnings);
  }
  return warnings;
}

std::vector<std::string> CheckMaskPlaces(
    const ImageSequence& sequence, const PinholeCamera& camera,
    const std::function<std::vector<InstanceMask>(size_t)>& read) {
  constexpr size_t kFrames = 7;
  constexpr size_t kMostStep = 30;  // so that no video is decoded to its end
  constexpr size_t kLeastPoints = 2000;
  // Masks of freiburg1_xyz have 2.2, and 0.9 to 1.0 if images and masks are turned against each
  // other; 1.5 is the middle of the two factors.
  constexpr double kLeastOfTurned = 1.5;
  constexpr double kLeast = 1.1;
  MaskRegistration registration;
  MaskRegistration as_given;
  const size_t step = std::clamp<size_t>(sequence.frames.size() / kFrames, 1, kMostStep);
  for (size_t i = 0; i < std::min(sequence.frames.size(), kFrames * step); i += step) {
    try {
      std::vector<InstanceMask> found = read(i);
      if (!found.empty()) {
        const cv::Mat grey = sequence.load(sequence.frames[i], camera).grey;
        if (!sequence.warps.empty()) {
          as_given.Add(grey, found);
          FitMasks(sequence.warps, ImageSide::kLeft, found);
        }
        registration.Add(grey, found);
      }
    } catch (const InputError&) {  // the program will report it
      continue;
    }
  }
  if (registration.points() < kLeastPoints) {
    return {};
  }
  const double contrast = registration.Contrast(1);
  if (!sequence.warps.empty()) {
    RefuseMasksOfRectifiedImages(as_given.Contrast(1), contrast);
  }
  int best = 1;
  for (int orientation = 2; orientation <= 8; ++orientation) {
    if (registration.Contrast(orientation) > registration.Contrast(best)) {
      best = orientation;
    }
  }
  if (registration.Contrast(best) > kLeastOfTurned * std::max(contrast, 1.0)) {
    return {fmt::format(
        "the masks do not fit the images, but they would if the images were turned as by the EXIF "
        "orientation {}. cv2.imread and Ultralytics turn images so; HullSLAM reads the stored "
        "pixels, and scripts/make_masks.py makes masks of them",
        best)};
  }
  if (contrast >= kLeast) {
    return {};
  }
  return {fmt::format(
      "the outlines of the masks are not where the borders in the images are (contrast {:.2f}, "
      "expected at least {}); are they the masks of these images?",
      contrast, kLeast)};
}

std::vector<std::string> CheckLastFrame(const FrameSelection& selection,
                                        const ImageSequence& sequence) {
  if (selection.last == std::numeric_limits<size_t>::max() || selection.last < sequence.available) {
    return {};
  }
  return {fmt::format("--last is '{}', but the last frame of the sequence is {}", selection.last,
                      sequence.available - 1)};
}

}  // namespace hullslam
