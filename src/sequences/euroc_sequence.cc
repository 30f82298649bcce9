// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/euroc_sequence.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"
#include "sequences/euroc_states.h"
#include "sequences/image_list.h"
#include "sequences/stereo_pairing.h"
#include "settings/tool_calibration.h"
#include "settings/yaml_map.h"
#include "settings/yaml_pose.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

EurocCamera ParseCamera(const YamlMap& file) {
  EurocCamera camera;
  camera.calibration.camera = ReadPinhole(file, "distortion_coefficients");
  camera.calibration.frames_per_second = file.Number("rate_hz");
  camera.body_from_cam = ReadRigid3(file, "T_BS");
  return camera;
}

// The camchain of a sequence; empty if there is none.
fs::path FindCamchain(const fs::path& root) {
  std::error_code error;
  for (const fs::path& folder : {root, root / "dso", root / "..", root / ".." / "dso"}) {
    if (!fs::is_directory(folder, error)) {
      continue;
    }
    for (const fs::path& file : ListFolder(folder)) {
      const std::string name = file.filename().string();
      const bool is_yaml = name.ends_with(".yaml") || name.ends_with(".yml");
      if (is_yaml && name.find("camchain") != std::string::npos) {
        return file.lexically_normal();
      }
    }
  }
  return {};
}

double RateByStamps(const std::vector<FramePaths>& frames) {
  return MeanRate(frames, CameraCalibration().frames_per_second);
}

struct Calibration {
  EurocCamera left;
  std::optional<StereoCalibration> pair;  // if it was asked for
  fs::path file;
};

Calibration OfSensorFiles(const fs::path& root, bool need_pair) {
  Calibration calibration;
  calibration.file = root / "cam0" / "sensor.yaml";
  calibration.left = ReadEurocCamera(calibration.file);
  if (need_pair) {
    const EurocCamera& left = calibration.left;
    const EurocCamera right = ReadEurocCamera(root / "cam1" / "sensor.yaml");
    calibration.pair = {.left = left.calibration.camera,
                        .right = right.calibration.camera,
                        .right_from_left = Inverse(right.body_from_cam) * left.body_from_cam};
  }
  return calibration;
}

Calibration OfCamchain(const fs::path& file, double frames_per_second, bool need_pair) {
  const YamlMap camchain(file, "a camchain of Kalibr");
  Calibration calibration;
  calibration.file = file;
  CameraCalibration& left = calibration.left.calibration;
  left.camera = ReadPinhole(camchain.Map("cam0"), "distortion_coeffs");
  left.frames_per_second = frames_per_second;
  MakeSettings(left, file.string());  // checks the numbers
  calibration.left.body_from_cam = ReadImuFromCam0(camchain);
  if (need_pair) {
    calibration.pair = ReadCamchainPair(camchain);
  }
  return calibration;
}

// Nothing if the folder has no calibration.
std::optional<Calibration> FindCalibration(const fs::path& root, double frames_per_second,
                                           bool need_pair) {
  std::error_code error;
  if (fs::exists(root / "cam0" / "sensor.yaml", error)) {
    return OfSensorFiles(root, need_pair);
  }
  const fs::path camchain = FindCamchain(root);
  return camchain.empty() ? std::nullopt
                          : std::optional(OfCamchain(camchain, frames_per_second, need_pair));
}

void CheckExactColumns(const TextRow& row, size_t count, const char* names) {
  if (row.columns.size() != count) {
    row.Fail(fmt::format("{} column(s), expected {}: {}", row.columns.size(), count, names));
  }
}

std::vector<FramePaths> ReadImages(const fs::path& camera, std::vector<std::string>& warnings) {
  const fs::path list = camera / "data.csv";
  ListedFrames frames;
  ForEachRow(list, [&](const TextRow& row) {
    CheckExactColumns(row, 2, "timestamp [ns], filename");
    AddFrame(row, {EurocSeconds(row), ImageFile(row, 1, camera / "data")}, frames);
  });
  return TakeFrames(list, std::move(frames), warnings);
}

void PairImages(const fs::path& root, const std::vector<FramePaths>& left, double frames_per_second,
                ImageSequence& sequence) {
  const std::vector<FramePaths> right = ReadImages(root / "cam1", sequence.warnings);
  std::vector<FramePaths>& pairs = sequence.frames;
  for (const IndexPair& pair :
       PairStereoStamps(root.string(), {"cam0", StampsOf(left)}, {"cam1", StampsOf(right)},
                        frames_per_second, sequence.warnings)) {
    pairs.push_back(left[pair.first]);
    pairs.back().right = right[pair.second].image;
  }
  for (size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].number = i;
  }
  sequence.unpaired = left.size() - pairs.size();
}

// Adds the ground truth of the camera, if there is one. The pose of the camera on the body is not
// known without a calibration.
void AddStates(const fs::path& root, const std::optional<Rigid3>& body_from_cam,
               ImageSequence& sequence) {
  std::error_code error;
  fs::path states = root / "state_groundtruth_estimate0" / "data.csv";
  if (!fs::exists(states, error)) {
    states = root / "mocap0" / "data.csv";
  }
  if (!fs::exists(states, error)) {
    return;
  }
  try {
    if (!body_from_cam) {
      throw InputError(states.string() +
                       ": cannot be used, because the folder has no calibration with the pose of "
                       "the camera on the body");
    }
    sequence.converted_groundtruth = ReadEurocStates(states, *body_from_cam);
  } catch (const InputError& fault) {
    sequence.warnings.push_back(
        fmt::format("{}; the run goes on without ground truth", fault.what()));
  }
}

fs::path FindRoot(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& root : {folder / "mav0", folder}) {
    if (fs::is_directory(root / "cam0", error)) {
      return root;
    }
  }
  const auto is_sequence = [&](const fs::path& other) {
    return fs::is_directory(other / "mav0" / "cam0", error);
  };
  throw InputError(folder.string() +
                   ": has no folder mav0/cam0, expected a sequence of EuRoC in the format ASL" +
                   SuggestFolder(folder, is_sequence));
}

}  // namespace

EurocCamera ReadEurocCamera(const fs::path& path) {
  const EurocCamera camera = ParseCamera(YamlMap(path, "a sensor.yaml of EuRoC"));
  MakeSettings(camera.calibration, path.string());  // checks the numbers
  return camera;
}

EurocSequence OpenEurocSequence(const fs::path& folder, const FrameSelection& selection) {
  const fs::path root = FindRoot(folder);
  EurocSequence sequence;
  sequence.images.dataset = "euroc";
  sequence.images.frames = ReadImages(root / "cam0", sequence.images.warnings);
  const auto calibration = FindCalibration(root, RateByStamps(sequence.images.frames), false);
  std::optional<Rigid3> body_from_cam;
  if (calibration) {
    sequence.camera = calibration->left;
    sequence.calibration = calibration->file.string();
    body_from_cam = calibration->left.body_from_cam;
  }
  SelectFrames(folder, selection, sequence.images);
  LeaveOutMissing(sequence.images);
  LoadWithoutDepth(sequence.images);
  AddStates(root, body_from_cam, sequence.images);
  return sequence;
}

StereoSequence OpenEurocPairs(const fs::path& folder, const FrameSelection& selection,
                              std::shared_ptr<const StereoRectifier> rectifier) {
  const fs::path root = FindRoot(folder);
  StereoSequence sequence;
  sequence.images.dataset = "euroc_stereo";
  const std::vector<FramePaths> left = ReadImages(root / "cam0", sequence.images.warnings);
  const auto calibration = FindCalibration(root, RateByStamps(left), rectifier == nullptr);
  if (rectifier == nullptr) {
    if (!calibration) {
      throw InputError(root.string() +
                       ": has neither cam0/sensor.yaml nor a camchain of Kalibr, expected the "
                       "calibration of both cameras");
    }
    rectifier =
        std::make_shared<const StereoRectifier>(*calibration->pair, calibration->file.string());
  }
  sequence.calibration.camera = rectifier->camera();
  sequence.calibration.frames_per_second =
      calibration ? calibration->left.calibration.frames_per_second : RateByStamps(left);
  PairImages(root, left, sequence.calibration.frames_per_second, sequence.images);
  SelectFrames(folder, selection, sequence.images);
  LeaveOutMissing(sequence.images);
  LoadWithoutDepth(sequence.images);
  RectifyPairs(rectifier, sequence.images);
  AddStates(root, calibration ? std::optional(calibration->left.body_from_cam) : std::nullopt,
            sequence.images);
  const fs::path truth = folder / "groundtruth.txt";
  std::error_code error;
  if (!sequence.images.converted_groundtruth && fs::is_regular_file(truth, error)) {
    sequence.images.groundtruth = truth;
  }
  return sequence;
}

}  // namespace hullslam
