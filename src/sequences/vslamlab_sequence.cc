// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/vslamlab_sequence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "files/plausible.h"
#include "files/read_text.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "sequences/image_list.h"
#include "sequences/stereo_loading.h"
#include "settings/yaml_lens.h"
#include "settings/yaml_map.h"
#include "settings/yaml_pose.h"
#include "util/shown_text.h"
#include "util/trim.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The entry of a camera in the list of a calibration.yaml.
YamlMap FindCamera(const fs::path& file, const std::string& name) {
  std::vector<std::string> names;
  for (const YamlMap& entry :
       YamlMap(file, "a calibration.yaml of VSLAM-LAB with a list 'cameras'").Maps("cameras")) {
    if (entry.Text("cam_name") == name) {
      return entry;
    }
    names.push_back(ShowText(entry.Text("cam_name")));
  }
  throw InputError(fmt::format("{}: has no camera '{}', expected one of: {}", file.string(),
                               ShowText(name), fmt::join(names, ", ")));
}

void ReadLensOf(const YamlMap& entry, PinholeCamera& camera) {
  const char* const key = entry.Has("distortion_type") ? "distortion_type" : "cam_model";
  if (entry.Text(key) != "pinhole") {
    ReadLens(entry, key, "distortion_coefficients", camera);
  }
}

VslamlabCamera ReadEntry(const YamlMap& entry) {
  const std::vector<double> focal = entry.Numbers("focal_length", 2, "fx fy");
  const std::vector<double> center = entry.Numbers("principal_point", 2, "cx cy");
  const std::vector<double> size = entry.Numbers("image_dimension", 2, "width height");
  VslamlabCamera result;
  result.is_mirrored = focal[1] < 0.0;
  PinholeCamera& camera = result.calibration.camera;
  camera.fx = focal[0];
  camera.fy = std::abs(focal[1]);
  camera.cx = center[0];
  camera.cy = center[1];
  camera.width = entry.Pixels("image_dimension", size[0]);
  camera.height = entry.Pixels("image_dimension", size[1]);
  ReadLensOf(entry, camera);
  result.calibration.frames_per_second = entry.Number("fps");
  if (entry.Has("depth_name")) {
    result.depth_name = entry.Text("depth_name");
    result.depth_factor = entry.Number("depth_factor");
  }
  return result;
}

// The pose of a camera on the body. VSLAM-LAB has renamed its key.
Rigid3 BodyFromCamera(const YamlMap& entry) {
  const char* const key = entry.Has("T_SC") ? "T_SC" : "T_BS";
  return ReadRigid3(entry, key);
}

// ---- rgb.csv

std::vector<std::string_view> SplitCsv(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const size_t comma = std::min(line.find(','), line.size());
    cells.push_back(Trim(line.substr(0, comma)));
    if (comma == line.size()) {
      return cells;
    }
    line.remove_prefix(comma + 1);
  }
}

// The two columns of a camera.
struct ImageColumns {
  size_t stamp = 0;
  size_t path = 0;
};

class CsvReader {
 public:
  CsvReader(const fs::path& folder, const fs::path& csv) : folder_(folder), csv_(csv) {}

  ImageColumns Find(const std::vector<std::string_view>& header, const std::string& name) const {
    const auto find = [&](const std::string& column) {
      const auto found = std::find(header.begin(), header.end(), column);
      if (found == header.end()) {
        throw InputError(fmt::format("{}:1: has no column '{}', expected one of: {}", csv_.string(),
                                     ShowText(column),
                                     ShowText(fmt::format("{}", fmt::join(header, ", ")))));
      }
      return static_cast<size_t>(found - header.begin());
    };
    return {find("ts_" + name + " (ns)"), find("path_" + name)};
  }

  int64_t Stamp(const TextRow& row, size_t column) const {
    const std::string_view text = row.columns[column];
    int64_t stamp = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), stamp);
    if (error != std::errc() || end != text.data() + text.size() || stamp < 0) {
      row.Fail(
          fmt::format("the time stamp is '{}', expected nanoseconds", ShowText(std::string(text))));
    }
    return stamp;
  }

  fs::path Path(const TextRow& row, size_t column) const { return ImageFile(row, column, folder_); }

 private:
  const fs::path& folder_;
  const fs::path& csv_;
};

// The path of the list as it is written down, so that the sequence can be moved with its list.
std::string RelativeIfInside(const fs::path& csv, const fs::path& folder) {
  std::error_code error;
  const fs::path relative = fs::relative(csv, folder, error);
  const bool is_inside = !error && !relative.empty() && *relative.begin() != "..";
  return is_inside ? relative : fs::absolute(csv, error);
}

}  // namespace

VslamlabCamera ReadVslamlabCamera(const fs::path& file, const std::string& name) {
  const VslamlabCamera camera = ReadEntry(FindCamera(file, name));
  MakeSettings(camera.calibration, file.string());  // checks the numbers
  return camera;
}

VslamlabPair ReadVslamlabPair(const fs::path& file, const VslamlabPairNames& names) {
  const YamlMap left = FindCamera(file, names[0]);
  const YamlMap right = FindCamera(file, names[1]);
  VslamlabPair pair{nullptr, ReadVslamlabCamera(file, names[0]).calibration};
  const StereoCalibration calibration{
      .left = pair.calibration.camera,
      .right = ReadVslamlabCamera(file, names[1]).calibration.camera,
      .right_from_left = Inverse(BodyFromCamera(right)) * BodyFromCamera(left)};
  pair.rectifier = std::make_shared<const StereoRectifier>(
      calibration,
      fmt::format("{}: {} and {}", file.string(), ShowText(names[0]), ShowText(names[1])));
  pair.calibration.camera = pair.rectifier->camera();
  return pair;
}

VslamlabSequence OpenVslamlabPairs(const fs::path& folder, const fs::path& csv,
                                   const VslamlabPairNames& names, const VslamlabPair& pair) {
  VslamlabSequence sequence = OpenVslamlabSequence(folder, csv, names[0], names[1]);
  for (FramePaths& frame : sequence.images.frames) {
    frame.right = std::exchange(frame.depth, {});
  }
  sequence.images.dataset = "vslamlab_stereo";
  sequence.images.choices.erase("depth_name");
  sequence.images.choices["right_name"] = names[1];
  LoadPairs(pair.rectifier, sequence.images);
  return sequence;
}

VslamlabSequence OpenVslamlabSequence(const fs::path& folder, const fs::path& csv,
                                      const std::string& image_name,
                                      const std::string& depth_name) {
  constexpr double kNanosecond = 1e-9;
  const std::string text = ReadText(csv);
  const CsvReader reader(folder, csv);
  VslamlabSequence sequence;
  sequence.images.dataset = "vslamlab";
  sequence.images.choices = {{"rgb_csv", RelativeIfInside(csv, folder)},
                             {"image_name", image_name},
                             {"depth_name", depth_name}};
  ListedFrames list;
  ImageColumns image;
  ImageColumns depth;
  size_t columns = 0;
  TextRow row{csv, 0, {}};
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = Trim(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
    ++row.line;
    if (line.empty()) {
      continue;
    }
    row.columns = SplitCsv(line);
    if (columns == 0) {
      columns = row.columns.size();
      image = reader.Find(row.columns, image_name);
      depth = depth_name.empty() ? ImageColumns() : reader.Find(row.columns, depth_name);
      continue;
    }
    CheckColumns(row, columns, "those of the first line");
    const int64_t stamp = reader.Stamp(row, image.stamp);
    FramePaths frame{static_cast<double>(stamp) * kNanosecond, reader.Path(row, image.path)};
    if (!depth_name.empty()) {
      reader.Stamp(row, depth.stamp);
      frame.depth = reader.Path(row, depth.path);
    }
    if (AddFrame(row, std::move(frame), list)) {
      sequence.stamps.push_back(stamp);
    }
  }
  sequence.images.frames = TakeFrames(csv, std::move(list), sequence.images.warnings);
  sequence.images.available = sequence.images.frames.size();
  CheckImagesExist(sequence.images.frames);
  return sequence;
}

}  // namespace hullslam
