// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <thread>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "synthetic/mask_outline.h"
#include "synthetic/output_swap.h"
#include "synthetic/renderer.h"
#include "synthetic/scenes.h"
#include "synthetic/sensor.h"

namespace hullslam::synthetic {
namespace {

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
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: 30.0\nCamera.bf: {:.1f}\nCamera.RGB: 1\n"
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

// What the rearrangement did with the object.
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

void WriteFrame(const Scene& scene, const Renderer& renderer, const Sensor& sensor, int frame,
                const OutputSwap& output) {
  const RenderedFrame rendered = renderer.Render(FrameTime(frame));
  const std::string stem = StampText(frame);
  const auto number = static_cast<uint32_t>(frame);
  output.WriteFile("rgb/" + stem + ".png", Png(sensor.Colour(rendered, number)));
  output.WriteFile("depth/" + stem + ".png", Png(sensor.Depth(rendered, number)));
  output.WriteFile("masks/" + stem + ".txt", MaskText(scene, rendered.instance));
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

}  // namespace

PinholeCamera SyntheticCamera() { return {.fx = 535.4, .fy = 539.2, .cx = 320.1, .cy = 247.6}; }

double FrameStamp(int frame) { return 1000.0 + std::round(FrameTime(frame) * 1e6) * 1e-6; }

bool WriteSequence(const std::filesystem::path& folder, const SequenceOptions& options,
                   const std::function<bool(int)>& progress) {
  Check(options.frames > 0 && options.threads >= 0, "a sequence needs at least one frame");
  OutputSwap output(folder, options.force);
  const Scene scene = BuildScene(options.scene, options.frames, options.seed, options.rearranged);
  const PinholeCamera camera = SyntheticCamera();
  const Renderer renderer(scene, camera, options.readout_time);
  const Sensor sensor({.noise = options.noise}, VisitSeed(options.seed, options.rearranged));
  for (const char* name : {"rgb", "depth", "masks"}) {
    std::filesystem::create_directory(output.working_folder() / name);
  }
  const int threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto write = [&](int frame) { WriteFrame(scene, renderer, sensor, frame, output); };
  if (!ForEachFrame(options.frames, threads, write, progress)) {
    return false;
  }
  output.WriteFile("rgb.txt", FrameList(options.frames, "rgb"));
  output.WriteFile("depth.txt", FrameList(options.frames, "depth"));
  output.WriteFile("groundtruth.txt", GroundTruth(scene, options.frames));
  output.WriteFile("camera.yaml", CameraSettings(camera, options.readout_time));
  output.WriteFile("groundtruth_objects.json", ObjectsJson(scene, options));
  output.Commit();
  return true;
}

}  // namespace hullslam::synthetic
