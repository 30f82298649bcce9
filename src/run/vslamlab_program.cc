// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/vslamlab_program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/atomic_file.h"
#include "geometry/mirror.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/vslamlab_sequence.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/datasets/stereo_dataset.h"
#include "run/input_warnings.h"
#include "run/load_settings.h"
#include "run/program.h"
#include "run/slam_run.h"
#include "settings/yaml_map.h"
#include "settings/yaml_settings.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

struct Key {
  std::string_view name;
  bool is_needed;
  std::string_view meaning;
};

constexpr auto kKeys = std::to_array<Key>({
    {"sequence_path", true, "folder of the sequence"},
    {"calibration_yaml", true, "its calibration"},
    {"rgb_csv", true, "list of its images, relative to sequence_path"},
    {"exp_folder", true, "folder for the results"},
    {"exp_id", true, "name of the run, which the names of its files begin with"},
    {"settings_yaml", false,
     "settings of HullSLAM, and cam_mono or cam_rgbd (rgb_0), or cam_stereo (rgb_0 and rgb_1)"},
    {"verbose", false, "0: print only errors (1)"},
    {"mode", false, "mono, rgbd or stereo, the mode of the program"},
    {"masks", false, "masks of the images, as --masks of the other programs"},
    {"preset", false, "as --preset of the other programs"},
    {"seed", false, "of the random numbers (0)"},
});

using Values = std::map<std::string, std::string, std::less<>>;

std::string ModeOf(SensorKind sensor) {
  switch (sensor) {
    case SensorKind::kMonocular:
      return "mono";
    case SensorKind::kStereo:
      return "stereo";
    default:
      return "rgbd";
  }
}

std::string ProgramName(SensorKind sensor) { return "vslamlab_hullslam_" + ModeOf(sensor); }

std::string KeysHelp() {
  std::string text;
  for (const Key& key : kKeys) {
    text += fmt::format("{}{}: {}{}", text.empty() ? "" : "\n", key.name, key.meaning,
                        key.is_needed ? "" : " [optional]");
  }
  return text;
}

Values ParseValues(const std::vector<std::string>& words) {
  Values values;
  for (const std::string_view word : words) {
    const std::string_view name = word.substr(0, word.find(':'));
    const auto key =
        std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& k) { return k.name == name; });
    if (key == kKeys.end() || name.size() == word.size()) {
      std::vector<std::string_view> names;
      for (const Key& known : kKeys) {
        names.push_back(known.name);
      }
      throw InputError(fmt::format("'{}': expected key:value with one of the keys: {}",
                                   ShowText(word), fmt::join(names, ", ")));
    }
    values.insert_or_assign(std::string(name), std::string(word.substr(name.size() + 1)));
  }
  for (const Key& key : kKeys) {
    if (key.is_needed && values[std::string(key.name)].empty()) {
      throw InputError(
          fmt::format("{}: is not given, expected {}:VALUE, {}", key.name, key.name, key.meaning));
    }
  }
  return values;
}

std::string Get(const Values& values, std::string_view key, std::string otherwise) {
  const auto found = values.find(key);
  return found == values.end() || found->second.empty() ? std::move(otherwise) : found->second;
}

uint64_t ParseSeed(const std::string& text) {
  const bool is_number =
      !text.empty() && text.size() < 19 &&
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (!is_number) {
    throw InputError(fmt::format("seed is '{}', expected an integer >= 0", ShowText(text)));
  }
  return std::stoull(text);
}

void CheckChoices(SensorKind sensor, const Values& values) {
  const std::string mode = Get(values, "mode", ModeOf(sensor));
  if (mode != ModeOf(sensor)) {
    throw InputError(
        fmt::format("mode is '{}', expected '{}' (the other modes have programs of their "
                    "own)",
                    ShowText(mode), ModeOf(sensor)));
  }
  const std::string verbose = Get(values, "verbose", "1");
  if (verbose != "0" && verbose != "1") {
    throw InputError(fmt::format("verbose is '{}', expected 0 or 1", ShowText(verbose)));
  }
  const std::string id = Get(values, "exp_id", "");
  if (id.find('/') != std::string::npos) {
    throw InputError(fmt::format("exp_id is '{}', expected a name without '/'", ShowText(id)));
  }
}

// The settings file of a baseline, if there is one. Its keys are those of HullSLAM, and those of
// VSLAM-LAB that name the camera.
struct BaselineSettings {
  std::string camera = "rgb_0";
  std::string right_camera = "rgb_1";  // of a stereo camera
  std::vector<std::string> overrides;  // key=value
};

BaselineSettings ReadBaselineSettings(const std::string& file, SensorKind sensor) {
  BaselineSettings result;
  if (file.empty()) {
    return result;
  }
  const std::string camera_key = "cam_" + ModeOf(sensor);
  for (const WrittenSetting& setting : ReadYamlSettings(file)) {
    if (setting.key == camera_key && sensor == SensorKind::kStereo) {
      const std::vector<std::string> names =
          YamlMap(file, "settings").Texts(camera_key, 2, "the left and the right camera");
      result.camera = names[0];
      result.right_camera = names[1];
    } else if (setting.key == camera_key) {
      result.camera = SingleValue(setting);
    } else if (!setting.key.starts_with("cam_")) {
      result.overrides.push_back(setting.key + "=" + SingleValue(setting));
    }
  }
  return result;
}

// The keyframes in the format of VSLAM-LAB. Their stamps are those of the list, exactly.
std::string FormatKeyframes(const Trajectory& keyframes, const VslamlabSequence& sequence) {
  std::string text = "ts (ns),tx (m),ty (m),tz (m),qx,qy,qz,qw\n";
  const std::vector<FramePaths>& frames = sequence.images.frames;
  for (const StampedPose& keyframe : keyframes) {
    auto next = std::lower_bound(
        frames.begin(), frames.end(), keyframe.timestamp,
        [](const FramePaths& frame, double stamp) { return frame.timestamp < stamp; });
    const auto distance = [&](const auto& frame) {
      return std::abs(frame->timestamp - keyframe.timestamp);
    };
    if (next == frames.end() || (next != frames.begin() && distance(next - 1) < distance(next))) {
      --next;
    }
    const Eigen::Vector3d& t = keyframe.world_from_cam.translation;
    const Eigen::Quaterniond& q = keyframe.world_from_cam.rotation;
    text += fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                        sequence.stamps[static_cast<size_t>(next - frames.begin())], t.x(), t.y(),
                        t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

// VSLAM-LAB gives the number of the run, and since 2025 it looks for a name with five digits.
std::vector<std::string> ResultNames(const std::string& id) {
  std::vector<std::string> names = {id};
  const bool is_number =
      std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (is_number && id.size() < 5) {
    names.push_back(std::string(5 - id.size(), '0') + id);
  }
  return names;
}

RunArguments MakeArguments(SensorKind sensor, const Values& values) {
  RunArguments arguments;
  arguments.sensor = sensor;
  arguments.program = ProgramName(sensor);
  arguments.sequence = Get(values, "sequence_path", "");
  arguments.masks = Get(values, "masks", "");
  arguments.preset = Get(values, "preset", "");
  arguments.seed = ParseSeed(Get(values, "seed", "0"));
  arguments.output =
      fs::path(Get(values, "exp_folder", "")) / (Get(values, "exp_id", "") + "_hullslam");
  arguments.quiet = Get(values, "verbose", "1") == "0";
  return arguments;
}

fs::path ResultFile(const fs::path& folder, const std::string& name) {
  return folder / (name + "_KeyFrameTrajectory.csv");
}

struct OpenedImages {
  VslamlabSequence sequence;
  CameraCalibration calibration;
  bool is_mirrored = false;
  std::vector<std::string> overrides;  // key=value
};

OpenedImages OpenImages(SensorKind sensor, const Values& values, const BaselineSettings& baseline) {
  const fs::path calibration = Get(values, "calibration_yaml", "");
  const fs::path folder = Get(values, "sequence_path", "");
  const fs::path list = Get(values, "rgb_csv", "");
  OpenedImages opened;
  opened.overrides = baseline.overrides;
  if (sensor == SensorKind::kStereo) {
    const VslamlabPairNames names{baseline.camera, baseline.right_camera};
    const VslamlabPair pair = ReadVslamlabPair(calibration, names);
    opened.sequence = OpenVslamlabPairs(folder, list, names, pair);
    opened.sequence.images.choices["calibration"] = fs::absolute(calibration).string();
    opened.calibration = pair.calibration;
    CheckPairs(list, opened.sequence.images, pair.calibration.camera);
    return opened;
  }
  const VslamlabCamera camera = ReadVslamlabCamera(calibration, baseline.camera);
  const bool uses_depth = sensor == SensorKind::kRgbd;
  if (uses_depth && camera.depth_name.empty()) {
    throw InputError(fmt::format("{}: the camera '{}' has no depth_name, expected one for RGB-D",
                                 calibration.string(), ShowText(baseline.camera)));
  }
  if (uses_depth) {
    opened.overrides.insert(opened.overrides.begin(),
                            fmt::format("DepthMapFactor={}", camera.depth_factor));
  }
  opened.sequence =
      OpenVslamlabSequence(folder, list, baseline.camera, uses_depth ? camera.depth_name : "");
  opened.calibration = camera.calibration;
  opened.is_mirrored = camera.is_mirrored;
  return opened;
}

int Run(SensorKind sensor, int argc, char** argv) {
  CLI::App app(fmt::format("Runs SLAM ({}) for VSLAM-LAB. Writes EXP_FOLDER/"
                           "EXP_ID_KeyFrameTrajectory.csv, and all other results into the folder "
                           "EXP_FOLDER/EXP_ID_hullslam.",
                           ModeOf(sensor)),
               ProgramName(sensor));
  std::vector<std::string> words;
  app.add_option("KEY:VALUE", words, KeysHelp())->required();
  AddVersionAndExitCodes(app, "done", "the run failed");
  if (!ParseCommandLine(app, argc, argv)) {
    return kDone;
  }
  const Values values = ParseValues(words);
  CheckChoices(sensor, values);
  const BaselineSettings baseline = ReadBaselineSettings(Get(values, "settings_yaml", ""), sensor);
  const fs::path folder = Get(values, "exp_folder", "");
  const std::string id = Get(values, "exp_id", "");
  const RunArguments arguments = MakeArguments(sensor, values);
  const OpenedImages opened = OpenImages(sensor, values, baseline);
  PrintWarnings(opened.sequence.images);
  LoadedSettings settings = LoadSettings(opened.calibration, Get(values, "calibration_yaml", ""),
                                         arguments.preset, opened.overrides);
  settings.options.sensor = sensor;
  for (const std::string& name : ResultNames(id)) {
    fs::remove(ResultFile(folder, name));  // a run that fails must not leave an older result
  }
  const int code = RunSlam(arguments, std::move(settings), opened.sequence.images, {});
  if (code == kDone) {
    Trajectory keyframes = ReadTrajectory(arguments.output / "keyframes.txt");
    keyframes = opened.is_mirrored ? MirrorY(std::move(keyframes)) : std::move(keyframes);
    for (const std::string& name : ResultNames(id)) {
      WriteFileAtomically(ResultFile(folder, name), FormatKeyframes(keyframes, opened.sequence));
    }
  }
  return code;
}

}  // namespace

int RunVslamlabProgram(SensorKind sensor, int argc, char** argv) {
  return RunMain([&](int count, char** words) { return Run(sensor, count, words); }, argc, argv);
}

}  // namespace hullslam
