// SPDX-License-Identifier: GPL-3.0-or-later
// What grows with the map and with the time: a long walk along a made-up corridor, or to and fro in
// it, through the whole sequential system. Prints, at 10, 20, 50 and 100 % of the way, what a frame
// and a keyframe cost at that point and how much memory the keyframes and the whole system take.
//
// With --hours it is a robot that works in one building (MadeBuilding), and each hour has a line.
// Times of frames are processor times of the thread that calls Track: in the sequential pipeline
// with mapping, with --threaded without. With --kidnapped N the camera is afterwards put N times at
// a place where the robot comes later: where nothing but one of the two equal rooms is in the
// image, or at least half of it shows one, in another building, or anywhere else on its way. It is
// counted how often its place is found within half a second by single images, and how often a wrong
// one.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hullslam/geometry/alignment.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/system/relocaliser.h"
#include "hullslam/system/system.h"
#include "live/live_view.h"
#include "made_building.h"
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

// Milliseconds of processor time that this thread has used.
double ThreadMs() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

// The memory of the process, MB, without pages of files, which the computer can take back.
double MemoryMb() {
  std::ifstream in("/proc/self/status");
  std::string word;
  while (in >> word && word != "RssAnon:") {
  }
  double kilobytes = 0.0;
  in >> kilobytes;
  return 1e-3 * kilobytes;
}

struct Shift {
  double hours = 10.0;
  PipelineKind kind = PipelineKind::kSequential;
  int max_keyframes = 0;
  size_t lights = 2;          // in which the building looks different, one after the other
  bool is_unchanged = false;  // objects stay where they are, and the light is the same
  size_t kidnapped = 0;
};

// What became of a camera that was put at places of one kind.
struct Kidnapped {
  size_t tries = 0;
  size_t found = 0;
  size_t wrong = 0;
  size_t frames = 0;
  double spent_ms = 0.0;
};

// A robot at work, and what is known about it so far.
class Patrol {
 public:
  explicit Patrol(const Shift& shift)
      : shift_(shift),
        vocabulary_(std::make_shared<const Vocabulary>(ReadVocabulary(FindDefaultVocabulary()))),
        sensor_(BenchSensor()),
        building_(3600.0 * shift.hours, sensor_, vocabulary_.get(), shift.is_unchanged, 100,
                  shift.lights),
        system_(Options(), shift.kind) {}

  void Run() {
    fmt::print("{:>5} {:>9} {:>6} {:>9} {:>7} {:>23} {:>22} {:>5} {:>6} {:>5} {:>6} {:>6} {:>5}\n",
               "hour", "keyframes", "made", "landmarks", "objects", "frame, ms: median/99%/max",
               "over 33 ms/lost/wrong", "heap", "loops", "false", "ATE, m", "map MB", "s");
    const double seconds = 3600.0 * shift_.hours;
    const double step = std::min(3600.0, seconds / 10.0);
    double next = step;
    const auto frames = static_cast<uint32_t>(seconds * sensor_.frames_per_second);
    for (uint32_t i = 0; i < frames; ++i) {
      const double time = i / sensor_.frames_per_second;
      if (building_.HasImage(time)) {
        TrackFrame(time, i);
      }
      if (i + 1 == frames || time >= next) {
        PrintHour(time);
        next += step;
      }
    }
    Judge(seconds);
    JudgeLandmarks(seconds);
    if (shift_.kidnapped > 0) {
      Kidnap();
    }
  }

 private:
  SystemOptions Options() const {
    SystemOptions options;
    options.camera = sensor_.camera;
    options.vocabulary = vocabulary_;
    // A robot that works on never reaches the end of its run.
    options.tracking.refine_at_end = false;
    options.mapping.max_keyframes = shift_.max_keyframes;
    return options;
  }

  void TrackFrame(double time, uint32_t number) {
    BuiltFrame built;
    built.frame = building_.MakeFrame(time, number);
    const double start = ThreadMs();
    const TrackedFrame tracked = system_.Track(std::move(built));
    const double spent = ThreadMs() - start;
    times_.push_back(spent);
    peak_mb_ = number % 64 == 0 ? std::max(peak_mb_, MemoryMb()) : peak_mb_;
    over_ += spent > 1e3 / sensor_.frames_per_second ? 1 : 0;
    lost_ += tracked.state == TrackingState::kTracked ? 0 : 1;
    const std::shared_ptr<const Map> map = system_.map();
    wrong_ += IsWrong(*map, tracked, time) ? 1 : 0;
    if (map->correction_count() != corrections_) {
      corrections_ = map->correction_count();
      CountLoops(*map);
    }
  }

  // Whether the camera is elsewhere than in the map, by the alignment of the last line.
  bool IsWrong(const Map& map, const TrackedFrame& tracked, double time) const {
    constexpr double kWrong = 0.5;  // m
    if (map_mb_ == 0.0 || !tracked.from_keyframe ||
        !map.NearestAlive(tracked.from_keyframe->reference).IsValid()) {
      return false;
    }
    const Rigid3 world_from_cam = Inverse(map.CamFromWorld(*tracked.from_keyframe));
    const Eigen::Vector3d truth = Inverse(building_.CamFromWorld(time)).translation;
    return (truth_from_map_ * world_from_cam.translation - truth).norm() > kWrong;
  }

  Rigid3 TruthOf(const Frame& frame) const { return building_.CamFromWorld(frame.timestamp); }

  // A loop is false if its two keyframes cannot see the same part of the wall, or if the map places
  // them wrongly to each other once it is closed. The edges of a culled keyframe, which others get,
  // count again.
  void CountLoops(const Map& map) {
    constexpr double kFar = 7.0;    // m: twice the reach, and what the camera turns aside
    constexpr double kWrong = 0.5;  // m
    for (const auto& [id, keyframe] : map.keyframes()) {
      for (const KeyframeId other : keyframe.loops) {
        if (other < id && loops_.emplace(other, id).second) {
          const Rigid3 there = TruthOf(*map.keyframes().At(other).frame);
          const Rigid3 here_from_there = TruthOf(*keyframe.frame) * Inverse(there);
          const Rigid3 mapped = map.CamFromWorld(id) * Inverse(map.CamFromWorld(other));
          const bool is_false = here_from_there.translation.norm() > kFar ||
                                (mapped.translation - here_from_there.translation).norm() > kWrong;
          false_loops_ += is_false ? 1 : 0;
        }
      }
    }
  }

  // The root of the mean squared error of the positions of every 15th frame in the current map, m.
  // Keeps the alignment.
  double Ate() {
    const std::shared_ptr<const Map> map = system_.map();
    std::vector<Eigen::Vector3d> estimate;
    std::vector<Eigen::Vector3d> truth;
    for (size_t i = 0; i < system_.frames().size(); i += 15) {
      const TrackedFrame& frame = system_.frames()[i];
      if (frame.from_keyframe && map->NearestAlive(frame.from_keyframe->reference).IsValid()) {
        estimate.push_back(Inverse(map->CamFromWorld(*frame.from_keyframe)).translation);
        truth.push_back(Inverse(building_.CamFromWorld(frame.timestamp)).translation);
      }
    }
    truth_from_map_ = AlignPoints(estimate, truth, AlignmentKind::kSe3).target_from_source;
    double sum = 0.0;
    for (size_t i = 0; i < truth.size(); ++i) {
      sum += (truth_from_map_ * estimate[i] - truth[i]).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(truth.size()));
  }

  // Writes the map. Returns its size, MB.
  double Save() {
    const auto path = std::filesystem::temp_directory_path() / "scale_bench.map";
    const auto start = std::chrono::steady_clock::now();
    WriteMap(path, *system_.map(), MapSettingsOf(system_.options()));
    save_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double size = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
    std::filesystem::remove(path);
    return size;
  }

  void PrintHour(double time) {
    const size_t heap = HeapBytes();
    const std::shared_ptr<const Map> map = system_.map();
    std::sort(times_.begin(), times_.end());
    const double ate = Ate();
    map_mb_ = Save();
    fmt::print(
        "{:>5.2f} {:>9} {:>6} {:>9} {:>7} {:>11.2f} {:>5.2f} {:>7.1f} {:>10} {:>5} {:>5} {:>5.1f} "
        "{:>6} "
        "{:>5} {:>6.3f} {:>6.1f} {:>5.0f}\n",
        time / 3600.0, map->keyframes().size(), map->keyframes().NextId().value,
        map->landmarks().size(), map->objects().size(), times_[times_.size() / 2],
        times_[times_.size() * 99 / 100], times_.back(), over_, lost_, wrong_,
        1e-6 * static_cast<double>(heap), loops_.size(), false_loops_, ate, map_mb_,
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count());
    std::fflush(stdout);
    times_.clear();
    over_ = 0;
    lost_ = 0;
    wrong_ = 0;
  }

  // Prints how the mapped objects compare with the true ones, and the memory.
  void Judge(double time) const {
    constexpr double kNear = 0.12;  // m
    const std::shared_ptr<const Map> map = system_.map();
    const std::vector<MadeBuilding::Truth> truth = building_.ObjectsAt(time);
    std::vector<size_t> found(truth.size());
    size_t wrong = 0;
    for (const auto& [id, object] : map->objects()) {
      if (object.state != ObjectState::kMapped) {
        continue;
      }
      const Eigen::Vector3d center =
          truth_from_map_ * object.ellipsoid.world_from_object.translation;
      const auto at = std::ranges::find_if(truth, [&](const MadeBuilding::Truth& real) {
        return (real.ellipsoid.world_from_object.translation - center).norm() < kNear;
      });
      if (at != truth.end() && at->label == object.Label()) {
        ++found[static_cast<size_t>(at - truth.begin())];
      } else {
        ++wrong;
      }
    }
    const auto missing = std::ranges::count(found, size_t{0});
    const auto twice = std::ranges::count_if(found, [](size_t count) { return count > 1; });
    fmt::print(
        "objects at the end: {} of {} right, {} missing, {} mapped twice, {} where none is\n"
        "peak memory {:.0f} MB, {:.1f} times the map of {:.1f} MB, which takes {:.2f} s to write\n",
        truth.size() - static_cast<size_t>(missing), truth.size(), missing, twice, wrong, peak_mb_,
        peak_mb_ / map_mb_, map_mb_, save_s_);
  }

  // Prints what the landmarks really show.
  void JudgeLandmarks(double time) const {
    constexpr double kFar = 0.1;  // m
    const std::shared_ptr<const Map> map = system_.map();
    std::map<std::array<size_t, 2>, size_t> copies;
    size_t nothing = 0;
    size_t left = 0;
    size_t again = 0;
    std::vector<size_t> right(std::max<size_t>(2, shift_.lights));
    map->landmarks().ForEach([&](LandmarkId, const Landmark& landmark) {
      const Eigen::Vector3d position = truth_from_map_ * landmark.position;
      const MadeBuilding::Shown shown = building_.WhatShows(landmark.descriptor, position, time);
      if (shown.point == SIZE_MAX) {
        ++nothing;
      } else if ((shown.position - position).norm() > kFar) {
        ++left;
      } else if (copies[{shown.point, shown.light}]++ > 0) {
        ++again;
      } else {
        ++right[shown.light];
      }
    });
    fmt::print(
        "landmarks at the end: {}; by the light in which they look like their point: {}; {} second "
        "ones, {} not where the point is, {} of no point\n",
        map->landmarks().size(), fmt::join(right, ", "), again, left, nothing);
  }

  // Puts the camera at a place, and asks for its pose with one image after the other.
  void PutAt(const MadeBuilding& building, const Relocaliser& relocaliser, double time,
             uint32_t number, Kidnapped& outcome) const {
    constexpr uint32_t kImages = 15;  // of half a second
    constexpr double kFar = 0.3;      // m
    ++outcome.tries;
    for (uint32_t i = 0; i < kImages; ++i) {
      const double now = time + i / sensor_.frames_per_second;
      const std::unique_ptr<Frame> frame = building.MakeFrame(now, number + i);
      frame->id = FrameId(number + i);
      const double start = ThreadMs();
      const auto found = relocaliser.Find(*frame);
      outcome.spent_ms += ThreadMs() - start;
      ++outcome.frames;
      if (found) {
        const Eigen::Vector3d center = truth_from_map_ * Inverse(found->cam_from_world).translation;
        const double error = (center - Inverse(building.CamFromWorld(now)).translation).norm();
        ++(&building == &building_ && error < kFar ? outcome.found : outcome.wrong);
        return;
      }
    }
  }

  void Kidnap() const {
    const double seconds = 3600.0 * shift_.hours;
    const MadeBuilding elsewhere(seconds, sensor_, vocabulary_.get(), false, 1000);
    const Relocaliser relocaliser(system_.options(), system_.map());
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> later(seconds, 2.0 * seconds);
    std::array<Kidnapped, 4> outcomes;
    for (size_t i = 0; i < shift_.kidnapped; ++i) {
      // Of ten places one is in another building and one in a room that the map has twice.
      double time = later(random);
      while (i % 10 == 1 && building_.ShareOfTwin(time) < 1.0) {
        time = later(random);
      }
      const double twin = building_.ShareOfTwin(time);
      const size_t kind = i % 10 == 0 ? 3 : twin == 1.0 ? 2 : twin >= 0.5 ? 1 : 0;
      PutAt(kind == 3 ? elsewhere : building_, relocaliser, time,
            static_cast<uint32_t>(100'000'000 + 15 * i), outcomes[kind]);
    }
    constexpr std::array kNames = {"on its way", "half an equal room", "only an equal room",
                                   "another building"};
    fmt::print("{:>20} {:>7} {:>9} {:>7} {:>10} {:>14}\n", "kidnapped", "tries", "found, %",
               "wrong", "images/try", "ms per image");
    for (size_t kind = 0; kind < outcomes.size(); ++kind) {
      const Kidnapped& outcome = outcomes[kind];
      const auto tries = static_cast<double>(std::max<size_t>(1, outcome.tries));
      const auto frames = static_cast<double>(outcome.frames);
      fmt::print("{:>20} {:>7} {:>9.2f} {:>7} {:>10.2f} {:>14.2f}\n", kNames[kind], outcome.tries,
                 100.0 * static_cast<double>(outcome.found) / tries, outcome.wrong, frames / tries,
                 outcome.spent_ms / std::max(1.0, frames));
    }
  }

  const Shift shift_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const std::shared_ptr<const Vocabulary> vocabulary_;
  const Sensor sensor_;
  const MadeBuilding building_;
  System system_;
  std::vector<double> times_;  // of the frames of this hour, ms
  size_t over_ = 0;
  size_t lost_ = 0;
  size_t wrong_ = 0;  // frames
  uint32_t corrections_ = 0;
  std::set<std::pair<KeyframeId, KeyframeId>> loops_;
  size_t false_loops_ = 0;
  Rigid3 truth_from_map_;
  double map_mb_ = 0.0;
  double save_s_ = 0.0;
  double peak_mb_ = 0.0;
};

}  // namespace
}  // namespace hullslam

int main(int argc, char** argv) {
  size_t frames = 10000;
  size_t turn = 0;
  int port = -1;
  hullslam::Shift shift{.hours = 0.0};
  for (; argc > 1; --argc) {
    const std::string_view last = argv[argc - 1];
    if (last == "--threaded") {
      shift.kind = hullslam::PipelineKind::kThreaded;
    } else if (last == "--unchanged") {
      shift.is_unchanged = true;
    } else {
      break;
    }
  }
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string_view(argv[i]) == "--frames") {
      frames = static_cast<size_t>(std::strtoul(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--turn") {
      turn = static_cast<size_t>(std::strtoul(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--view") {
      port = static_cast<int>(std::strtol(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--hours") {
      shift.hours = std::strtod(argv[i + 1], nullptr);
    } else if (std::string_view(argv[i]) == "--lights") {
      shift.lights = std::max<size_t>(1, std::strtoul(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--max-keyframes") {
      shift.max_keyframes = static_cast<int>(std::strtol(argv[i + 1], nullptr, 10));
    } else if (std::string_view(argv[i]) == "--kidnapped") {
      shift.kidnapped = static_cast<size_t>(std::strtoul(argv[i + 1], nullptr, 10));
    } else {
      frames = 0;
    }
  }
  frames = argc % 2 == 1 ? frames : 0;
  if (frames < 100) {
    fmt::print(
        stderr,
        "usage: scale_bench [--frames N] [--turn N] [--view PORT]\n"
        "       scale_bench --hours H [--kidnapped N] [--lights N] [--max-keyframes N] "
        "[--unchanged] "
        "[--threaded]\n"
        "frames: at least 100, 10000 by default; the camera turns back each time after --turn "
        "frames\n");
    return 2;
  }
  if (shift.hours > 0.0) {
    hullslam::Patrol(shift).Run();
  } else {
    hullslam::Run(frames, turn > 0 ? turn : frames, port);
  }
  return 0;
}
