// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "camera/fit_depth.h"
#include "frame/detection/mask_region.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "sequences/image_list.h"
#include "view/point_colours.h"

namespace hullslam {
namespace {

void UseColours(const PointColours& colours, ExportModel& model) {
  const std::vector<Colour> list = colours.Colours();
  for (size_t i = 0; i < list.size(); ++i) {
    model.points[i].colour = list[i];
  }
}

// The units of the depth images per metre, from the first keyframe that tells them.
std::optional<double> FindDepthUnits(const std::vector<KeyframeImage>& images,
                                     const ExportInput& input) {
  const PinholeCamera& camera = input.map->sensor.camera;
  for (const KeyframeImage& image : images) {
    const Keyframe& keyframe = input.map->map.keyframes().At(image.keyframe);
    const auto units = MeasureDepthUnits(keyframe.frame->features, camera,
                                         input.sequence->load(image.frame, camera).depth);
    if (units) {
      return units;
    }
  }
  return std::nullopt;
}

void WriteDepths(const std::vector<KeyframeImage>& images, const ExportCamera& view,
                 ExportInput& input, ExportFolder& folder, std::vector<NerfstudioFrame>& frames) {
  const auto has_depth = [](const KeyframeImage& image) { return !image.frame.depth.empty(); };
  if (input.map->sensor.kind != SensorKind::kRgbd) {
    return;
  }
  const std::optional<double> units = std::all_of(images.begin(), images.end(), has_depth)
                                          ? FindDepthUnits(images, input)
                                          : std::nullopt;
  if (!units) {
    input.notes.emplace_back("the depth images left out: not all keyframes have one");
    return;
  }
  for (size_t i = 0; i < images.size(); ++i) {
    const ImageInput loaded = input.sequence->load(images[i].frame, input.map->sensor.camera);
    frames[i].depth = "depths/" + images[i].name + ".png";
    folder.Write(
        {frames[i].depth,
         EncodeImage(MakeDepthImage(FitDepth(loaded.depth, loaded.grey.size()), *units, view),
                     ".png")});
  }
}

// The masks of things of these classes in the raw images; empty where there are none.
std::vector<cv::Mat> LoadMasks(const std::vector<KeyframeImage>& images,
                               const std::set<std::string>& classes, const ExportInput& input) {
  const PinholeCamera& camera = input.map->sensor.camera;
  const std::unique_ptr<const MaskSource> source =
      OpenMasks({input.masks->path, input.masks->format, camera.width, camera.height},
                MaskFrames(*input.sequence));
  std::vector<cv::Mat> masks;
  for (const KeyframeImage& image : images) {
    const FrameMasks read = source->Read({image.frame.image.stem().string(), image.frame.number});
    masks.push_back(DynamicMask(read.masks, classes, {camera.width, camera.height}));
  }
  return masks;
}

void WriteMasks(const std::vector<KeyframeImage>& images, const ExportCamera& view,
                const std::set<std::string>& classes, const ExportInput& input,
                ExportFolder& folder, std::vector<NerfstudioFrame>& frames) {
  if (!input.masks || classes.empty()) {
    return;
  }
  const std::vector<cv::Mat> masks = LoadMasks(images, classes, input);
  if (std::all_of(masks.begin(), masks.end(), [](const cv::Mat& mask) { return mask.empty(); })) {
    return;
  }
  const cv::Size size(view.camera().width, view.camera().height);
  for (size_t i = 0; i < images.size(); ++i) {
    cv::Mat seen(size, CV_8UC1, cv::Scalar(255));
    if (!masks[i].empty()) {
      seen = 255 - view.Undistort(masks[i], cv::INTER_NEAREST);
    }
    frames[i].mask = "masks/" + images[i].name + ".png";
    folder.Write({frames[i].mask, EncodeImage(seen, ".png")});
  }
}

}  // namespace

std::vector<KeyframeImage> FindImages(ExportInput& input) {
  const Map& map = input.map->map;
  std::vector<KeyframeImage> images = FindKeyframeImages(map, *input.sequence, input.session);
  const size_t keyframes = map.keyframes().size();
  if (images.empty()) {
    throw InputError(fmt::format(
        "none of the {} keyframes has an image in the sequence '{}': no time stamps are equal; "
        "expected the sequence of the run (runs with --fps or --stamp-offset cannot be exported)",
        keyframes, input.session));
  }
  if (images.size() < keyframes) {
    input.notes.push_back(
        fmt::format("{} of {} keyframes left out: their images are not in the sequence '{}'",
                    keyframes - images.size(), keyframes, input.session));
  }
  return images;
}

void ColourPoints(ExportInput& input) {
  PointColours colours(input.map->map, input.map->located.ids);
  const PinholeCamera& camera = input.map->sensor.camera;
  size_t failed = 0;
  for (const KeyframeImage& image :
       FindKeyframeImages(input.map->map, *input.sequence, input.session)) {
    try {
      colours.Add(image.keyframe, LoadColour(*input.sequence, image.frame, camera), camera);
    } catch (const InputError&) {
      ++failed;
    }
  }
  if (failed > 0) {
    input.notes.push_back(
        fmt::format("the colours of {} images left out: they cannot be read", failed));
  }
  UseColours(colours, input.model);
}

void WriteImages(const std::vector<KeyframeImage>& images, const ExportCamera& view,
                 ExportInput& input, ExportFolder& folder) {
  PointColours colours(input.map->map, input.map->located.ids);
  const PinholeCamera& camera = input.map->sensor.camera;
  for (const KeyframeImage& image : images) {
    const cv::Mat raw = LoadColour(*input.sequence, image.frame, camera);
    colours.Add(image.keyframe, raw, camera);
    folder.Write({"images/" + image.name + ".png",
                  EncodeImage(view.Undistort(raw, cv::INTER_CUBIC), ".png")});
  }
  UseColours(colours, input.model);
}

void WriteRightImages(const std::vector<KeyframeImage>& images, const ExportCamera& view,
                      const ExportInput& input, ExportFolder& folder) {
  for (const KeyframeImage& image : images) {
    const ImageInput pair = input.sequence->load(image.frame, input.map->sensor.camera);
    folder.Write({"images/" + image.name + "_right.png",
                  EncodeImage(view.Undistort(pair.right, cv::INTER_CUBIC), ".png")});
  }
}

std::vector<NerfstudioFrame> WriteDepthsAndMasks(const std::vector<KeyframeImage>& images,
                                                 const ExportCamera& view,
                                                 const std::set<std::string>& masked_classes,
                                                 ExportInput& input, ExportFolder& folder) {
  std::vector<NerfstudioFrame> frames;
  for (const KeyframeImage& image : images) {
    const Keyframe& keyframe = input.map->map.keyframes().At(image.keyframe);
    frames.push_back({"images/" + image.name + ".png", {}, {}, Inverse(keyframe.cam_from_world)});
  }
  WriteDepths(images, view, input, folder, frames);
  WriteMasks(images, view, masked_classes, input, folder, frames);
  return frames;
}

}  // namespace hullslam
