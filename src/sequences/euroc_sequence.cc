// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/euroc_sequence.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/read_text.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "sequences/euroc_states.h"
#include "sequences/image_list.h"
#include "settings/yaml_storage.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// OpenCV requires the line %YAML:1.0, which the files of EuRoC do not have.
std::string WithYamlLine(std::string text) {
  return text.starts_with("%YAML") ? std::move(text) : "%YAML:1.0\n" + text;
}

// The values of a sensor.yaml.
class SensorFile {
 public:
  explicit SensorFile(fs::path file)
      : file_(std::move(file)),
        original_(ReadText(file_, 1'000'000)),
        text_(WithYamlLine(original_)),
        storage_(ParseYaml(file_, text_, added_lines())) {
    if (!storage_.root().isMap()) {
      throw InputError(file_.string() + ": has no keys, expected a sensor.yaml of EuRoC");
    }
  }

  const fs::path& path() const { return file_; }
  int added_lines() const { return text_.size() > original_.size() ? 1 : 0; }

  [[noreturn]] void Fail(const char* key, const std::string& what) const {
    throw InputError(fmt::format("{}: {} {}", Origin(key), key, what));
  }

  cv::FileNode Find(const char* key) const {
    const cv::FileNode node = storage_[key];
    if (node.empty()) {
      throw InputError(
          fmt::format("{}: {} is not given, expected a sensor.yaml of EuRoC", file_.string(), key));
    }
    return node;
  }

  std::vector<double> Numbers(const char* key, const cv::FileNode& node, size_t count,
                              const char* names) const {
    if (!node.isSeq() || node.size() != count) {
      Fail(key, fmt::format("has {} value(s), expected {} numbers: {}",
                            node.isSeq() ? node.size() : 1, count, names));
    }
    std::vector<double> numbers;
    for (const cv::FileNode& element : node) {
      numbers.push_back(Number(key, element));
    }
    return numbers;
  }

  double Number(const char* key, const cv::FileNode& node) const {
    constexpr double kMost = 1e9;
    const bool is_number = node.isInt() || node.isReal();
    const double value = is_number ? static_cast<double>(node) : 0.0;
    if (!is_number || !std::isfinite(value) || std::abs(value) > kMost) {
      Fail(key, "has a value that is not a number of reasonable size");
    }
    return value;
  }

  void ExpectText(const char* key, std::string_view expected) const {
    const cv::FileNode node = Find(key);
    const std::string text = node.isString() ? node.string() : std::string();
    if (text != expected) {
      Fail(key, fmt::format("is '{}', expected '{}'; HullSLAM has no other model", ShowText(text),
                            expected));
    }
  }

 private:
  // FILE:LINE of a key of the top level.
  std::string Origin(std::string_view key) const {
    int line = 1 - added_lines();
    for (size_t begin = 0; begin < text_.size(); ++line) {
      const std::string_view rest = std::string_view(text_).substr(begin);
      if (rest.starts_with(key) && rest.substr(key.size()).starts_with(':')) {
        return fmt::format("{}:{}", file_.string(), line);
      }
      begin += rest.find('\n') == std::string_view::npos ? rest.size() : rest.find('\n') + 1;
    }
    return file_.string();
  }

  fs::path file_;
  std::string original_;
  std::string text_;
  cv::FileStorage storage_;
};

int WholeNumber(const SensorFile& file, const char* key, double value) {
  constexpr double kMost = 1e6;
  if (value != std::floor(value) || value < 1.0 || value > kMost) {
    file.Fail(key, fmt::format("has the value '{:g}', expected a number of pixels", value));
  }
  return static_cast<int>(value);
}

Rigid3 ReadPose(const SensorFile& file, const char* key) {
  const cv::FileNode node = file.Find(key);
  if (!node.isMap()) {
    file.Fail(key, "is not a matrix, expected cols, rows and data");
  }
  const std::vector<double> data = file.Numbers(key, node["data"], 16, "a 4x4 matrix by rows");
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-3;  // files round their numbers
  const bool is_rotation =
      (rotation * rotation.transpose()).isApprox(Eigen::Matrix3d::Identity(), kTolerance) &&
      rotation.determinant() > 0.0;
  if (!is_rotation || matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    file.Fail(key, "is not a rigid transform, expected a rotation, a translation and 0 0 0 1");
  }
  return {Eigen::Quaterniond(rotation).normalized(), matrix.topRightCorner<3, 1>()};
}

EurocCamera ParseCamera(const SensorFile& file) {
  file.ExpectText("camera_model", "pinhole");
  file.ExpectText("distortion_model", "radial-tangential");
  const std::vector<double> focal =
      file.Numbers("intrinsics", file.Find("intrinsics"), 4, "fu fv cu cv");
  const std::vector<double> lens = file.Numbers(
      "distortion_coefficients", file.Find("distortion_coefficients"), 4, "k1 k2 p1 p2");
  const std::vector<double> size =
      file.Numbers("resolution", file.Find("resolution"), 2, "width height");
  EurocCamera camera;
  camera.calibration.camera = {.fx = focal[0],
                               .fy = focal[1],
                               .cx = focal[2],
                               .cy = focal[3],
                               .k1 = lens[0],
                               .k2 = lens[1],
                               .p1 = lens[2],
                               .p2 = lens[3],
                               .width = WholeNumber(file, "resolution", size[0]),
                               .height = WholeNumber(file, "resolution", size[1])};
  camera.calibration.frames_per_second = file.Number("rate_hz", file.Find("rate_hz"));
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
  const SensorFile file(path);
  EurocCamera camera;
  try {
    camera = ParseCamera(file);
  } catch (const cv::Exception& error) {
    FailParsing(path, error, file.added_lines());
  }
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
  const fs::path states = root / "state_groundtruth_estimate0" / "data.csv";
  std::error_code error;
  if (fs::exists(states, error)) {
    try {
      sequence.images.converted_groundtruth =
          ReadEurocStates(states, sequence.camera.body_from_cam);
    } catch (const InputError& fault) {
      sequence.images.warnings.push_back(
          fmt::format("{}; the run goes on without ground truth", fault.what()));
    }
  }
  return sequence;
}

}  // namespace hullslam
