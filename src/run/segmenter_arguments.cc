// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/segmenter_arguments.h"

#include <CLI/CLI.hpp>

#include "run/command_line.h"

namespace hullslam {

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

}  // namespace hullslam
