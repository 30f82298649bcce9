// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/sqlite_bag.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"
#include "util/printable.h"

namespace hullslam {
namespace {

std::string TextOf(sqlite3_stmt* statement, int column) {
  const unsigned char* const text = sqlite3_column_text(statement, column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

// The files beside a database with changes that are not in it yet.
constexpr std::array<const char*, 2> kChanges = {"-wal", "-journal"};

bool HasChanges(const std::filesystem::path& path) {
  return std::any_of(kChanges.begin(), kChanges.end(), [&](const char* ending) {
    std::error_code error;
    const uintmax_t size = std::filesystem::file_size(path.string() + ending, error);
    return !error && size > 0;
  });
}

// An immutable database is read without locks and without files beside it, which SQLite else writes
// for the mode WAL, even to read.
std::string UriOf(const std::filesystem::path& path, bool is_immutable) {
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '%' || c == '?' || c == '#') {
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    } else {
      uri += c;
    }
  }
  return uri + (is_immutable ? "?immutable=1" : "");
}

}  // namespace

void SqliteBag::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

void SqliteBag::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteBag::SqliteBag(std::filesystem::path path) : path_(std::move(path)), expansion_(path_) {
  const bool has_changes = HasChanges(path_);
  const std::filesystem::path opened = has_changes ? CopyWithChanges() : path_;
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(
      UriOf(opened, !has_changes).c_str(), &database,
      SQLITE_OPEN_URI | (has_changes ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READONLY), nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) {
    Fail();
  }
  // A file may come from anywhere: nothing in its schema is run, and no value is larger than this.
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostBagBytes));
  CheckTables();
}

std::filesystem::path SqliteBag::CopyWithChanges() {
  try {
    copy_.emplace(std::filesystem::temp_directory_path(), "hullslam_bag_");
    std::filesystem::path copy = copy_->content() / "bag.db3";
    std::filesystem::copy_file(path_, copy);
    for (const char* const ending : kChanges) {
      if (std::filesystem::exists(path_.string() + ending)) {
        std::filesystem::copy_file(path_.string() + ending, copy.string() + ending);
      }
    }
    return copy;
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(fmt::format(
        "{}: was not closed by its recorder, and cannot be copied to apply the changes beside it: "
        "{}",
        path_.string(), error.code().message()));
  }
}

void SqliteBag::Fail() const {
  throw InputError(
      fmt::format("{}: {}", path_.string(), Printable(sqlite3_errmsg(database_.get()))));
}

void SqliteBag::CheckTables() const {
  const Statement statement = Prepare(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages') "
      "AND sql NOT LIKE 'CREATE VIRTUAL%'");
  if (!Next(statement) || sqlite3_column_int(statement.get(), 0) != 2) {
    throw InputError(path_.string() +
                     ": has no tables 'topics' and 'messages', expected a file of rosbag2");
  }
}

SqliteBag::Statement SqliteBag::Prepare(const char* text) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), text, -1, &statement, nullptr);
  Statement owner(statement);
  if (code != SQLITE_OK) {
    Fail();
  }
  return owner;
}

bool SqliteBag::Next(const Statement& statement) const {
  const int code = sqlite3_step(statement.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    Fail();
  }
  return code == SQLITE_ROW;
}

std::string SqliteBag::Message(const Statement& statement, int column, int64_t id) const {
  constexpr std::string_view kZstdFrame = "\x28\xb5\x2f\xfd";  // plain CDR begins with a zero
  const void* const bytes = sqlite3_column_blob(statement.get(), column);
  const auto size = static_cast<size_t>(sqlite3_column_bytes(statement.get(), column));
  const std::string_view stored(static_cast<const char*>(bytes), bytes == nullptr ? 0 : size);
  return Decompress(stored.starts_with(kZstdFrame) ? Compression::kZstd : Compression::kNone,
                    stored, kMostBagBytes, fmt::format("{}: message {}", path_.string(), id));
}

std::map<int64_t, size_t> SqliteBag::ReadTopics() {
  std::map<int64_t, size_t> indices;
  const Statement statement =
      Prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  while (Next(statement)) {
    const std::string format = TextOf(statement.get(), 3);
    std::string type = TextOf(statement.get(), 2);
    if (format != "cdr") {
      type += fmt::format(" ({})", format);  // no type that is read
    }
    indices[sqlite3_column_int64(statement.get(), 0)] =
        AddTopic(TextOf(statement.get(), 1), type, MessageCoding::kCdr);
  }
  return indices;
}

void SqliteBag::Scan(const std::function<void(const BagMessage& message)>& visit) {
  const std::map<int64_t, size_t> indices = ReadTopics();
  const Statement statement =
      Prepare("SELECT id, topic_id, timestamp, data FROM messages ORDER BY id");
  while (Next(statement)) {
    const int64_t id = sqlite3_column_int64(statement.get(), 0);
    const auto topic = indices.find(sqlite3_column_int64(statement.get(), 1));
    if (topic == indices.end()) {
      throw InputError(
          fmt::format("{}: message {} is of a topic that is not listed", path_.string(), id));
    }
    ++topics_[topic->second].messages;
    const std::string bytes = Message(statement, 3, id);
    expansion_.Add(bytes.size());
    visit({topic->second,
           sqlite3_column_int64(statement.get(), 2),
           {0, static_cast<uint64_t>(id), bytes.size()},
           bytes});
  }
}

std::string SqliteBag::Read(const MessagePosition& place) {
  if (read_ == nullptr) {
    read_ = Prepare("SELECT data FROM messages WHERE id = ?");
  }
  const auto id = static_cast<int64_t>(place.offset);
  sqlite3_reset(read_.get());
  sqlite3_bind_int64(read_.get(), 1, id);
  if (!Next(read_)) {
    throw InputError(fmt::format("{}: message {} is missing", path_.string(), id));
  }
  return Message(read_, 0, id);
}

}  // namespace hullslam
