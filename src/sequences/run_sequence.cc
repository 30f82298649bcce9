// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/run_sequence.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/sequences/tum_sequence.h"

namespace hullslam {

namespace fs = std::filesystem;

namespace {

BagSequenceOptions BagOptions(const std::map<std::string, std::string>& choices, bool use_depth) {
  const auto choice = [&](const char* name) {
    const auto found = choices.find(name);
    return found != choices.end() ? found->second : std::string();
  };
  const std::string units = choice("float_units");
  return {.image_topic = choice("image_topic"),
          .depth_topic = choice("depth_topic"),
          .use_depth = use_depth,
          .need_camera = false,
          .use_recording_times = choice("times") == "recording",
          .float_units = units.empty() ? 1.0 : std::strtod(units.c_str(), nullptr)};
}

}  // namespace

std::optional<fs::path> FindRunInput(const std::string& input, const fs::path& run_folder) {
  std::error_code error;
  if (input.empty()) {
    return std::nullopt;
  }
  if (fs::exists(input, error)) {
    return fs::path(input);
  }
  const fs::path absolute = fs::absolute(run_folder, error);
  for (fs::path folder = absolute; !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / input, error)) {
      return folder / input;
    }
    if (folder == folder.root_path()) {
      break;
    }
  }
  return std::nullopt;
}

RunOpening ReadRunOpening(const nlohmann::json& summary) {
  RunOpening run;
  const nlohmann::json provenance =
      summary.is_object() ? summary.value("provenance", nlohmann::json()) : nlohmann::json();
  if (!provenance.is_object()) {
    return run;
  }
  if (const auto program = provenance.find("program");
      program != provenance.end() && program->is_string()) {
    run.program = *program;
  }
  const nlohmann::json choices = provenance.value("sequence_choices", nlohmann::json());
  if (choices.is_object()) {
    for (const auto& [name, choice] : choices.items()) {
      if (choice.is_string()) {
        run.choices[name] = choice;
      }
    }
  }
  return run;
}

ImageSequence OpenRunSequence(const RunOpening& run, const fs::path& sequence,
                              const PinholeCamera& camera, bool use_depth) {
  const std::string& program = run.program;
  if (program.ends_with("_euroc")) {
    return OpenEurocSequence(sequence).images;
  }
  if (program.ends_with("_icl")) {
    return OpenIclSequence(sequence, camera, {}, {.use_depth = use_depth}).images;
  }
  if (program.ends_with("_bag")) {
    return OpenBagSequence(sequence, BagOptions(run.choices, use_depth)).images;
  }
  if (program.ends_with("_video")) {
    return OpenImageStream(sequence).images;
  }
  return OpenTumSequence(sequence, {.use_depth = use_depth});
}

}  // namespace hullslam
