// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/mask_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "hullslam/util/error.h"
#include "run/command_line.h"

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

void AddSegmenterOptions(CLI::App& app, SegmenterOptions& options) {
  app.add_option("--names", options.names,
                 "file with the name of one class per line (default: those in the network's file)");
  app.add_option("--classes", options.classes, "only these classes, separated by commas")
      ->delimiter(',');
  ExpectNumber(*app.add_option("--min-score", options.min_score, "least score of an instance")
                    ->capture_default_str(),
               0.0, 1.0);
  app.add_option("--size", options.size,
                 "longer side of the image that the network sees, px (default: as its input)")
      ->check(WholeNumber(1));
  app.add_option("--threads", options.threads, "threads of the network (default: all cores)")
      ->check(WholeNumber(1));
  app.add_flag("--boxes", options.use_boxes,
               "use the boxes of a network that finds no masks; the format is boxes");
}

MaskRequest RequestOf(const std::filesystem::path& path, const std::string& format,
                      const ImageSequence& sequence, const PinholeCamera& camera) {
  if (path.empty() && !format.empty()) {
    throw InputError(
        fmt::format("--masks-format is '{}' without --masks, expected both or neither", format));
  }
  const cv::Size size = SizeAsRead(sequence, camera);
  return {path, format, size.width, size.height};
}

}  // namespace hullslam
