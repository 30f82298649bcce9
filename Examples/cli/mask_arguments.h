// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/io/mask_source.h"

namespace hullslam {

// Adds --masks and --masks-format, which write to these two; they must outlive the app.
void AddMaskArguments(CLI::App& app, std::filesystem::path& path, std::string& format);
// The format alone, by the option's names, for programs whose masks are an argument.
void AddMaskFormat(CLI::App& app, std::string& format, const std::string& names);

// The masks of a sequence, all checked before the first is asked for; none for an empty path.
class SequenceMasks {
 public:
  // Throws InputError for what OpenMasks() or CheckMasks() refuses, and for a format without a
  // path.
  SequenceMasks(const MaskRequest& request, std::vector<MaskFrame> frames);

  // Of one of the frames, by its index; may be called by another thread.
  std::vector<InstanceMask> Read(size_t frame) const;
  std::optional<std::string> format() const;
  std::string Describe() const;  // "masks: yolo-seg of 798 frames, 0 frames without"

 private:
  std::string path_;
  std::vector<MaskFrame> frames_;
  std::unique_ptr<const MaskSource> source_;
  size_t missing_ = 0;
};

}  // namespace hullslam
