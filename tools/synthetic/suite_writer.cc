// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/suite_writer.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hullslam/util/check.h"
#include "synthetic/sequence_files.h"
#include "synthetic/sequence_renderer.h"
#include "synthetic/staged_output.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;  // of suite.json

nlohmann::ordered_json Describe(const SuiteSequence& sequence) {
  const SequenceLayout layout{sequence.form};
  const fs::path tum = fs::path(sequence.name) / layout.TumFolder();
  return {{"name", sequence.name},
          {"folder", sequence.name},
          {"dataset", DatasetName(sequence.form)},
          {"masks", (tum / "masks").string()},
          {"objects", (tum / "groundtruth_objects.json").string()},
          {"tum_folder",
           sequence.form == DatasetForm::kTum ? std::string(sequence.name) : tum.string()},
          {"plays", sequence.plays},
          {"readout_time", sequence.readout_time},
          {"special", sequence.special}};
}

std::string SuiteJson(const SuiteOptions& options,
                      const std::vector<const SuiteSequence*>& sequences) {
  nlohmann::ordered_json file = {{"generator", "make_synthetic"},
                                 {"format", kFormat},
                                 {"seed", options.seed},
                                 {"frames", options.frames},
                                 {"sequences", nlohmann::ordered_json::array()}};
  for (const SuiteSequence* const sequence : sequences) {
    file["sequences"].push_back(Describe(*sequence));
  }
  return file.dump(1) + "\n";
}

// Whether a folder of this name in an output is what a run of ours wrote for a sequence.
bool IsSequenceOfSuite(const fs::path& folder) {
  for (const SuiteSequence& sequence : SuiteSequences()) {
    if (folder.filename() == sequence.name && fs::is_directory(folder)) {
      const SequenceLayout layout{sequence.form};
      return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                         [&](const fs::directory_entry& entry) {
                           return layout.IsEntry(entry.path().filename().string(), sequence.name);
                         });
    }
  }
  return false;
}

bool IsFormerSuite(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != "suite.json" && !IsSequenceOfSuite(entry.path())) {
      return false;
    }
  }
  std::ifstream file(folder / "suite.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  return json.is_object() && json.contains("generator") && json["generator"] == "make_synthetic";
}

}  // namespace

bool WriteSuite(const fs::path& folder, const SuiteOptions& options,
                const std::function<bool(std::string_view, int)>& progress) {
  Check(options.frames >= 2 && options.threads >= 0, "a suite needs sequences of two frames");
  const std::vector<const SuiteSequence*> sequences = SelectSuite(options.only);
  const FormerOutput former{"a suite", IsFormerSuite, options.force};
  return WriteStaged(folder, former, [&](const fs::path& content) {
    int done = 0;
    for (const SuiteSequence* const sequence : sequences) {
      const fs::path target = content / sequence->name;
      fs::create_directory(target);
      SequencePlan plan = PlanOf(*sequence, options.frames, options.seed);
      if (options.stereo_baseline > 0.0) {
        plan.stereo_baseline = options.stereo_baseline;
        plan.camera.bf = options.stereo_baseline * plan.camera.fx;
      }
      if (!RenderSequence(target, plan, options.threads,
                          [&](int frames) { return progress(sequence->name, done + frames); })) {
        return false;
      }
      done += options.frames;
    }
    WriteNewFile(content / "suite.json", SuiteJson(options, sequences));
    return true;
  });
}

}  // namespace hullslam::synthetic
