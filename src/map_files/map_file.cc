// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map_files/map_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/staged_file.h"
#include "hullslam/util/error.h"
#include "map_files/map_records.h"
#include "util/latest_worker.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

// A transfer in text mode would change the byte above 127 or the line ends. So it is noticed.
constexpr std::string_view kMagic = "\x89HULLMAP\r\n"sv;
constexpr size_t kPrefixBytes = kMagic.size() + sizeof(kMapVersion);
constexpr size_t kChecksumBytes = sizeof(uint32_t);

// CRC-32 (ISO 3309). It detects every change within 32 consecutive bits.
uint32_t AddToChecksum(uint32_t checksum, std::string_view bytes) {
  return static_cast<uint32_t>(
      ::crc32_z(checksum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string Prefix() {
  ByteWriter bytes;
  bytes.Put(kMapVersion);
  return std::string(kMagic) + bytes.bytes();
}

// Writes a map file record by record, so that the file is never in memory as a whole.
class RecordWriter {
 public:
  explicit RecordWriter(const fs::path& path) : file_(path) { Write(Prefix()); }

  ByteWriter& Record() { return record_; }
  // Ends the current record if it has at least this many bytes. Small entities share a record, and
  // the data is divided into many records so that reading needs little memory.
  void End(size_t least_bytes = 1) {
    if (record_.bytes().size() >= least_bytes) {
      ByteWriter length;
      length.PutCount(record_.bytes().size());
      Write(length.bytes());
      Write(record_.bytes());
      record_.Clear();
    }
  }
  void Commit() {
    ByteWriter checksum;
    checksum.Put(checksum_);
    file_.Write(checksum.bytes());
    file_.Commit();
  }

 private:
  void Write(std::string_view bytes) {
    checksum_ = AddToChecksum(checksum_, bytes);
    file_.Write(bytes);
  }

  StagedFile file_;
  ByteWriter record_;
  uint32_t checksum_ = 0;
};

MapHeader HeaderOf(const Map& map, const MapSettings& settings) {
  return {.settings = settings,
          .sessions = map.sessions(),
          .correction_count = map.correction_count(),
          .keyframes = static_cast<uint32_t>(map.keyframes().size()),
          .culled = static_cast<uint32_t>(map.culled().size()),
          .landmarks = static_cast<uint32_t>(map.landmarks().size()),
          .landmark_slots = map.landmarks().used_slots(),
          .objects = static_cast<uint32_t>(map.objects().size()),
          .next_object = map.objects().NextId().value};
}

void WriteFreeLandmarks(const Map& map, ByteWriter& out) {
  const std::vector<LandmarkId> free = map.landmarks().FreeIds();
  out.PutCount(free.size());
  for (const LandmarkId id : free) {
    out.Put(id.value);
  }
}

void WriteTables(const Map& map, RecordWriter& records) {
  constexpr size_t kRecordBytes = 1 << 16;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    WriteKeyframe(id, keyframe, records.Record());
    records.End();
  });
  map.culled().ForEach([&](KeyframeId id, const CulledKeyframe& culled) {
    WriteCulled(id, culled, records.Record());
    records.End(kRecordBytes);
  });
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    WriteLandmark(id, landmark, records.Record());
    records.End(kRecordBytes);
  });
  WriteFreeLandmarks(map, records.Record());
  records.End();
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    WriteObject(id, object, records.Record());
    records.End(kRecordBytes);
  });
  records.End();
}

// Opens a regular file. (Opening a pipe could wait for ever.)
std::ifstream Open(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError(path.string() + ": is not a regular file, expected a map");
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw InputError(path.string() + ": " + std::generic_category().message(errno));
  }
  return in;
}

// Reads `count` bytes, or fewer if the file ends before.
std::string ReadSome(std::istream& in, uint64_t count) {
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<size_t>(in.gcount()));
  return bytes;
}

// The size of the file that was opened. The file of this name may be another one by now.
uint64_t SizeOf(std::istream& in, const fs::path& path) {
  const std::streampos position = in.tellg();
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  in.seekg(position);
  if (!in || size < 0) {
    throw InputError(path.string() + ": cannot be read");
  }
  return static_cast<uint64_t>(size);
}

void ReadPrefix(std::istream& in, const fs::path& path) {
  const std::string prefix = ReadSome(in, kPrefixBytes);
  if (prefix.size() < kPrefixBytes || !prefix.starts_with(kMagic)) {
    throw InputError(path.string() + ": is not a map of HullSLAM");
  }
  const auto version =
      ByteReader(std::string_view(prefix).substr(kMagic.size()), path.string()).Get<uint32_t>();
  if (version != kMapVersion) {
    throw InputError(fmt::format("{}: is a map of format version {}, expected {}", path.string(),
                                 version, kMapVersion));
  }
}

// Compares the checksum of the first `size` bytes with the checksum that follows them. The prefix
// has already been read.
void CheckChecksum(std::istream& in, uint64_t size, const fs::path& path,
                   const Cancellation* cancellation) {
  constexpr uint64_t kBlock = 1 << 20;
  uint32_t checksum = AddToChecksum(0, Prefix());
  for (uint64_t left = size - kPrefixBytes; left > 0;) {
    EndIfCancelled(cancellation, path.string());
    const std::string bytes = ReadSome(in, std::min(left, kBlock));
    if (bytes.empty()) {
      throw InputError(path.string() + ": cannot be read");
    }
    checksum = AddToChecksum(checksum, bytes);
    left -= bytes.size();
  }
  const std::string end = ReadSome(in, kChecksumBytes);
  if (ByteReader(end, path.string()).Get<uint32_t>() != checksum) {
    throw InputError(path.string() + ": is damaged or cut off: its checksum is wrong");
  }
}

StoredMap Read(const fs::path& path, const MapSettings* expected,
               std::shared_ptr<const Vocabulary> vocabulary, const Cancellation* cancellation) {
  std::ifstream in = Open(path);
  ReadPrefix(in, path);
  const uint64_t bytes = SizeOf(in, path);
  if (bytes < kPrefixBytes + kChecksumBytes) {
    throw InputError(path.string() + ": is cut off");
  }
  const uint64_t size = bytes - kChecksumBytes;
  CheckChecksum(in, size, path, cancellation);
  in.clear();
  in.seekg(kPrefixBytes);
  return ParseMap(in, size - kPrefixBytes, path.string(), expected, std::move(vocabulary),
                  cancellation);
}

}  // namespace

MapSettings MapSettingsOf(const SystemOptions& options) {
  return {.sensor = options.sensor,
          .camera = options.camera,
          .level_count = options.features.level_count,
          .scale_factor = options.features.scale_factor,
          .vocabulary = options.vocabulary != nullptr ? options.vocabulary->hash() : 0};
}

SystemOptions OptionsOf(const MapSettings& settings) {
  SystemOptions options;
  options.sensor = settings.sensor;
  options.camera = settings.camera;
  options.features.level_count = settings.level_count;
  options.features.scale_factor = settings.scale_factor;
  return options;
}

void WriteMap(const fs::path& path, const Map& map, const MapSettings& settings) {
  if (map.keyframes().empty()) {
    throw InputError(path.string() + ": cannot be written: the map has no keyframe");
  }
  RecordWriter records(path);
  WriteHeader(HeaderOf(map, settings), records.Record());
  records.End();
  WriteTables(map, records);
  records.Commit();
}

MapSaver::MapSaver(const fs::path& path, const MapSettings& settings, double seconds,
                   std::function<void(const std::string& reason)> on_failure)
    : seconds_(seconds),
      saved_(std::chrono::steady_clock::now()),
      worker_(std::make_unique<LatestWorker<std::shared_ptr<const Map>>>(
          [path, settings, on_failure = std::move(on_failure),
           told = std::string()](std::shared_ptr<const Map> map) mutable {
            std::string reason;
            try {
              WriteMap(path, *map, settings);
            } catch (const std::exception& error) {  // the run goes on
              reason = error.what();
            }
            if (std::exchange(told, reason) != reason && !reason.empty()) {
              on_failure(reason + "; the run goes on, and an earlier map there is kept");
            }
          })) {}

MapSaver::~MapSaver() = default;

void MapSaver::Offer(const std::shared_ptr<const Map>& map) {
  const auto now = std::chrono::steady_clock::now();
  if (map != nullptr && !map->keyframes().empty() && !worker_->IsBusy() &&
      std::chrono::duration<double>(now - saved_).count() >= seconds_) {
    worker_->Post(map);
    saved_ = now;
  }
}

StoredMap ReadMap(const fs::path& path) { return Read(path, nullptr, nullptr, nullptr); }

Map ReadMap(const fs::path& path, const SystemOptions& options, const Cancellation* cancellation) {
  const MapSettings expected = MapSettingsOf(options);
  return Read(path, &expected, options.vocabulary, cancellation).map;
}

}  // namespace hullslam
