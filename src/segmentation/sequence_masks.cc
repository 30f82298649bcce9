// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/sequence_masks.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "util/text.h"

namespace hullslam {
namespace {

void CountMasks(const FrameMasks& frame, MaskStatistics& counts) {
  counts.missing += frame.is_missing ? 1 : 0;
  counts.without_masks += frame.masks.empty() ? 1 : 0;
  counts.instances += frame.masks.size() + frame.without_area + frame.crowds;
  counts.without_area += frame.without_area;
  counts.crowds += frame.crowds;
}

void CountDetections(const FrameMasks& frame, const DetectionResult& result,
                     MaskStatistics& counts) {
  for (size_t i = 0; i < frame.masks.size(); ++i) {
    ClassCount& of_class = counts.classes[frame.masks[i].label];
    ++of_class.instances;
    of_class.score_sum += frame.masks[i].score;
    if (const auto& rejection = result.rejections.at(i)) {
      ++counts.rejections.at(static_cast<size_t>(*rejection));
    } else {
      ++of_class.kept;
    }
  }
  counts.detections += result.detections.size();
  for (const Detection& detection : result.detections) {
    counts.cut += detection.is_cut ? 1 : 0;
    counts.lines += detection.lines.size();
    for (const SilhouetteLine& line : detection.lines) {
      counts.one_sided += line.is_one_sided ? 1 : 0;
    }
  }
}

}  // namespace

SequenceMasks::SequenceMasks(const MaskRequest& request, std::vector<MaskFrame> frames)
    : path_(request.path.string()), frames_(std::move(frames)) {
  if (!request.path.empty()) {
    source_ = OpenMasks(request, frames_);
    counts_ = CheckMasks(*source_, frames_, request);
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

CheckedFrame CheckFrame(const CheckedSource& checked, const FramePaths& paths,
                        const MaskFrame& names, bool with_image, MaskStatistics& counts) {
  ++counts.frames;
  counts.without_image += HasImage(checked.sequence, paths) ? 0 : 1;
  counts.without_depth += paths.depth.empty() ? 1 : 0;
  CheckedFrame frame{.masks = checked.source.Read(names), .view = {}, .result = {}};
  CheckMasks(checked.source, {&names, 1}, checked.request);
  FitMasks(checked.sequence.warps, ImageSide::kLeft, frame.masks.masks);
  CountMasks(frame.masks, counts);
  frame.view = ReadView(checked.sequence, paths, checked.camera, with_image);
  frame.result = checked.builder.Build(frame.masks.masks, frame.view.depth, {});
  CountDetections(frame.masks, frame.result, counts);
  return frame;
}

std::string DescribeCounts(const MaskStatistics& counts) {
  std::string text;
  const auto add = [&text](const std::string& name, size_t count) {
    text += fmt::format("{:<24}{:>10}\n", name, count);
  };
  add("frames", counts.frames);
  add("without image", counts.without_image);
  add("without depth", counts.without_depth);
  add("without masks", counts.without_masks);
  add("  without file", counts.missing);
  add("malformed", counts.faults.size());
  add("instances", counts.instances);
  add("kept", counts.detections);
  add("  cut by the border", counts.cut);
  add("rejected: crowd", counts.crowds);
  add("rejected: no area", counts.without_area);
  for (size_t i = 0; i < counts.rejections.size(); ++i) {
    add("rejected: " + ToString(static_cast<DetectionRejection>(i)), counts.rejections[i]);
  }
  add("lines", counts.lines);
  add("  one-sided", counts.one_sided);
  return text;
}

std::string DescribeClasses(const MaskStatistics& counts) {
  size_t width = std::string("class").size();
  for (const auto& [label, of_class] : counts.classes) {
    width = std::max(width, label.size());
  }
  std::string text = fmt::format("\n{:<{}}{:>12}{:>10}{:>12}\n", "class", width, "instances",
                                 "kept", "mean score");
  for (const auto& [label, of_class] : counts.classes) {
    text +=
        fmt::format("{:<{}}{:>12}{:>10}{:>12.2f}\n", label, width, of_class.instances,
                    of_class.kept, of_class.score_sum / static_cast<double>(of_class.instances));
  }
  return text;
}

NetworkSummary SummarizeNetwork(const NetworkMasks& network) {
  const NetworkMasks::Work work = network.work();
  return {.path = network.path().string(),
          .hash = network.hash(),
          .every = network.every() > 0 ? std::optional(network.every()) : std::nullopt,
          .classes = network.class_names(),
          .images = work.times.Total("segment").count,
          .failures = work.failures};
}

}  // namespace hullslam
