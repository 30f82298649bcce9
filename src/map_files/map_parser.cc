// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "hullslam/util/error.h"
#include "map_files/map_records.h"
#include "map_files/restored_map.h"

namespace hullslam {
namespace {

// Gives the records of a file one after the other. Each record is read as a whole.
class RecordReader {
 public:
  RecordReader(std::istream& in, uint64_t size, std::string name, const Cancellation* cancellation)
      : in_(in), left_(size), name_(std::move(name)), cancellation_(cancellation) {}

  // The current record, or the next one if the current one was read to its end.
  ByteReader& Record() {
    if (!record_ || record_->left() == 0) {
      Next();
    }
    return *record_;
  }

  void ExpectEnd() const {
    if (left_ > 0 || (record_ && record_->left() > 0)) {
      throw InputError(name_ + ": has bytes after its end");
    }
  }
  uint64_t left() const { return left_; }

 private:
  void Next() {
    EndIfCancelled(cancellation_, name_);
    const std::string name = fmt::format("{}: record {}", name_, ++number_);
    constexpr size_t kLengthBytes = sizeof(uint32_t);
    Load(kLengthBytes, name);
    const auto length = ByteReader(bytes_, name).Get<uint32_t>();
    Load(length, name);
    record_.emplace(bytes_, name);
    record_->Require(length > 0, "is empty");
  }

  void Load(uint64_t count, const std::string& name) {
    if (count > left_) {
      throw InputError(name + " is cut off");
    }
    bytes_.resize(count);
    in_.read(bytes_.data(), static_cast<std::streamsize>(count));
    if (static_cast<uint64_t>(in_.gcount()) != count) {
      throw InputError(name_ + ": cannot be read");
    }
    left_ -= count;
  }

  std::istream& in_;
  uint64_t left_;  // number of bytes that were not read yet
  std::string name_;
  const Cancellation* cancellation_;
  std::string bytes_;  // bytes of the current record
  std::optional<ByteReader> record_;
  size_t number_ = 0;
};

std::vector<OptionTable::Entry> Describe(MapSettings settings) {
  FeatureOptions features;
  features.level_count = settings.level_count;
  features.scale_factor = settings.scale_factor;
  OptionTable table;
  settings.camera.Bind(table);
  features.Bind(table);
  return table.Entries();
}

void RequireSettings(const MapSettings& found, const MapSettings& expected,
                     const std::string& name) {
  const auto kind = [](const MapSettings& settings) {
    return settings.sensor == SensorKind::kMonocular ? "a monocular"
           : settings.sensor == SensorKind::kStereo  ? "a stereo"
                                                     : "an RGB-D";
  };
  if (found.sensor != expected.sensor) {
    throw InputError(fmt::format("{}: was made with {} camera, this run has {} one", name,
                                 kind(found), kind(expected)));
  }
  if (found.vocabulary != expected.vocabulary) {
    throw InputError(
        fmt::format("{}: was made with the vocabulary {:016x}, this run has {:016x} "
                    "(0: none)",
                    name, found.vocabulary, expected.vocabulary));
  }
  if (found == expected) {
    return;
  }
  const std::vector<OptionTable::Entry> in_map = Describe(found);
  const std::vector<OptionTable::Entry> in_run = Describe(expected);
  for (size_t i = 0; i < in_map.size(); ++i) {
    if (in_map[i].value != in_run[i].value) {
      throw InputError(fmt::format("{}: was made with {} {}, the settings say {}", name,
                                   in_map[i].key, in_map[i].value, in_run[i].value));
    }
  }
  throw InputError(name + ": was made with a camera or image pyramid of other settings");
}

// Refuses numbers of entities that cannot fit into the file, since each entity needs some bytes.
// This is checked before memory is allocated for their ids.
void CheckCounts(const MapHeader& header, uint64_t bytes, const std::string& name) {
  constexpr uint64_t kLeastBytes = 64;
  const uint64_t entities =
      uint64_t{header.keyframes} + header.culled + header.landmarks + header.objects;
  if (entities > bytes / kLeastBytes) {
    throw InputError(name + ": is cut off, or has fewer entities than its header says");
  }
}

void ReadFreeLandmarks(const MapHeader& header, ByteReader& in, MapTables& tables) {
  std::vector<LandmarkId> free(in.GetCount(sizeof(uint32_t)));
  for (LandmarkId& id : free) {
    id = LandmarkId(in.Get<uint32_t>());
    in.Require(id.slot() < header.landmark_slots, "has a free id that is out of range");
  }
  std::vector<uint32_t> slots;
  tables.landmarks.ForEach([&](LandmarkId id, const Landmark&) { slots.push_back(id.slot()); });
  std::transform(free.begin(), free.end(), std::back_inserter(slots),
                 [](LandmarkId id) { return id.slot(); });
  std::sort(slots.begin(), slots.end());
  in.Require(std::adjacent_find(slots.begin(), slots.end()) == slots.end(),
             "has a free id that is used");
  std::for_each(free.rbegin(), free.rend(), [&](LandmarkId id) { tables.landmarks.PutFree(id); });
  tables.landmarks.SkipSlots(header.landmark_slots);
}

MapTables ReadTables(const MapHeader& header, RecordReader& records) {
  MapTables tables;
  tables.sessions = header.sessions;
  tables.correction_count = header.correction_count;
  for (uint32_t i = 0; i < header.keyframes; ++i) {
    ReadKeyframe(header, records.Record(), tables);
  }
  for (uint32_t i = 0; i < header.culled; ++i) {
    ReadCulled(header, records.Record(), tables);
  }
  for (uint32_t i = 0; i < header.landmarks; ++i) {
    ReadLandmark(header, records.Record(), tables);
  }
  ReadFreeLandmarks(header, records.Record(), tables);
  for (uint32_t i = 0; i < header.objects; ++i) {
    ReadObject(header, records.Record(), tables);
  }
  tables.objects.SkipIds(ObjectId(header.next_object));
  return tables;
}

}  // namespace

StoredMap ParseMap(std::istream& in, uint64_t size, const std::string& name,
                   const MapSettings* expected, std::shared_ptr<const Vocabulary> vocabulary,
                   const Cancellation* cancellation) {
  RecordReader records(in, size, name, cancellation);
  ByteReader& first = records.Record();
  MapHeader header = ReadHeader(first);
  first.ExpectEnd();
  if (expected != nullptr) {
    RequireSettings(header.settings, *expected, name);
  }
  CheckCounts(header, records.left(), name);
  MapTables tables = ReadTables(header, records);
  records.ExpectEnd();
  try {
    return {RestoreMap(std::move(tables), std::move(vocabulary)), header.settings};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: is not consistent: {}", name, error.what()));
  }
}

void EndIfCancelled(const Cancellation* cancellation, const std::string& name) {
  if (IsRequested(cancellation)) {
    throw ReadingCancelled(name +
                           ": the map was not read to its end, because this was interrupted");
  }
}

}  // namespace hullslam
