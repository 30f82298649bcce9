// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

template <typename Task>
class LatestWorker;

// The settings with which the frames of a map were made. Frames that were made with other settings
// cannot be found in the map.
struct MapSettings {
  SensorKind sensor = SensorKind::kRgbd;
  PinholeCamera camera;
  int level_count = 8;        // number of levels of the image pyramid
  double scale_factor = 1.2;  // scale between two levels
  uint64_t vocabulary = 0;    // hash of the vocabulary of the words; 0: the frames have no words

  bool operator==(const MapSettings&) const = default;
};

// The settings of the maps that a run with these options makes.
MapSettings MapSettingsOf(const SystemOptions& options);
// Options of runs that make such maps. Options that a map does not tell have their defaults.
SystemOptions OptionsOf(const MapSettings& settings);

struct StoredMap {
  Map map;
  MapSettings settings;
};

// Reading a map was cancelled before it was complete.
class ReadingCancelled : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Writes a map and its sessions to one file (docs/maps.md). The map must have a keyframe. The file
// is complete or not there at all, as with WriteFileAtomically(). The same map gives the same
// bytes, also after it was read from a file. Throws InputError with `path` and the reason if the
// map has no keyframe or the file cannot be written.
void WriteMap(const std::filesystem::path& path, const Map& map, const MapSettings& settings);

// Saves the map of a run from time to time, in a thread of its own, so that little is lost if the
// process is killed or the computer fails. The file is always a whole map; if a map cannot be
// written (disk full), the last one stays. All islands are written.
class MapSaver {
 public:
  // Every `seconds`, WriteMap(path, map, settings). `on_failure` is called in the thread of the
  // saver when a map could not be written, with the reason; once while the reason stays the same.
  MapSaver(const std::filesystem::path& path, const MapSettings& settings, double seconds,
           std::function<void(const std::string& reason)> on_failure);
  // Waits for a map that is being written. WriteMap() at the end of a run has to come after this.
  ~MapSaver();
  // To be called with System::map() after each frame; takes next to no time. Saves the map if it is
  // time and the former one was written. A null map or one without keyframes is never saved.
  void Offer(const std::shared_ptr<const Map>& map);

 private:
  const double seconds_;
  std::chrono::steady_clock::time_point saved_;
  std::unique_ptr<LatestWorker<std::shared_ptr<const Map>>> worker_;
};

// Reads a file of WriteMap(). The map has no index of its words. It has the same values, ids and
// free ids, so new entities get the same ids as if the run had gone on. Two things are not kept:
// the ids that were replaced by others, and the revision, which begins again at 0. Throws
// InputError with `path` and the reason if the file is damaged or cut off, if another version wrote
// it, or if its map is not consistent.
StoredMap ReadMap(const std::filesystem::path& path);
// Reads a map that a System with these options is to go on with. Its keyframes are indexed by the
// words of SystemOptions::vocabulary. Also throws InputError, before it reads the keyframes, if the
// map was made with other settings or another vocabulary; the message says which. Throws
// ReadingCancelled soon after a request of `cancellation`.
Map ReadMap(const std::filesystem::path& path, const SystemOptions& options,
            const Cancellation* cancellation = nullptr);

}  // namespace hullslam
