// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/sqlite_bag.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <system_error>
#include <utility>

#include "bags/read_only_vfs.h"
#include "files/paths.h"
#include "files/random_access_file.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

std::string TextOf(sqlite3_stmt* statement, int column) {
  const unsigned char* const text = sqlite3_column_text(statement, column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

// The size of a file beside a recording; 0 if there is none. A link there is not followed, because
// it may lead anywhere, and is not ignored, because messages may be behind it.
uint64_t SizeBeside(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (!fs::exists(status)) {
    return 0;
  }
  if (!fs::is_regular_file(status)) {
    throw InputError(fmt::format(
        "{}: is {}, expected the file that the recorder wrote, or nothing", file.string(),
        fs::is_symlink(status) ? "a link, which is not followed" : "not a regular file"));
  }
  const uint64_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

// SQLite overwrites the first bytes of a journal with zeros when the change is finished.
void CheckJournal(const fs::path& path) {
  const fs::path journal = path.string() + "-journal";
  if (SizeBeside(journal) > 0 && RandomAccessFile(journal).Read(0, 1) != std::string(1, '\0')) {
    throw InputError(fmt::format(
        "{}: its recorder was stopped in the middle of a change, or is still writing; the file {} "
        "beside it can undo the change, but is not used here; if you trust where the recording "
        "comes from, undo it with `sqlite3 FILE .tables`, and try again",
        path.string(), journal.filename().string()));
  }
}

// The absolute path under which the recording is opened: of a link to a recording, the one of the
// two that has a log beside it.
fs::path PathWithLog(const fs::path& path) {
  std::error_code error;
  const fs::path named = fs::absolute(path, error);
  const fs::path real = CanonicalPath(path);
  CheckJournal(named);
  CheckJournal(real);
  const bool is_log_here = SizeBeside(named.string() + "-wal") > 0;
  return is_log_here ? named : real;
}

}  // namespace

void SqliteBag::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

void SqliteBag::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteBag::SqliteBag(std::filesystem::path path)
    : path_(std::move(path)),
      opened_(PathWithLog(path_)),
      expansion_(path_, SizeBeside(opened_.string() + "-wal")) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(opened_.c_str(), &database, SQLITE_OPEN_READONLY, ReadOnlyVfs());
  database_.reset(database);
  if (code != SQLITE_OK) {
    Fail();
  }
  // A file may come from anywhere: nothing in its schema is run, and no value is larger than this.
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostBagBytes));
  Next(Prepare("PRAGMA locking_mode = EXCLUSIVE"));  // needs no memory that processes share
  CheckTables();
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
