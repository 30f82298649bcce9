// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "images/image_codecs.h"
#include "synthetic/mask_outline.h"
#include "synthetic/motion_blur.h"
#include "synthetic/renderer.h"
#include "synthetic/scenes.h"
#include "synthetic/sequence_files.h"
#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr int kMinMaskArea = 100;  // px

using MaskCounts = std::vector<std::atomic<uint32_t>>;  // of each object of a scene

// Adds the masks to `counts`, if there are counts.
std::string MaskText(const Scene& scene, const cv::Mat& instance, MaskCounts* counts) {
  std::string text;
  for (const InstanceOutline& outline : FindOutlines(instance, kMinMaskArea)) {
    const SceneObject& object = scene.objects[static_cast<size_t>(outline.object)];
    if (!object.HasClass()) {
      continue;
    }
    if (counts != nullptr) {
      ++(*counts)[static_cast<size_t>(outline.object)];
    }
    text += std::to_string(object.class_id);
    for (const Eigen::Vector2d& vertex : outline.vertices) {
      fmt::format_to(std::back_inserter(text), " {:.6f} {:.6f}",
                     std::clamp(vertex.x() / instance.cols, 0.0, 1.0),
                     std::clamp(vertex.y() / instance.rows, 0.0, 1.0));
    }
    text += " 1\n";
  }
  return text;
}

// A camera that renders a scene along its path.
struct Eye {
  const Scene& scene;
  const Renderer& renderer;
  const Sensor& sensor;
};

RenderedFrame RenderBlurred(const SequencePlan& plan, const Eye& eye, int frame) {
  const double time = frame / kFramesPerSecond;
  RenderedFrame rendered = eye.renderer.Render(time);
  rendered.colour = BlurByMotion(
      rendered, eye.scene, plan.camera,
      {.time = time, .readout_time = plan.readout_time, .duration = plan.exposure_time});
  return rendered;
}

// The scene as the right camera of a stereo pair sees it: its path is beside that of the left one.
Scene SceneOfRight(const SequencePlan& plan) {
  Scene scene = plan.scene;
  scene.world_from_cam = [left = plan.scene.world_from_cam,
                          baseline = plan.stereo_baseline](double time) {
    const Rigid3 right_in_left{Eigen::Quaterniond::Identity(), {baseline, 0.0, 0.0}};
    return left(time) * right_in_left;
  };
  return scene;
}

void WriteRight(const SequencePlan& plan, const Eye& eye, int frame, const fs::path& folder) {
  const RenderedFrame rendered = RenderBlurred(plan, eye, frame);
  const std::string stem = plan.layout.Stem(frame);
  WriteNewFile(folder / "right" / (stem + ".png"),
               EncodePng(eye.sensor.Colour(rendered, static_cast<uint32_t>(frame))));
  WriteNewFile(folder / "masks_right" / (stem + ".txt"),
               MaskText(plan.scene, rendered.instance, nullptr));
}

void WriteFrame(const SequencePlan& plan, const Eye& eye, int frame, const fs::path& folder,
                MaskCounts& counts) {
  const RenderedFrame rendered = RenderBlurred(plan, eye, frame);
  const Sensor& sensor = eye.sensor;
  const std::string stem = plan.layout.Stem(frame);
  const auto number = static_cast<uint32_t>(frame);
  WriteNewFile(folder / "rgb" / (stem + ".png"), EncodePng(sensor.Colour(rendered, number)));
  WriteNewFile(folder / "depth" / (stem + ".png"), EncodePng(sensor.Depth(rendered, number)));
  WriteNewFile(folder / plan.layout.TumFolder() / "masks" / (stem + ".txt"),
               MaskText(plan.scene, rendered.instance, &counts));
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

bool RenderSequence(const fs::path& folder, const SequencePlan& plan, int threads,
                    const std::function<bool(int)>& progress) {
  fs::create_directory(folder / "rgb");
  fs::create_directory(folder / "depth");
  fs::create_directories(folder / plan.layout.TumFolder() / "masks");
  const Renderer renderer(plan.scene, plan.camera, plan.readout_time);
  const Sensor sensor(plan.sensor, plan.sensor_seed);
  const bool is_stereo = plan.stereo_baseline > 0.0;
  const Scene right_scene = is_stereo ? SceneOfRight(plan) : Scene();
  std::optional<Renderer> right_renderer;
  const Sensor right_sensor(plan.sensor, HashSeed(plan.sensor_seed, 0, "right"));
  if (is_stereo) {
    fs::create_directory(folder / "right");
    fs::create_directory(folder / "masks_right");
    right_renderer.emplace(right_scene, plan.camera, plan.readout_time);
  }
  const int workers =
      threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  MaskCounts counts(plan.scene.objects.size());
  const auto write = [&](int frame) {
    WriteFrame(plan, {plan.scene, renderer, sensor}, frame, folder, counts);
    if (is_stereo) {
      WriteRight(plan, {right_scene, *right_renderer, right_sensor}, frame, folder);
    }
  };
  if (!ForEachFrame(plan.frames, workers, write, progress)) {
    return false;
  }
  WriteSequenceFiles(folder, plan, std::vector<uint32_t>(counts.begin(), counts.end()));
  return true;
}

}  // namespace hullslam::synthetic
