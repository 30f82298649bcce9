// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/euroc_sequence.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "sequences/euroc_states.h"
#include "sequences/image_list.h"
#include "sequences/stereo_loading.h"
#include "sequences/stereo_pairing.h"
#include "settings/rotation_matrix.h"
#include "settings/yaml_lens.h"
#include "settings/yaml_map.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

void ExpectText(const YamlMap& file, std::string_view key, std::string_view expected) {
  const std::string text = file.Text(key);
  if (text != expected) {
    file.Fail(key, fmt::format("is '{}', expected '{}'; HullSLAM has no other model",
                               ShowText(text), expected));
  }
}

Rigid3 ReadPose(const YamlMap& file, const char* key) {
  const std::vector<double> data = file.Map(key).Numbers("data", 16, "a 4x4 matrix by rows");
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
  const auto rotation = RotationOf(matrix.topLeftCorner<3, 3>());
  if (!rotation || matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    file.Fail(key, "is not a rigid transform, expected a rotation, a translation and 0 0 0 1");
  }
  return {*rotation, matrix.topRightCorner<3, 1>()};
}

EurocCamera ParseCamera(const YamlMap& file) {
  ExpectText(file, "camera_model", "pinhole");
  const std::vector<double> focal = file.Numbers("intrinsics", 4, "fu fv cu cv");
  const std::vector<double> size = file.Numbers("resolution", 2, "width height");
  EurocCamera camera;
  camera.calibration.camera = {.fx = focal[0],
                               .fy = focal[1],
                               .cx = focal[2],
                               .cy = focal[3],
                               .width = file.Pixels("resolution", size[0]),
                               .height = file.Pixels("resolution", size[1])};
  ReadLens(file, "distortion_model", "distortion_coefficients", camera.calibration.camera);
  camera.calibration.frames_per_second = file.Number("rate_hz");
  camera.body_from_cam = ReadPose(file, "T_BS");
  return camera;
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

std::vector<double> StampsOf(const std::vector<FramePaths>& frames) {
  std::vector<double> stamps;
  for (const FramePaths& frame : frames) {
    stamps.push_back(frame.timestamp);
  }
  return stamps;
}

void PairImages(const fs::path& root, double frames_per_second, ImageSequence& sequence) {
  const std::vector<FramePaths> left = ReadImages(root / "cam0", sequence.warnings);
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

// Adds the ground truth of the camera, if there is one.
void AddStates(const fs::path& root, const Rigid3& body_from_cam, ImageSequence& sequence) {
  const fs::path states = root / "state_groundtruth_estimate0" / "data.csv";
  std::error_code error;
  if (fs::exists(states, error)) {
    try {
      sequence.converted_groundtruth = ReadEurocStates(states, body_from_cam);
    } catch (const InputError& fault) {
      sequence.warnings.push_back(
          fmt::format("{}; the run goes on without ground truth", fault.what()));
    }
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
  sequence.camera = ReadEurocCamera(root / "cam0" / "sensor.yaml");
  sequence.images.frames = ReadImages(root / "cam0", sequence.images.warnings);
  SelectFrames(folder, selection, sequence.images);
  LeaveOutMissing(sequence.images);
  AddStates(root, sequence.camera.body_from_cam, sequence.images);
  return sequence;
}

StereoSequence OpenEurocPairs(const fs::path& folder, const FrameSelection& selection) {
  const fs::path root = FindRoot(folder);
  const EurocCamera left = ReadEurocCamera(root / "cam0" / "sensor.yaml");
  const EurocCamera right = ReadEurocCamera(root / "cam1" / "sensor.yaml");
  const auto rectifier = std::make_shared<const StereoRectifier>(
      StereoCalibration{.left = left.calibration.camera,
                        .right = right.calibration.camera,
                        .right_from_left = Inverse(right.body_from_cam) * left.body_from_cam},
      root.string());
  StereoSequence sequence{.images = {}, .calibration = left.calibration};
  sequence.images.dataset = "euroc_stereo";
  sequence.calibration.camera = rectifier->camera();
  PairImages(root, left.calibration.frames_per_second, sequence.images);
  SelectFrames(folder, selection, sequence.images);
  LeaveOutMissing(sequence.images);
  LoadPairs(rectifier, sequence.images);
  AddStates(root, left.body_from_cam, sequence.images);
  const fs::path truth = folder / "groundtruth.txt";
  std::error_code error;
  if (!sequence.images.converted_groundtruth && fs::is_regular_file(truth, error)) {
    sequence.images.groundtruth = truth;
  }
  return sequence;
}

}  // namespace hullslam
