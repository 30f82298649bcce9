// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/system/options.h"

namespace hullslam {

// What the frames of a map were made with. Frames that were made with something else cannot be
// found in the map.
struct MapSettings {
  SensorKind sensor = SensorKind::kRgbd;
  PinholeCamera camera;
  int level_count = 8;        // of the image pyramid
  double scale_factor = 1.2;  // between two levels
  uint64_t vocabulary = 0;    // hash of the vocabulary that the words are of; 0: without words

  bool operator==(const MapSettings&) const = default;
};

// The settings of the maps that a run with these options makes.
MapSettings MapSettingsOf(const SystemOptions& options);

struct StoredMap {
  Map map;
  MapSettings settings;
};

// Writes a map that has a keyframe, with its sessions, to one file (docs/maps.md). The file is
// complete or not there at all, as with WriteFileAtomically(). The same map gives the same bytes,
// also after it was read from a file. Throws InputError with `path` and the reason if the map has
// no keyframe or the file cannot be written.
void WriteMap(const std::filesystem::path& path, const Map& map, const MapSettings& settings);

// Reads a file of WriteMap(), without an index of its words. The map has the same values, ids and
// free ids, so work goes on as before; only ids that were replaced before it was written are
// absent, and its revision begins again at 0. Throws InputError with `path` and the reason for
// anything else: a file that is damaged or cut off, that another version wrote, or whose map is not
// consistent.
StoredMap ReadMap(const std::filesystem::path& path);
// Reads a map that a System with these options is to go on with. Its keyframes are indexed by the
// words of SystemOptions::vocabulary. Also throws InputError, before it reads the keyframes, if the
// map was made with other settings or another vocabulary; the message says which.
Map ReadMap(const std::filesystem::path& path, const SystemOptions& options);

}  // namespace hullslam
