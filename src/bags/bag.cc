// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/bag.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "bags/mcap_bag.h"
#include "bags/ros1_bag.h"
#include "bags/sqlite_bag.h"
#include "files/paths.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd"sv;
constexpr std::string_view kSqliteMagic = "SQLite format 3\0"sv;

std::unique_ptr<Bag> OpenFile(const fs::path& path) {
  const std::string start = RandomAccessFile(path).Read(0, 32);
  if (start.starts_with(kMcapMagic)) {
    return std::make_unique<McapBag>(path);
  }
  if (start.starts_with(kSqliteMagic)) {
    return std::make_unique<SqliteBag>(path);
  }
  if (start.starts_with(kRos1Magic)) {
    return std::make_unique<Ros1Bag>(path);
  }
  if (start.starts_with(kZstdMagic)) {
    throw InputError(path.string() + ": is compressed as a whole, expected the result of unzstd");
  }
  throw InputError(path.string() +
                   ": is no bag, expected MCAP, SQLite of rosbag2, or a bag of ROS 1 (2.0)");
}

std::vector<fs::path> ListBags(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    for (const char* const ending : {".mcap", ".db3", ".mcap.zstd", ".db3.zstd"}) {
      if (name.ends_with(ending)) {
        files.push_back(entry->path());
      }
    }
  }
  if (error) {
    throw InputError(folder.string() + ": " + error.message());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return IsNaturallyBefore(a.filename().string(), b.filename().string());
  });
  return files;
}

}  // namespace

size_t Bag::AddTopic(const std::string& name, const std::string& type, MessageCoding coding) {
  constexpr size_t kMost = 100'000;
  std::string short_type = type;
  if (const size_t at = type.find("/msg/"); at != std::string::npos) {
    short_type.erase(at, 4);  // sensor_msgs/msg/Image in ROS 2
  }
  const auto [entry, is_new] = indices_.try_emplace({name, short_type, coding}, topics_.size());
  if (is_new) {
    if (topics_.size() == kMost) {
      throw InputError(fmt::format("the recording has more than {} topics", kMost));
    }
    topics_.push_back({name, short_type, 0, coding});
  }
  return entry->second;
}

void Bag::WarnOfMissingEnd(const RandomAccessFile& file, uint64_t record) {
  warnings_.push_back(fmt::format(
      "{}: ends at byte {} in the middle of the record at byte {}; the recording was not closed or "
      "is cut off, and is used up to there",
      file.path().string(), file.size(), record));
}

std::vector<std::unique_ptr<Bag>> OpenBags(const fs::path& path) {
  std::vector<std::unique_ptr<Bag>> bags;
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    bags.push_back(OpenFile(path));
    return bags;
  }
  for (const fs::path& file : ListBags(path)) {
    bags.push_back(OpenFile(file));
  }
  if (bags.empty()) {
    throw InputError(path.string() + ": has no file that ends in .mcap or .db3");
  }
  return bags;
}

}  // namespace hullslam
