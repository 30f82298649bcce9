// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/pose_file.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/plausible.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kPoseColumns = 8;      // stamp, position, rotation
constexpr size_t kMatrixColumns = 12;   // or 16, with the row 0 0 0 1
constexpr size_t kEurocColumns = 17;    // also velocity and biases
constexpr size_t kTartanColumns = 7;    // position, rotation
constexpr int kCovarianceColumns = 21;  // c11 c12 ... c66, the upper triangle by rows

struct Layout {
  size_t columns = kPoseColumns;  // of each row
  size_t first = 0;               // column of the stamp, or of the first element of a matrix
  bool is_w_first = false;
  bool is_matrix = false;  // without stamps, but with the number of the frame if `first` is 1
  bool is_tartan = false;  // of TartanAir, without stamps
  std::optional<size_t> covariance = std::nullopt;  // the first of its 21 columns

  bool HasStamps() const { return !is_matrix && !is_tartan; }
};

// The names of the columns, in small letters and without units, which are in brackets.
std::vector<std::string> NamesOf(std::string_view header) {
  std::vector<std::string> names;
  std::string name;
  int brackets = 0;
  for (const char c : LowerCase(header) + ' ') {
    brackets += c == '[' || c == '(' ? 1 : c == ']' || c == ')' ? -1 : 0;
    if (std::string_view(" ,;\t\r#").find(c) == std::string_view::npos) {
      if (brackets == 0 && c != ']' && c != ')') {
        name += c;
      }
    } else if (!name.empty()) {
      names.push_back(std::exchange(name, {}));
    }
  }
  return names;
}

// Whether the first column is a whole number and the last row of a matrix, if there is one, 0 0
// 0 1. Files of EuRoC have as many columns as numbered matrices of 16 elements, and whole numbers,
// too.
bool IsNumberedMatrix(const TextRow& row) {
  constexpr double kMostFrames = 1e9;
  constexpr std::array kLastRow = {0.0, 0.0, 0.0, 1.0};
  const double number = row.Number(0, "the number of the frame");
  if (number < 0.0 || number > kMostFrames || number != std::floor(number)) {
    return false;
  }
  for (size_t i = kMatrixColumns + 1; i < row.columns.size(); ++i) {
    if (row.Number(i, "an element of the matrix") != kLastRow.at(i - kMatrixColumns - 1)) {
      return false;
    }
  }
  return true;
}

Layout LayoutOf(const TextRow& row) {
  const size_t columns = row.columns.size();
  const std::vector<std::string> names = NamesOf(row.header);
  const auto is_rotation = [](const std::string& name) { return name.starts_with('q'); };
  const auto first = std::find_if(names.begin(), names.end(), is_rotation);
  const auto before = static_cast<size_t>(first - names.begin());
  if (names.size() == columns && before >= 4 &&
      std::count_if(first, names.end(), is_rotation) == 4) {
    Layout layout{columns, before - 4, first->ends_with('w'), false};
    const auto covariance = std::ranges::find(names, "c11");
    if (names.end() - covariance >= kCovarianceColumns &&
        covariance[kCovarianceColumns - 1] == "c66") {
      layout.covariance = static_cast<size_t>(covariance - names.begin());
    }
    return layout;
  }
  if (columns == kMatrixColumns || columns == 16) {
    return {.columns = columns, .is_matrix = true};
  }
  if ((columns == kMatrixColumns + 1 || columns == kEurocColumns) && IsNumberedMatrix(row)) {
    return {.columns = columns, .first = 1, .is_matrix = true};
  }
  if (columns == kEurocColumns) {
    return {.columns = columns, .is_w_first = true};
  }
  if (columns == kTartanColumns) {
    return {.columns = columns, .is_tartan = true};
  }
  if (columns != kPoseColumns) {
    row.Fail(fmt::format(
        "{} columns, expected 8 (timestamp tx ty tz qx qy qz qw), the 12 or 16 of KITTI, the same "
        "behind the number of the frame (KITTI-360), the 7 of TartanAir, or a first line with the "
        "names of the columns",
        columns));
  }
  return {};
}

Rigid3 ReadMatrix(const TextRow& row, size_t first) {
  Eigen::Matrix<double, 3, 4> matrix;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      matrix(i, j) = row.Number(first + static_cast<size_t>(4 * i + j),
                                j == 3 ? "a coordinate" : "an element of the rotation",
                                j == 3 ? kMostMetres : 2.0);
    }
  }
  const std::optional<Rigid3> pose = PoseOfMatrix(matrix);
  if (!pose) {
    row.Fail("the numbers are no matrix of a pose, expected a rotation and a translation by rows");
  }
  return *pose;
}

// Rounded numbers of a quaternion have a length of 1 but for some hundredths. Other columns that
// are taken for one have not.
void CheckLength(const TextRow& row, const std::array<size_t, 4>& columns) {
  constexpr double kMostDifference = 0.1;
  double squares = 0.0;
  for (const size_t column : columns) {
    const double value = row.Number(column, "an element of the quaternion");
    squares += value * value;
  }
  if (std::abs(std::sqrt(squares) - 1.0) > kMostDifference) {
    row.Fail(fmt::format(
        "the columns {} to {} are no quaternion, their length is {:g}, expected 1; a first line "
        "with the names of the columns tells their order",
        std::ranges::min(columns) + 1, std::ranges::max(columns) + 1, std::sqrt(squares)));
  }
}

// The cameras of TartanAir look along x, y is to the right and z is down (NED).
Rigid3 ReadTartanPose(const TextRow& row) {
  constexpr size_t kRotation = 3;  // qx qy qz qw
  const Eigen::Quaterniond ned =
      row.Rotation(kRotation + 3, kRotation, kRotation + 1, kRotation + 2);
  CheckLength(row, {kRotation, kRotation + 1, kRotation + 2, kRotation + 3});
  Eigen::Matrix3d ned_from_cam;
  ned_from_cam << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return {ned * Eigen::Quaterniond(ned_from_cam),
          {row.Number(0, "tx", kMostMetres), row.Number(1, "ty", kMostMetres),
           row.Number(2, "tz", kMostMetres)}};
}

Rigid3 ReadPose(const TextRow& row, const Layout& layout) {
  if (row.columns.size() != layout.columns) {
    row.Fail(fmt::format("{} columns, expected {} as in the first line", row.columns.size(),
                         layout.columns));
  }
  if (layout.is_matrix) {
    return ReadMatrix(row, layout.first);
  }
  if (layout.is_tartan) {
    return ReadTartanPose(row);
  }
  const size_t at = layout.first;
  const size_t x = at + (layout.is_w_first ? 5 : 4);
  const size_t w = layout.is_w_first ? at + 4 : at + 7;
  const Eigen::Quaterniond rotation = row.Rotation(w, x, x + 1, x + 2);
  CheckLength(row, {w, x, x + 1, x + 2});
  return {rotation,
          {row.Number(at + 1, "tx", kMostMetres), row.Number(at + 2, "ty", kMostMetres),
           row.Number(at + 3, "tz", kMostMetres)}};
}

struct Unit {
  double per_second = 1.0;
  const char* name = "";
};

// The unit of the stamps. No clock that counts seconds is beyond 1e11, and today's clocks count
// 1.7e12 ms, 1.7e15 us or 1.7e18 ns. Small stamps in nanoseconds are known by the name alone.
Unit UnitOf(const TextRow& row, double stamp) {
  const bool is_named = row.header.find("[ns]") != std::string_view::npos ||
                        row.header.find("(ns)") != std::string_view::npos;
  const double size = std::abs(stamp);
  if (is_named || size > 1e17) {
    return {1e9, "nanoseconds"};
  }
  return size > 1e14           ? Unit{1e6, "microseconds"}
         : size > kMostSeconds ? Unit{1e3, "milliseconds"}
                               : Unit{};
}

bool IsSame(const Rigid3& a, const Rigid3& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

Eigen::Matrix<double, 6, 6> ReadCovariance(const TextRow& row, size_t column) {
  Eigen::Matrix<double, 6, 6> covariance;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = i; j < 6; ++j) {
      covariance(i, j) = covariance(j, i) = row.Number(column++, "an element of the covariance");
    }
  }
  return covariance;
}

class Reader {
 public:
  explicit Reader(const fs::path& path) : path_(path) {}

  PoseFile Read() {
    ForEachRow(path_, [&](const TextRow& row) { Add(row); });
    if (2 * malformed_ > rows_ || file_.poses.empty()) {
      throw InputError(malformed_ > 0 ? fault_ : path_.string() + ": has no poses");
    }
    if (2 * collisions_ > rows_) {
      throw InputError(fmt::format(
          "{}: {} poses have only {} different time stamps, expected one for each; were the stamps "
          "written with too few digits?",
          path_.string(), rows_ - malformed_, file_.poses.size()));
    }
    if (malformed_ > 0) {
      file_.notes.push_back(fmt::format("{} of {} rows are skipped, the first because of: {}",
                                        malformed_, rows_, fault_));
    }
    if (earlier_ > 0) {
      file_.notes.push_back(
          fmt::format("{}: {} of {} rows are skipped, because they go back in time (the first is "
                      "line {}); does "
                      "the file have two trajectories?",
                      path_.string(), earlier_, rows_, first_earlier_));
    }
    return std::move(file_);
  }

 private:
  void Add(const TextRow& row) {
    ++rows_;
    try {
      if (!layout_) {
        layout_ = LayoutOf(row);
        file_.has_stamps = layout_->HasStamps();
        file_.has_numbers = layout_->is_matrix && layout_->first > 0;
      }
      const StampedPose pose{StampOf(row), ReadPose(row, *layout_)};
      if (layout_->covariance) {
        const Eigen::Matrix<double, 6, 6> covariance = ReadCovariance(row, *layout_->covariance);
        AddPose(row, pose);
        file_.covariances.resize(file_.poses.size(), covariance);
      } else {
        AddPose(row, pose);
      }
    } catch (const InputError& error) {
      fault_ = malformed_ == 0 ? error.what() : fault_;
      ++malformed_;
    }
  }

  double StampOf(const TextRow& row) {
    if (!layout_->HasStamps()) {
      return file_.has_numbers ? row.Number(0, "the number of the frame")
                               : static_cast<double>(rows_ - 1);
    }
    if (row.columns.size() <= layout_->first) {
      row.Fail("has no time stamp");
    }
    const double stamp = row.Number(layout_->first, "timestamp");
    if (!unit_) {
      unit_ = UnitOf(row, stamp);
      if (unit_->per_second != 1.0) {
        file_.notes.push_back(
            fmt::format("{}: the time stamps are taken for {}", path_.string(), unit_->name));
      }
    }
    const double seconds = stamp / unit_->per_second;
    if (std::abs(seconds) > kMostSeconds) {
      row.Fail(fmt::format("timestamp is {:g} s, expected up to {:g} s", seconds, kMostSeconds));
    }
    return seconds;
  }

  void AddPose(const TextRow& row, const StampedPose& pose) {
    Trajectory& poses = file_.poses;
    if (poses.empty() || pose.timestamp > poses.back().timestamp) {
      poses.push_back(pose);
    } else if (pose.timestamp == poses.back().timestamp) {
      collisions_ += IsSame(pose.world_from_cam, poses.back().world_from_cam) ? 0 : 1;
      poses.back() = pose;
    } else {
      first_earlier_ = earlier_ == 0 ? row.line : first_earlier_;
      ++earlier_;
    }
  }

  const fs::path& path_;
  std::optional<Layout> layout_;
  std::optional<Unit> unit_;
  PoseFile file_;
  size_t rows_ = 0;
  size_t malformed_ = 0;
  size_t collisions_ = 0;
  size_t earlier_ = 0;
  int first_earlier_ = 0;
  std::string fault_;
};

}  // namespace

std::optional<Rigid3> PoseOfMatrix(const Eigen::Matrix<double, 3, 4>& matrix) {
  constexpr double kTolerance = 1e-2;  // files round their numbers to 6 decimals or fewer
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  if (!(rotation * rotation.transpose()).isApprox(Eigen::Matrix3d::Identity(), kTolerance) ||
      rotation.determinant() < 0.0) {
    return std::nullopt;
  }
  return Rigid3{Eigen::Quaterniond(rotation).normalized(), matrix.col(3)};
}

PoseFile ReadPoseFile(const fs::path& path) {
  PoseFile file = Reader(path).Read();
  const fs::path times = path.parent_path() / "times.txt";
  std::error_code error;
  if (!file.has_stamps && fs::is_regular_file(times, error)) {
    std::vector<double> stamps;
    ForEachRow(times, [&](const TextRow& row) { stamps.push_back(row.Stamp(0)); });
    const bool increase =
        std::adjacent_find(stamps.begin(), stamps.end(), std::greater_equal<>()) == stamps.end();
    if (increase && FitsFrames(file, stamps.size())) {
      SetStamps(path, stamps, file);
    }
  }
  return file;
}

bool FitsFrames(const PoseFile& file, size_t frames) {
  return file.has_numbers ? file.poses.back().timestamp < static_cast<double>(frames)
                          : file.poses.size() == frames;
}

void SetStamps(const fs::path& path, std::span<const double> stamps, PoseFile& file) {
  if (!FitsFrames(file, stamps.size())) {
    throw InputError(fmt::format(
        "{}: its {} poses have no time stamps{}, and there are {} to compare with; "
        "expected "
        "as many, or times.txt beside it with one time per line",
        path.string(), file.poses.size(),
        file.has_numbers ? fmt::format(" but numbers up to {:g}", file.poses.back().timestamp)
                         : std::string(),
        stamps.size()));
  }
  for (StampedPose& pose : file.poses) {
    pose.timestamp = stamps[static_cast<size_t>(pose.timestamp)];
  }
  file.has_stamps = true;
}

}  // namespace hullslam
