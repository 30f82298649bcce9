// SPDX-License-Identifier: GPL-3.0-or-later
#include "datasets/run_sequence.h"

#include <fmt/format.h>

#include <string>

#include "hullslam/datasets/dataset.h"
#include "hullslam/util/error.h"
#include "sequences/resized_images.h"
#include "util/text.h"

namespace hullslam {
namespace {

// Whether the run has read such a data set. Runs before December 2026 name only their program.
// The runs of VSLAM-LAB did not say either which list of images they had.
bool IsOf(const Dataset& dataset, const SequenceOfRun& run) {
  if (!run.dataset.empty()) {
    return run.dataset == dataset.name;
  }
  const std::string program = run.program == "map_objects" ? "rgbd_tum" : run.program;
  return program.ends_with(std::string("_") + dataset.program);
}

}  // namespace

ImageSequence OpenRunSequence(const SequenceOfRun& run, const std::filesystem::path& path,
                              const PinholeCamera& camera, bool use_depth) {
  std::string known;
  for (const Dataset& dataset : Datasets()) {
    if (dataset.sensors.empty()) {
      continue;
    }
    if (IsOf(dataset, run)) {
      ImageSequence sequence = dataset.open_images({.path = path,
                                                    .choices = run.choices,
                                                    .origin = " in summary.json",
                                                    .camera = camera,
                                                    .use_depth = use_depth});
      if (const auto size = run.choices.find("resized_from"); size != run.choices.end()) {
        ResizeImages(size->second, camera, sequence);
      }
      return sequence;
    }
    known += (known.empty() ? "" : ", ") + std::string(dataset.name);
  }
  throw InputError(
      run.dataset.empty()
          ? fmt::format(
                "{}: cannot be opened, because the run does not say of which data set it is "
                "(provenance.dataset in summary.json); repeat the run with this version",
                path.string())
          : fmt::format("{}: cannot be opened, because provenance.dataset in summary.json is '{}', "
                        "expected one of: {}",
                        path.string(), ShowText(run.dataset), known));
}

}  // namespace hullslam
