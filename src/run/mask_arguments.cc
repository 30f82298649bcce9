// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/mask_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "util/counted.h"

namespace hullslam {

void AddMaskFormat(CLI::App& app, std::string& format, const std::string& names) {
  app.add_option(names, format,
                 fmt::format("format of the masks: {} (default: detected from the files)",
                             fmt::join(MaskFormatNames(), ", ")))
      ->check(CLI::IsMember(MaskFormatNames()).description(""));
}

void AddMaskArguments(CLI::App& app, std::filesystem::path& path, std::string& format) {
  app.add_option("--masks", path,
                 "instance masks of the objects: a folder or a JSON file (docs/masks.md)");
  AddMaskFormat(app, format, "--masks-format");
}

void AddRightMaskArgument(CLI::App& app, std::filesystem::path& path) {
  app.add_option("--masks-right", path,
                 "instance masks of the right images, in the format of --masks: more lines of the "
                 "same objects")
      ->needs("--masks");
}

void AddMaskAllArgument(CLI::App& app, std::filesystem::path& path) {
  app.add_option("--mask-all", path,
                 "one mask for all images, such as that of the robot's own arm, a bonnet or a "
                 "watermark: a PNG of their size, whose black pixels (0) are ignored in each image "
                 "(docs/masks.md)");
}

void AddRightMaskAllArgument(CLI::App& app, std::filesystem::path& path) {
  app.add_option("--mask-all-right", path, "the same for the right images");
}

void AddNetworkArguments(CLI::App& app, std::filesystem::path& network, size_t& every) {
  CLI::Option* const segment =
      app.add_option("--segment", network,
                     "network that makes the masks, a file of ONNX (docs/segmentation.md); with "
                     "--realtime, masks come when they are ready")
          ->excludes("--masks");
  app.add_option("--segment-every", every,
                 "without --realtime: make masks of every n-th frame and of all keyframes")
      ->check(WholeNumber(1))
      ->needs(segment)
      ->capture_default_str();
}

MaskRequest RequestOf(const std::filesystem::path& path, const std::string& format,
                      const ImageSequence& sequence, const PinholeCamera& camera) {
  const cv::Size size = SizeAsRead(sequence, camera);
  return {path, format, size.width, size.height};
}

SequenceMasks::SequenceMasks(const MaskRequest& request, std::vector<MaskFrame> frames)
    : path_(request.path.string()), frames_(std::move(frames)) {
  if (!request.path.empty()) {
    source_ = OpenMasks(request, frames_);
    counts_ = CheckMasks(*source_, frames_, request);
  } else if (!request.format.empty()) {
    throw InputError(fmt::format("--masks-format is '{}' without --masks, expected both or neither",
                                 request.format));
  }
}

SequenceMasks::SequenceMasks(std::unique_ptr<const NetworkMasks> network,
                             std::vector<MaskFrame> frames)
    : frames_(std::move(frames)), network_(network.get()) {
  source_ = std::move(network);
}

std::vector<InstanceMask> SequenceMasks::Read(size_t frame) const {
  return source_ == nullptr ? std::vector<InstanceMask>() : source_->Read(frames_.at(frame)).masks;
}

void SequenceMasks::AddRight(const MaskRequest& request, std::vector<MaskFrame> frames) {
  right_ = std::make_unique<const SequenceMasks>(request, std::move(frames));
}

std::vector<InstanceMask> SequenceMasks::ReadRight(size_t frame) const {
  return right_ == nullptr ? std::vector<InstanceMask>() : right_->Read(frame);
}

std::set<std::string> SequenceMasks::Labels() const {
  if (network_ != nullptr) {
    return {network_->class_names().begin(), network_->class_names().end()};
  }
  std::set<std::string> labels;
  for (size_t frame = 0; frame < frames_.size(); ++frame) {
    for (const InstanceMask& mask : Read(frame)) {
      labels.insert(mask.label);
    }
  }
  return labels;
}

std::optional<std::string> SequenceMasks::format() const {
  return source_ == nullptr ? std::nullopt : std::optional(source_->format());
}

std::string SequenceMasks::Describe() const {
  if (network_ != nullptr) {
    return "masks are made by " + network_->Describe();
  }
  return source_ == nullptr
             ? std::string("no masks")
             : fmt::format("masks: {} ({}), {} of {} frames have none{}{}{}", path_,
                           source_->format(), counts_.without_masks, frames_.size(),
                           counts_.missing == 0
                               ? std::string()
                               : fmt::format(", {} of them because they have no file or "
                                             "entry",
                                             counts_.missing),
                           counts_.without_area == 0
                               ? std::string()
                               : fmt::format("; left out: {} without an outline of 1 px^2 or more",
                                             Counted(counts_.without_area, "instance")),
                           right_ == nullptr ? std::string() : "\nright " + right_->Describe());
}

}  // namespace hullslam
