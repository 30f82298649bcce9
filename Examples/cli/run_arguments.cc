// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_arguments.h"

#include "cli/logging.h"
#include "cli/mask_arguments.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// CLI11 alone would take -1 as the largest number there is.
CLI::Validator WholeNumber() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool is_whole =
            !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
        return is_whole ? std::string() : "'" + text + "', expected an integer >= 0";
      },
      "");
}

}  // namespace

void AddRunArguments(CLI::App& app, RunArguments& arguments, std::vector<std::string>& positional) {
  app.add_option("ARGUMENTS", positional,
                 "SEQUENCE: folder with rgb.txt and depth.txt\n"
                 "or VOCABULARY SETTINGS SEQUENCE ASSOCIATIONS, as of ORB-SLAM2");
  app.add_option("--settings", arguments.settings,
                 "settings file (default: camera.yaml of the sequence, else by its name)");
  app.add_option("--vocabulary", arguments.vocabulary, "vocabulary (not used by this version)");
  app.add_option("--associations", arguments.tum.associations,
                 "file of pairs: stamp rgb stamp depth (default: pairs are formed)");
  AddMaskArguments(app, arguments.masks, arguments.masks_format);
  app.add_option("--set", arguments.overrides, "key=value: overrides a setting; repeat for more")
      ->take_all()
      ->allow_extra_args(false);  // else it would take the positional arguments behind it too
  app.add_option("--output", arguments.output, "folder for the results")->capture_default_str();
  app.add_flag("--threaded", arguments.threaded,
               "map in a thread of its own: faster, not reproducible to the bit");
  app.add_flag("--realtime", arguments.realtime, "play the images at the pace of their stamps");
  app.add_option("--seed", arguments.seed,
                 "has no effect yet: nothing in a run is random. It is only copied to summary.json")
      ->check(WholeNumber())
      ->capture_default_str();
  app.add_option("--first", arguments.tum.selection.first, "first frame, counted from 0")
      ->check(WholeNumber());
  app.add_option("--last", arguments.tum.selection.last, "last frame")->check(WholeNumber());
  app.add_option("--stride", arguments.tum.selection.stride, "take every n-th frame")
      ->check(WholeNumber());
  app.add_flag("--strict", arguments.strict, "stop at a broken image instead of skipping it");
  AddDebugFlag(app);
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  app.set_version_flag("--version", HULLSLAM_VERSION);
  app.footer(
      "Exit codes: 0 done, 1 the run failed (tracking lost for good), 2 bad usage or input.");
}

void FinishArguments(const std::vector<std::string>& positional, RunArguments& arguments) {
  if (positional.size() == 1) {
    arguments.sequence = positional[0];
    return;
  }
  if (positional.size() != 4) {
    throw InputError(std::to_string(positional.size()) +
                     " positional arguments, expected SEQUENCE or VOCABULARY SETTINGS SEQUENCE "
                     "ASSOCIATIONS (see --help)");
  }
  arguments.vocabulary = positional[0];
  arguments.settings = positional[1];
  arguments.sequence = positional[2];
  arguments.tum.associations = positional[3];
}

}  // namespace hullslam
