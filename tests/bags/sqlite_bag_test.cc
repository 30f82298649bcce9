// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/sqlite_bag.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "support/expect_error.h"
#include "support/made_bags.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

void ScanSqlite(const std::filesystem::path& path) {
  SqliteBag bag(path);
  bag.Scan([](const BagMessage&) {});
}

void RunSql(const std::filesystem::path& path, const char* text) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  EXPECT_EQ(sqlite3_exec(database, text, nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
}

class SqliteBagTest : public ::testing::Test {
 protected:
  SqliteBagTest() {
    WriteMadeSqlite(path_, {{"/a", "sensor_msgs/Image", 1, std::string(9000, 'x')},
                            {"/a", "sensor_msgs/Image", 2, std::string(9000, 'y')}});
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "a.db3";
};

TEST_F(SqliteBagTest, ACutDatabaseIsRefused) {
  const std::string whole = ReadFile(path_);
  ExpectInputError([&] { ScanSqlite(folder_.Write("b.db3", whole.substr(0, 9000))); },
                   {"b.db3", "malformed"});
  ExpectInputError([&] { ScanSqlite(folder_.Write("c.db3", whole.substr(0, 50))); }, {"c.db3"});
}

TEST_F(SqliteBagTest, OtherDatabasesAreRefused) {
  RunSql(path_, "DROP TABLE messages");
  ExpectInputError([&] { ScanSqlite(path_); }, {"a.db3: has no tables 'topics' and 'messages'"});
  // A view could compute for ever.
  RunSql(path_,
         "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 "
         "FROM n) SELECT id, 1 AS topic_id, 2 AS timestamp, x'00' AS data FROM n");
  ExpectInputError([&] { ScanSqlite(path_); }, {"a.db3: has no tables 'topics' and 'messages'"});
}

TEST_F(SqliteBagTest, MessagesOfUnknownTopicsAreRefused) {
  RunSql(path_, "UPDATE messages SET topic_id = 9 WHERE id = 2");
  ExpectInputError([&] { ScanSqlite(path_); }, {"a.db3: message 2 is of a topic"});
}

TEST_F(SqliteBagTest, BrokenCompressionIsRefused) {
  RunSql(path_, "UPDATE messages SET data = x'28b52ffd0102030405' WHERE id = 1");
  ExpectInputError([&] { ScanSqlite(path_); }, {"a.db3: message 1", "compressed bytes"});
}

TEST_F(SqliteBagTest, OtherSerializationsAreListedOnly) {
  RunSql(path_, "UPDATE topics SET serialization_format = 'json'");
  SqliteBag bag(path_);
  bag.Scan([](const BagMessage&) {});
  ASSERT_EQ(bag.topics().size(), 1u);
  EXPECT_EQ(bag.topics()[0].type, "sensor_msgs/Image (json)");
}

size_t CountMessages(const std::filesystem::path& path) {
  SqliteBag bag(path);
  size_t count = 0;
  bag.Scan([&](const BagMessage&) { ++count; });
  return count;
}

// rosbag2 writes in the mode WAL. SQLite then makes two files beside a database to read it.
TEST_F(SqliteBagTest, NothingIsWrittenBesideAFileInTheModeWal) {
  RunSql(path_,
         "PRAGMA journal_mode = WAL; INSERT INTO messages SELECT 9, 1, 3, data FROM messages "
         "WHERE id = 1");
  const auto folder = folder_.path() / "read only?#%";
  std::filesystem::create_directory(folder);
  std::filesystem::copy_file(path_, folder / "a.db3");
  EXPECT_EQ(CountMessages(folder / "a.db3"), 3u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(SqliteBagTest, MessagesThatAreOnlyInTheLogOfARecorderAreRead) {
  sqlite3* recorder = nullptr;  // it has not closed the file
  sqlite3_open(path_.c_str(), &recorder);
  sqlite3_exec(recorder,
               "PRAGMA journal_mode = WAL; INSERT INTO messages SELECT 9, 1, 3, data FROM messages "
               "WHERE id = 1",
               nullptr, nullptr, nullptr);
  const auto crashed = folder_.path() / "crashed";
  std::filesystem::create_directory(crashed);
  for (const char* const ending : {"", "-wal"}) {
    std::filesystem::copy_file(path_.string() + ending, crashed / (std::string("a.db3") + ending));
  }
  sqlite3_close(recorder);
  const std::string log = ReadFile(crashed / "a.db3-wal");
  EXPECT_EQ(CountMessages(crashed / "a.db3"), 3u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(crashed), {}), 2);
  EXPECT_EQ(ReadFile(crashed / "a.db3-wal"), log);
}

}  // namespace
}  // namespace hullslam
