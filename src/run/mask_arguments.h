// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hullslam/masks/open_masks.h"
#include "run/network_masks.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// Adds --masks and --masks-format, which write to `path` and `format`. Both must outlive the app.
void AddMaskArguments(CLI::App& app, std::filesystem::path& path, std::string& format);
// Adds --masks-right, after AddMaskArguments().
void AddRightMaskArgument(CLI::App& app, std::filesystem::path& path);
// Adds --mask-all, and with a stereo camera --mask-all-right.
void AddMaskAllArgument(CLI::App& app, std::filesystem::path& path);
void AddRightMaskAllArgument(CLI::App& app, std::filesystem::path& path);
// Adds --segment and --segment-every, after AddMaskArguments().
void AddNetworkArguments(CLI::App& app, std::filesystem::path& network, size_t& every);
// Adds only the option for the format, under the given names, for programs that take the masks as a
// positional argument.
void AddMaskFormat(CLI::App& app, std::string& format, const std::string& names);

// The request for masks of the images of a sequence as they are read. `camera` is that of the
// images that the sequence gives.
MaskRequest RequestOf(const std::filesystem::path& path, const std::string& format,
                      const ImageSequence& sequence, const PinholeCamera& camera);

// The masks of a sequence. The constructor checks all of them. If the path is empty, there are no
// masks.
class SequenceMasks {
 public:
  // Throws InputError if OpenMasks() or CheckMasks() refuses the masks, or if a format is given
  // without a path.
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

}  // namespace hullslam
