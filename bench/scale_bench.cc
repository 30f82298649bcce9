// SPDX-License-Identifier: GPL-3.0-or-later
// What grows with the map and with the time: a long walk along a made-up corridor, or to and fro in
// it, through the whole sequential system. Prints, at 10, 20, 50 and 100 % of the way, what a frame
// and a keyframe cost at that point and how much memory the keyframes and the whole system take.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "hullslam/system/system.h"
#include "live/live_view.h"
#include "made_corridor.h"
#include "made_map.h"
#include "map_bytes.h"

namespace hullslam {
namespace {

// Parts of what a keyframe costs, besides local bundle adjustment.
constexpr std::array kOtherStages = {"map_insert", "map_landmarks", "map_objects", "check_objects",
                                     "cull_keyframes"};
constexpr size_t kWindowShare = 20;  // times are those of the last twentieth of all frames

// Milliseconds of processor time that this program has used. Unlike the time on a clock, it hardly
// depends on what else the computer does.
double ProcessorMs() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

size_t HeapBytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

// The time of a stage since `before`, ms.
double SumSince(const StageTimes& before, const StageTimes& now, std::string_view stage) {
  return now.Total(stage).sum - before.Total(stage).sum;
}

double MeanSince(const StageTimes& before, const StageTimes& now, std::string_view stage) {
  const size_t count = now.Total(stage).count - before.Total(stage).count;
  return SumSince(before, now, stage) / static_cast<double>(std::max<size_t>(1, count));
}

// The processor times of frames in a window, ms.
struct FrameTimes {
  std::vector<double> tracked;   // of frames that are only tracked
  std::vector<double> inserted;  // of frames that become keyframes, with all that follows
};

double PerKeyframe(const FrameTimes& times) {
  return times.inserted.empty() ? 0.0
                                : Summarize(times.inserted).mean - Summarize(times.tracked).mean;
}

void PrintHeader() {
  fmt::print("{:>7} {:>9} {:>9} {:>7} {:>9} {:>12} {:>12} {:>12} {:>9} {:>9}\n", "frames",
             "keyframes", "landmarks", "objects", "frame, ms", "keyframe, ms", "besides BA",
             "snapshot, us", "kB/keyfr.", "heap, MB");
}

void PrintLine(size_t frames, const Map& map, const FrameTimes& times, const StageTimes& before,
               const StageTimes& now, size_t heap) {
  double others = 0.0;
  for (const char* stage : kOtherStages) {
    others += SumSince(before, now, stage);
  }
  size_t bytes = 0;
  for (const auto& [part, of_part] : KeyframeBytes(map)) {
    bytes += of_part;
  }
  fmt::print("{:>7} {:>9} {:>9} {:>7} {:>9.2f} {:>12.1f} {:>12.2f} {:>12.1f} {:>9.1f} {:>9.1f}\n",
             frames, map.keyframes().size(), map.landmarks().size(), map.objects().size(),
             Summarize(times.tracked).median, PerKeyframe(times),
             others / static_cast<double>(std::max<size_t>(1, times.inserted.size())),
             1e3 * MeanSince(before, now, "map_snapshot"),
             1e-3 * static_cast<double>(bytes) / static_cast<double>(map.keyframes().size()),
             1e-6 * static_cast<double>(heap));
  std::fflush(stdout);
}

// What the memory of a keyframe consists of.
void PrintParts(const Map& map) {
  const auto keyframes = static_cast<double>(map.keyframes().size());
  double total = 0.0;
  for (const auto& [part, bytes] : KeyframeBytes(map)) {
    fmt::print("{:>30}: {:6.2f} kB\n", part, 1e-3 * static_cast<double>(bytes) / keyframes);
    total += static_cast<double>(bytes);
  }
  fmt::print("{:>30}: {:6.2f} kB per keyframe\n", "together", 1e-3 * total / keyframes);
}

// The live view of the walk, with an image of noise, at this port; null if the port is negative.
std::unique_ptr<LiveView> Watch(const Sensor& sensor, size_t frames, int port) {
  if (port < 0) {
    return nullptr;
  }
  LiveRun run;
  run.title = "corridor";
  run.sensor = sensor;
  run.frame_count = frames;
  auto view = std::make_unique<LiveView>(ViewAddress{.port = port}, run, LiveCommands());
  fmt::print("open this address in a browser: {}\n", view->url());
  std::fflush(stdout);
  return view;
}

cv::Mat NoiseImage() {
  cv::Mat grey(480, 640, CV_8UC1);
  uint32_t state = 1;
  for (size_t i = 0; i < grey.total(); ++i) {
    state = state * 1664525 + 1013904223;
    grey.data[i] = static_cast<uint8_t>(state >> 24);
  }
  return grey;
}

void Run(size_t frames, size_t turn, int port) {
  const Sensor sensor = BenchSensor();
  SystemOptions options;
  options.camera = sensor.camera;
  const MadeCorridor corridor(turn, sensor);
  System system(options, PipelineKind::kSequential);
  FrameReport report;
  system.SetFrameCallback([&report](const FrameReport& newest) { report = newest; });
  const std::unique_ptr<LiveView> view = Watch(sensor, frames, port);
  const cv::Mat image = NoiseImage();
  const size_t heap_before = HeapBytes();
  size_t lost = 0;
  double total_ms = 0.0;
  FrameTimes times;
  StageTimes stages_before;
  PrintHeader();
  for (size_t done = 1; done <= frames; ++done) {
    BuiltFrame built;
    built.frame = corridor.MakeFrame(static_cast<uint32_t>(done - 1));
    const std::shared_ptr<const Map> map_before = system.map();
    const double start = ProcessorMs();
    system.Track(std::move(built));
    const double spent = ProcessorMs() - start;
    total_ms += spent;
    if (view) {
      view->Show({.report = report, .map = system.map(), .grey = image, .number = done});
    }
    lost += report.tracked.state == TrackingState::kTracked ? 0 : 1;
    (system.map() == map_before ? times.tracked : times.inserted).push_back(spent);
    for (const size_t percent : {10, 20, 50, 100}) {
      const size_t end = frames * percent / 100;
      if (done == end - frames / kWindowShare) {
        times = {};
        stages_before = system.times();
      } else if (done == end) {
        PrintLine(done, *system.map(), times, stages_before, system.times(),
                  HeapBytes() - heap_before);
      }
    }
  }
  fmt::print(
      "{:.1f} s of processor time for {} frames, {} lost; {} keyframes were made; {} replaced "
      "ids are remembered\n",
      1e-3 * total_ms, frames, lost, system.map()->keyframes().NextId().value,
      system.map()->replaced_count());
  PrintParts(*system.map());
}

}  // namespace
}  // namespace hullslam

int main(int argc, char** argv) {
  size_t frames = 10000;
  size_t turn = 0;
  int port = -1;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string_view(argv[i]) == "--frames") {
      frames = static_cast<size_t>(std::strtoul(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--turn") {
      turn = static_cast<size_t>(std::strtoul(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--view") {
      port = static_cast<int>(std::strtol(argv[i + 1], nullptr, 10));
    } else {
      frames = 0;
    }
  }
  frames = argc % 2 == 1 ? frames : 0;
  if (frames < 100) {
    fmt::print(
        stderr,
        "usage: scale_bench [--frames N] [--turn N] [--view PORT]\n"
        "frames: at least 100, 10000 by default; the camera turns back each time after --turn "
        "frames\n");
    return 2;
  }
  hullslam::Run(frames, turn > 0 ? turn : frames, port);
  return 0;
}
