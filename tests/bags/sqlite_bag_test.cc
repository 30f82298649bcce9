// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/sqlite_bag.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
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

// The files of a recorder that was killed: its third message is in the log only.
std::filesystem::path MakeCrashed(const std::filesystem::path& recording,
                                  const std::filesystem::path& folder) {
  sqlite3* recorder = nullptr;  // it has not closed the file
  sqlite3_open(recording.c_str(), &recorder);
  sqlite3_exec(recorder,
               "PRAGMA journal_mode = WAL; INSERT INTO messages SELECT 9, 1, 3, data FROM messages "
               "WHERE id = 1",
               nullptr, nullptr, nullptr);
  std::filesystem::create_directory(folder);
  for (const char* const ending : {"", "-wal"}) {
    std::filesystem::copy_file(recording.string() + ending,
                               folder / (std::string("a.db3") + ending));
  }
  sqlite3_close(recorder);
  return folder / "a.db3";
}

TEST_F(SqliteBagTest, MessagesThatAreOnlyInTheLogOfARecorderAreRead) {
  const auto crashed = MakeCrashed(path_, folder_.path() / "crashed");
  const std::string database = ReadFile(crashed);
  const std::string log = ReadFile(crashed.string() + "-wal");
  EXPECT_EQ(CountMessages(crashed), 3u);
  SqliteBag bag(crashed);
  EXPECT_EQ(bag.Read({0, 9, 0}), std::string(9000, 'x'));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(crashed.parent_path()), {}), 2);
  EXPECT_EQ(ReadFile(crashed), database);
  EXPECT_EQ(ReadFile(crashed.string() + "-wal"), log);
}

// Without a copy, an interrupted program leaves nothing, and a log may be as large as the disk.
TEST_F(SqliteBagTest, ALogIsReadWithoutACopy) {
  const auto crashed = MakeCrashed(path_, folder_.path() / "crashed");
  const char* const former = std::getenv("TMPDIR");
  const std::string kept = former == nullptr ? "" : former;
  ::setenv("TMPDIR", (folder_.path() / "missing").c_str(), 1);
  EXPECT_EQ(CountMessages(crashed), 3u);
  former == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
}

TEST_F(SqliteBagTest, ALogThatIsCutOffOrOfAnotherFileIsReadAsFarAsItIsValid) {
  const auto crashed = MakeCrashed(path_, folder_.path() / "crashed");
  const std::string log = ReadFile(crashed.string() + "-wal");
  folder_.Write("crashed/a.db3-wal", log.substr(0, log.size() / 2));
  EXPECT_EQ(CountMessages(crashed), 2u);
  folder_.Write("crashed/a.db3-wal", "no log");
  EXPECT_EQ(CountMessages(crashed), 2u);
}

// A journal that SQLite rolls back: its end names another journal (the "super-journal"), which
// SQLite then deletes.
std::string JournalThatNames(const std::filesystem::path& victim, uint32_t pages) {
  constexpr const char* kMagic = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
  constexpr uint32_t kPage = 4096;
  constexpr uint32_t kSector = 512;
  const auto number = [](uint32_t value) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) {
      bytes += static_cast<char>(value >> shift & 0xffu);
    }
    return bytes;
  };
  std::string journal =
      kMagic + number(0) + number(1234) + number(pages) + number(kSector) + number(kPage);
  journal.resize(kSector, '\0');
  const std::string name = victim.string();
  uint32_t checksum = 0;
  for (const char c : name) {
    checksum += static_cast<uint32_t>(static_cast<signed char>(c));
  }
  return journal + number(0x40000000u / kPage + 1) + name +
         number(static_cast<uint32_t>(name.size())) + number(checksum) + kMagic;
}

TEST_F(SqliteBagTest, AJournalDeletesNoFileOfTheUser) {
  const auto pages = static_cast<uint32_t>(std::filesystem::file_size(path_) / 4096);
  const auto victim = folder_.Write("victim.txt", "precious");
  const std::string journal = JournalThatNames(victim, pages);
  folder_.Write("a.db3-journal", journal);
  ExpectInputError([&] { ScanSqlite(path_); },
                   {"a.db3: its recorder was stopped", "a.db3-journal beside it can undo"});
  EXPECT_TRUE(std::filesystem::exists(victim));
  EXPECT_EQ(ReadFile(folder_.path() / "a.db3-journal"), journal);
  // A link to the recording has no journal beside it, but the recording has one.
  std::filesystem::create_directory(folder_.path() / "links");
  std::filesystem::create_symlink(path_, folder_.path() / "links" / "a.db3");
  ExpectInputError([&] { ScanSqlite(folder_.path() / "links" / "a.db3"); }, {"recorder"});
  // SQLite would roll this one back. So the journal is as this test says.
  RunSql(path_, "SELECT count(*) FROM messages");
  EXPECT_FALSE(std::filesystem::exists(victim));
}

TEST_F(SqliteBagTest, AJournalOfAFinishedChangeIsNoFault) {
  folder_.Write("a.db3-journal", "");
  EXPECT_EQ(CountMessages(path_), 2u);
  RunSql(path_, "PRAGMA journal_mode = PERSIST; UPDATE messages SET timestamp = 5");
  ASSERT_GT(std::filesystem::file_size(path_.string() + "-journal"), 0u);
  EXPECT_EQ(CountMessages(path_), 2u);
}

TEST_F(SqliteBagTest, LinksAndFoldersBesideARecordingAreRefused) {
  const auto other = folder_.Write("other", "secret");
  for (const std::string ending : {"-wal", "-journal"}) {
    const std::filesystem::path beside = path_.string() + ending;
    std::filesystem::create_symlink(other, beside);
    ExpectInputError([&] { ScanSqlite(path_); },
                     {"a.db3" + ending + ": is a link, which is not followed"});
    std::filesystem::remove(beside);
    std::filesystem::create_symlink(folder_.path() / "missing", beside);
    ExpectInputError([&] { ScanSqlite(path_); }, {"is a link"});
    std::filesystem::remove(beside);
    std::filesystem::create_directory(beside);
    ExpectInputError([&] { ScanSqlite(path_); }, {"a.db3" + ending + ": is not a regular file"});
    std::filesystem::remove(beside);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "missing"));
}

// SQLite itself opens or makes this file to read the log, and writes into it.
TEST_F(SqliteBagTest, SharedMemoryBesideARecordingIsNotTouched) {
  const auto crashed = MakeCrashed(path_, folder_.path() / "crashed");
  const auto other = folder_.Write("other", "precious");
  std::filesystem::create_symlink(other, crashed.string() + "-shm");
  EXPECT_EQ(CountMessages(crashed), 3u);
  EXPECT_EQ(ReadFile(other), "precious");
}

TEST_F(SqliteBagTest, ALinkToARecordingFindsTheLogBesideItselfOrBesideTheRecording) {
  const auto crashed = MakeCrashed(path_, folder_.path() / "crashed");
  const auto links = folder_.path() / "links";
  std::filesystem::create_directory(links);
  std::filesystem::create_symlink(crashed, links / "b.db3");
  EXPECT_EQ(CountMessages(links / "b.db3"), 3u);
  std::filesystem::rename(crashed.string() + "-wal", links / "b.db3-wal");
  EXPECT_EQ(CountMessages(links / "b.db3"), 3u);
  EXPECT_EQ(CountMessages(crashed), 2u);
}

}  // namespace
}  // namespace hullslam
