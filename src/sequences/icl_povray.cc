// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/icl_povray.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/plausible.h"
#include "files/read_text.h"
#include "files/text_rows.h"
#include "geometry/mirror.h"
#include "hullslam/util/error.h"
#include "sequences/icl_groundtruth.h"
#include "sequences/image_list.h"
#include "util/shown_text.h"
#include "util/trim.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// The name of an image, split into scene and index: "scene_00_0012.png".
struct FrameName {
  std::string scene;
  size_t index = 0;
};

std::optional<FrameName> ParseName(const fs::path& file) {
  constexpr std::string_view kBegin = "scene_";
  const std::string stem = file.stem().string();
  const size_t last = stem.rfind('_');
  if (file.extension() != ".png" || !stem.starts_with(kBegin) || last < kBegin.size()) {
    return std::nullopt;
  }
  size_t index = 0;
  const char* const end = stem.data() + stem.size();
  const auto [at, error] = std::from_chars(stem.data() + last + 1, end, index);
  if (error != std::errc() || at != end || index > kMostImages) {
    return std::nullopt;
  }
  return FrameName{stem.substr(0, last), index};
}

// The three numbers of "[x, y, z]"; absent if the text does not begin with such a vector. Any text
// may follow the bracket.
std::optional<Eigen::Vector3d> ParseVector(std::string_view text) {
  const size_t open = text.find('[');
  const size_t close = text.find(']');
  if (open != 0 || close == std::string_view::npos) {
    return std::nullopt;
  }
  text = text.substr(1, close - 1);
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    const size_t comma = text.find(',');
    const bool is_last = comma == std::string_view::npos;
    if (is_last != (i == 2) || !ParseFinite(Trim(text.substr(0, comma)), vector[i]) ||
        std::abs(vector[i]) > kMostMetres) {
      return std::nullopt;
    }
    text.remove_prefix(is_last ? text.size() : comma + 1);
  }
  return vector;
}

using Vectors = std::map<std::string, Eigen::Vector3d, std::less<>>;

// The vectors cam_pos, cam_dir and cam_up of a file.
Vectors ReadVectors(const fs::path& path) {
  constexpr size_t kMostBytes = 100'000;
  const std::string bytes = ReadText(path, kMostBytes);
  const std::string_view text = bytes;
  Vectors vectors;
  int line = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view row = text.substr(begin, end - begin);
    begin = end + 1;
    ++line;
    const size_t equals = row.find('=');
    const std::string_view key = Trim(row.substr(0, equals));
    if (equals == std::string_view::npos ||
        (key != "cam_pos" && key != "cam_dir" && key != "cam_up")) {
      continue;
    }
    const std::string_view value = Trim(row.substr(equals + 1));
    const std::optional<Eigen::Vector3d> vector = ParseVector(value);
    if (!vector) {
      throw InputError(fmt::format("{}:{}: {} is '{}', expected three numbers, [x, y, z]",
                                   path.string(), line, key, ShowText(value)));
    }
    vectors[std::string(key)] = *vector;
  }
  return vectors;
}

const Eigen::Vector3d& VectorOf(const Vectors& vectors, const char* key, const fs::path& path) {
  const auto it = vectors.find(key);
  if (it == vectors.end()) {
    throw InputError(fmt::format(
        "{}: {} is not given, expected the lines of a camera of POVRay: cam_pos, cam_dir, cam_up",
        path.string(), key));
  }
  return it->second;
}

}  // namespace

bool HasPovrayFrames(const fs::path& folder) {
  const std::vector<fs::path> files = ListFolder(folder);
  return std::any_of(files.begin(), files.end(),
                     [](const fs::path& file) { return ParseName(file).has_value(); });
}

std::vector<FramePaths> ListPovrayFrames(const fs::path& folder) {
  std::map<size_t, fs::path> images;
  std::string scene;
  for (const fs::path& file : ListFolder(folder)) {
    const std::optional<FrameName> name = ParseName(file);
    if (!name) {
      continue;
    }
    if (!images.empty() && (name->scene != scene || images.contains(name->index))) {
      throw InputError(fmt::format("{}: has images of two scenes, such as {} and {}",
                                   folder.string(), images.begin()->second.filename().string(),
                                   file.filename().string()));
    }
    scene = name->scene;
    images.emplace(name->index, file);
  }
  if (images.empty()) {
    throw InputError(folder.string() + ": has no images scene_NN_NNNN.png");
  }
  std::vector<FramePaths> frames;
  for (auto& [index, image] : images) {
    fs::path depth = image;
    depth.replace_extension(".depth");
    frames.push_back({static_cast<double>(index) / kIclFramesPerSecond, std::move(image),
                      std::move(depth), frames.size()});
  }
  return frames;
}

Rigid3 ReadPovrayCamera(const fs::path& path, double units) {
  constexpr double kLeastLength = 1e-6;
  const Vectors vectors = ReadVectors(path);
  const Eigen::Vector3d position = VectorOf(vectors, "cam_pos", path) / units;
  const Eigen::Vector3d forward = VectorOf(vectors, "cam_dir", path);
  const Eigen::Vector3d right = VectorOf(vectors, "cam_up", path).cross(forward);
  if (right.norm() < kLeastLength) {
    throw InputError(path.string() +
                     ": cam_dir and cam_up are parallel, expected the directions "
                     "of a camera");
  }
  Eigen::Matrix3d world_from_cam;
  world_from_cam.col(0) = right.normalized();
  world_from_cam.col(2) = forward.normalized();
  world_from_cam.col(1) = world_from_cam.col(2).cross(world_from_cam.col(0));
  return MirrorY(Rigid3(Eigen::Quaterniond(world_from_cam), position));
}

std::optional<Trajectory> ReadPovrayTrajectory(const std::vector<FramePaths>& frames,
                                               double units) {
  std::error_code error;
  Trajectory trajectory;
  for (const FramePaths& frame : frames) {
    fs::path camera = frame.image;
    camera.replace_extension(".txt");
    if (trajectory.empty() && !fs::exists(camera, error)) {
      return std::nullopt;
    }
    trajectory.push_back({frame.timestamp, ReadPovrayCamera(camera, units)});
  }
  return trajectory;
}

cv::Mat ReadRayDepth(const fs::path& path, const PinholeCamera& camera, double units) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::string bytes = ReadText(path);
  std::string_view text = bytes;
  cv::Mat depth(camera.height, camera.width, CV_32FC1);
  size_t count = 0;
  for (size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
       at = text.find_first_not_of(kBlanks)) {
    text.remove_prefix(at);
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    double distance = 0.0;
    if (!ParseFinite(word, distance) || distance < 0.0 || distance > kMostMetres) {
      throw InputError(fmt::format("{}: number {} is '{}', expected a distance from 0 to {:g}",
                                   path.string(), count + 1, ShowText(word, 40), kMostMetres));
    }
    if (count < depth.total()) {
      const int row = static_cast<int>(count) / depth.cols;
      const int column = static_cast<int>(count) % depth.cols;
      const Eigen::Vector3d ray =
          camera.Unproject(camera.Undistort(Eigen::Vector2d(column, row)), 1.0);
      depth.at<float>(row, column) = static_cast<float>(distance / (units * ray.norm()));
    }
    ++count;
  }
  if (count != depth.total()) {
    throw InputError(fmt::format("{}: has {} numbers, expected one per pixel of {}x{}",
                                 path.string(), count, camera.width, camera.height));
  }
  return depth;
}

ImageInput LoadPovrayFrame(const FramePaths& frame, const PinholeCamera& camera, double units) {
  ImageInput image = LoadFrame({frame.timestamp, frame.image}, camera);
  if (!frame.depth.empty()) {
    image.depth = ReadRayDepth(frame.depth, camera, units);
  }
  return image;
}

}  // namespace hullslam
