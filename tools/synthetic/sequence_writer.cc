// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "files/staging_folder.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "synthetic/mask_outline.h"
#include "synthetic/renderer.h"
#include "synthetic/scenes.h"
#include "synthetic/sensor.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr int kMinMaskArea = 100;  // px

double FrameTime(int frame) { return frame / kFramesPerSecond; }

std::string StampText(int frame) { return fmt::format("{:.6f}", FrameStamp(frame)); }

std::string PoseText(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}", t.x(), t.y(), t.z(), q.x(),
                     q.y(), q.z(), q.w());
}

std::string Png(const cv::Mat& image) {
  std::vector<uint8_t> bytes;
  Check(cv::imencode(".png", image, bytes), "an image could not be encoded");
  return {bytes.begin(), bytes.end()};
}

std::string MaskText(const Scene& scene, const cv::Mat& instance) {
  std::string text;
  for (const InstanceOutline& outline : FindOutlines(instance, kMinMaskArea)) {
    text += std::to_string(scene.objects[static_cast<size_t>(outline.object)].class_id);
    for (const Eigen::Vector2d& vertex : outline.vertices) {
      fmt::format_to(std::back_inserter(text), " {:.6f} {:.6f}",
                     std::clamp(vertex.x() / instance.cols, 0.0, 1.0),
                     std::clamp(vertex.y() / instance.rows, 0.0, 1.0));
    }
    text += " 1\n";
  }
  return text;
}

std::string FrameList(int frames, const std::string& folder) {
  std::string text = "# timestamp filename\n";
  for (int i = 0; i < frames; ++i) {
    text += fmt::format("{} {}/{}.png\n", StampText(i), folder, StampText(i));
  }
  return text;
}

std::string GroundTruth(const Scene& scene, int frames) {
  std::string text = "# timestamp tx ty tz qx qy qz qw (world_from_cam)\n";
  for (int i = 0; i < frames; ++i) {
    text += fmt::format("{} {}\n", StampText(i), PoseText(scene.world_from_cam(FrameTime(i))));
  }
  return text;
}

std::string CameraSettings(const PinholeCamera& camera, double readout_time) {
  std::string text = fmt::format(
      "%YAML:1.0\n---\nCamera.fx: {:.6f}\nCamera.fy: {:.6f}\nCamera.cx: {:.6f}\nCamera.cy: {:.6f}\n"
      "Camera.k1: 0.0\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\n"
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: 30.0\nCamera.bf: {:.1f}\n"
      "ThDepth: 40.0\nDepthMapFactor: {:.1f}\n"
      "ORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
      "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n",
      camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height, camera.bf,
      Sensor::Options().units_per_metre);
  if (readout_time > 0.0) {
    text += fmt::format("Camera.readout_time: {}\n", readout_time);
  }
  return text;
}

nlohmann::ordered_json PoseJson(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

nlohmann::ordered_json ObjectJson(const SceneObject& object) {
  return {{"id", object.id},
          {"class", object.class_name},
          {"class_id", object.class_id},
          {"shape", object.shape},
          {"dynamic", object.IsDynamic()},
          {"world_from_object", PoseJson(object.world_from_object)},
          {"half_extents",
           {object.half_extents.x(), object.half_extents.y(), object.half_extents.z()}}};
}

// Adds the status that the rearrangement gave the object.
void AddStatus(const SceneObject& object, nlohmann::ordered_json& entry) {
  switch (object.status) {
    case ObjectStatus::kUnchanged:
      entry["status"] = "unchanged";
      return;
    case ObjectStatus::kMoved:
      entry["status"] = "moved";
      entry["former_world_from_object"] = PoseJson(object.former_world_from_object);
      return;
    case ObjectStatus::kNew:
      entry["status"] = "new";
      return;
  }
}

std::string ObjectsJson(const Scene& scene, const SequenceOptions& options) {
  nlohmann::ordered_json file = {{"generator", "make_synthetic"},
                                 {"scene", SceneName(options.scene)},
                                 {"seed", options.seed},
                                 {"frames", options.frames}};
  if (options.rearranged) {
    file["rearranged"] = *options.rearranged;
  }
  file["objects"] = nlohmann::ordered_json::array();
  for (const SceneObject& object : scene.objects) {
    nlohmann::ordered_json entry = ObjectJson(object);
    if (options.rearranged) {
      AddStatus(object, entry);
    }
    for (int frame = 0; object.IsDynamic() && frame < options.frames; ++frame) {
      entry["poses"].push_back(
          {{"timestamp", FrameStamp(frame)},
           {"world_from_object", PoseJson(object.WorldFromObject(FrameTime(frame)))}});
    }
    file["objects"].push_back(std::move(entry));
  }
  if (options.rearranged) {
    file["gone"] = nlohmann::ordered_json::array();
    for (const SceneObject& object : scene.gone) {
      file["gone"].push_back(ObjectJson(object));
    }
  }
  return file.dump(1) + "\n";
}

// The absolute path of a folder, without a slash at the end.
fs::path AbsoluteFolder(const fs::path& folder) {
  const fs::path path = fs::weakly_canonical(fs::absolute(folder));
  return path.filename().empty() ? path.parent_path() : path;
}

bool IsFormerSequence(const fs::path& folder) {
  constexpr std::array<std::string_view, 8> kWritten = {
      "rgb",       "depth",       "masks",           "rgb.txt",
      "depth.txt", "camera.yaml", "groundtruth.txt", "groundtruth_objects.json"};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (std::find(kWritten.begin(), kWritten.end(), entry.path().filename().string()) ==
        kWritten.end()) {
      return false;
    }
  }
  std::ifstream file(folder / "groundtruth_objects.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  return json.is_object() && json.contains("generator") && json["generator"] == "make_synthetic";
}

// Throws InputError if the folder is not empty, unless it contains only an earlier synthetic
// sequence and `force` is set.
void CheckReplaceable(const fs::path& folder, bool force) {
  const fs::file_status status = fs::status(folder);
  if (!fs::exists(status)) {
    return;
  }
  if (!fs::is_directory(status)) {
    throw InputError(folder.string() + ": exists and is not a folder");
  }
  if (fs::is_empty(folder)) {
    return;
  }
  if (!IsFormerSequence(folder)) {
    throw InputError(
        folder.string() +
        ": is not empty and is not (only) a sequence of make_synthetic; choose another folder");
  }
  if (!force) {
    throw InputError(folder.string() + ": already contains a sequence; --force replaces it");
  }
}

// Makes the folder beside `folder` in which the sequence is written. Folders that killed processes
// have left are removed.
StagingFolder StageSequence(const fs::path& folder) {
  const std::string prefix = fmt::format(".{}.partial-", folder.filename().string());
  fs::create_directories(folder.parent_path());
  StagingFolder::Abandoned(folder.parent_path(), prefix);  // their destructors remove them
  StagingFolder staging(folder.parent_path(), prefix);
  for (const char* const name : {"rgb", "depth", "masks"}) {
    fs::create_directory(staging.content() / name);
  }
  return staging;
}

// Moves a complete sequence to its final path. An earlier sequence moves to the staging folder,
// whose destructor removes it.
void MoveToFolder(const StagingFolder& staging, const fs::path& folder) {
  const fs::path former = staging.path() / "former";
  const bool replaces = fs::exists(folder);
  if (replaces) {
    fs::rename(folder, former);
  }
  std::error_code error;
  fs::rename(staging.content(), folder, error);
  if (error) {
    if (replaces) {
      fs::rename(former, folder);
    }
    throw fs::filesystem_error("rename", folder, error);
  }
}

void WriteFile(const fs::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    throw InputError(path.string() + ": cannot be written; is the disk full?");
  }
}

void WriteFrame(const Scene& scene, const Renderer& renderer, const Sensor& sensor, int frame,
                const fs::path& folder) {
  const RenderedFrame rendered = renderer.Render(FrameTime(frame));
  const std::string stem = StampText(frame);
  const auto number = static_cast<uint32_t>(frame);
  WriteFile(folder / "rgb" / (stem + ".png"), Png(sensor.Colour(rendered, number)));
  WriteFile(folder / "depth" / (stem + ".png"), Png(sensor.Depth(rendered, number)));
  WriteFile(folder / "masks" / (stem + ".txt"), MaskText(scene, rendered.instance));
}

// Calls `write` for all frames from `threads` threads, one call per frame. Returns false if
// `progress` asked to stop. If frames fail, throws the exception of the first one.
bool ForEachFrame(int frames, int threads, const std::function<void(int)>& write,
                  const std::function<bool(int)>& progress) {
  std::atomic<int> next = 0;
  std::mutex mutex;
  int done = 0;
  bool stopped = false;
  std::exception_ptr failure;
  const auto stop = [&] {
    stopped = true;
    next = frames;
  };
  const auto work = [&] {
    for (int frame = next++; frame < frames; frame = next++) {
      try {
        write(frame);
        const std::lock_guard lock(mutex);
        if (!progress(++done)) {
          stop();
        }
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = failure ? failure : std::current_exception();
        stop();
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    pool.reserve(static_cast<size_t>(threads));
    for (int i = 0; i < threads; ++i) {
      pool.emplace_back(work);
    }
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
  return !stopped;
}

// Renders all frames into `folder` and writes the lists and the ground truth. Returns false if
// `progress` asked to stop.
bool RenderSequence(const fs::path& folder, const SequenceOptions& options,
                    const std::function<bool(int)>& progress) {
  const Scene scene = BuildScene(options.scene, options.frames, options.seed, options.rearranged);
  const PinholeCamera camera = SyntheticCamera();
  const Renderer renderer(scene, camera, options.readout_time);
  const Sensor sensor({.noise = options.noise}, VisitSeed(options.seed, options.rearranged));
  const int threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto write = [&](int frame) { WriteFrame(scene, renderer, sensor, frame, folder); };
  if (!ForEachFrame(options.frames, threads, write, progress)) {
    return false;
  }
  WriteFile(folder / "rgb.txt", FrameList(options.frames, "rgb"));
  WriteFile(folder / "depth.txt", FrameList(options.frames, "depth"));
  WriteFile(folder / "groundtruth.txt", GroundTruth(scene, options.frames));
  WriteFile(folder / "camera.yaml", CameraSettings(camera, options.readout_time));
  WriteFile(folder / "groundtruth_objects.json", ObjectsJson(scene, options));
  return true;
}

}  // namespace

PinholeCamera SyntheticCamera() { return {.fx = 535.4, .fy = 539.2, .cx = 320.1, .cy = 247.6}; }

double FrameStamp(int frame) { return 1000.0 + std::round(FrameTime(frame) * 1e6) * 1e-6; }

bool WriteSequence(const fs::path& folder, const SequenceOptions& options,
                   const std::function<bool(int)>& progress) {
  Check(options.frames > 0 && options.threads >= 0, "a sequence needs at least one frame");
  try {
    const fs::path target = AbsoluteFolder(folder);
    CheckReplaceable(target, options.force);
    const StagingFolder staging = StageSequence(target);
    if (!RenderSequence(staging.content(), options, progress)) {
      return false;
    }
    MoveToFolder(staging, target);
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be written: " + error.code().message());
  }
  return true;
}

}  // namespace hullslam::synthetic
