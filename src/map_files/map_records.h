// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "files/bytes.h"
#include "hullslam/frame/frame.h"
#include "hullslam/map/map_tables.h"
#include "hullslam/map_files/map_file.h"

// The parts of a map file (docs/maps.md). For each part there is a function that writes it and one
// that reads and checks it. The relations between the parts are checked in
// map_files/restored_map.h.
namespace hullslam {

// No length, time or pixel of a map is larger. Poses are at most at kMostMetres
// (files/plausible.h); a landmark of a camera without depth may be almost at infinity.
constexpr double kMostMapNumber = 1e15;

constexpr uint32_t kMapVersion = 3;

// The first part: the settings, the sessions and how many entities follow.
struct MapHeader {
  MapSettings settings;
  std::vector<Session> sessions;
  uint32_t correction_count = 0;
  uint32_t keyframes = 0;
  uint32_t culled = 0;
  uint32_t landmarks = 0;
  uint32_t landmark_slots = 0;  // RecyclingTable::used_slots()
  uint32_t objects = 0;
  uint32_t next_object = 0;  // CowTable::NextId()
};

// map_header.cc
void WriteHeader(const MapHeader& header, ByteWriter& out);
MapHeader ReadHeader(ByteReader& in);

// map_frame.cc
void WriteFrame(const Frame& frame, ByteWriter& out);
std::shared_ptr<const Frame> ReadFrame(const MapHeader& header, ByteReader& in);

// In map_detection.cc. `keypoints` is the number of keypoints of the frame.
void WriteDetection(const Detection& detection, ByteWriter& out);
Detection ReadDetection(size_t keypoints, ByteReader& in);

// In map_frame.cc. A frame has one visual word per keypoint, or none at all. Whether they are words
// of the vocabulary is checked in map_files/restored_map.h.
void WriteWords(const Frame& frame, ByteWriter& out);
void ReadWords(Frame& frame, ByteReader& in);

// In map_entities.cc. The entities of each kind are sorted by id. Values that follow from others
// are not written: the children of keyframes, the observations of landmarks and objects, and the
// observation weights of landmarks.
void WriteKeyframe(KeyframeId id, const Keyframe& keyframe, ByteWriter& out);
void ReadKeyframe(const MapHeader& header, ByteReader& in, MapTables& tables);
void WriteCulled(KeyframeId id, const CulledKeyframe& culled, ByteWriter& out);
void ReadCulled(const MapHeader& header, ByteReader& in, MapTables& tables);
void WriteLandmark(LandmarkId id, const Landmark& landmark, ByteWriter& out);
void ReadLandmark(const MapHeader& header, ByteReader& in, MapTables& tables);
void WriteObject(ObjectId id, const ObjectLandmark& object, ByteWriter& out);
void ReadObject(const MapHeader& header, ByteReader& in, MapTables& tables);

// A rotation is written as four numbers x y z w, whose length is 1 up to rounding.
void WritePose(const Rigid3& pose, ByteWriter& out);
Rigid3 ReadPose(ByteReader& in);

// Reads the records of a map file of this version of the format: everything except the first bytes,
// which name the format, and the checksum at the end. They are the next `size` bytes of the stream
// and may have any values. `name` begins all messages. `expected` are the settings of the run; null
// if any settings are allowed. Throws InputError and ReadingCancelled like ReadMap().
StoredMap ParseMap(std::istream& in, uint64_t size, const std::string& name,
                   const MapSettings* expected,
                   std::shared_ptr<const Vocabulary> vocabulary = nullptr,
                   const Cancellation* cancellation = nullptr);

// Throws ReadingCancelled if that was requested.
void EndIfCancelled(const Cancellation* cancellation, const std::string& name);

}  // namespace hullslam
