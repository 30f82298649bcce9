// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/read_only_vfs.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <filesystem>
#include <iterator>
#include <string>

#include "files/read_file.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class ReadOnlyVfsTest : public ::testing::Test {
 protected:
  ReadOnlyVfsTest() {
    sqlite3* database = nullptr;
    sqlite3_open(path_.c_str(), &database);
    EXPECT_EQ(Run(database, "CREATE TABLE t(a); INSERT INTO t VALUES (1), (2)"), SQLITE_OK);
    sqlite3_close(database);
  }

  static int Run(sqlite3* database, const char* text) {
    return sqlite3_exec(database, text, nullptr, nullptr, nullptr);
  }

  // The code of the first statement that reads or writes, or that of opening.
  int RunReadOnly(const std::filesystem::path& path, const char* text,
                  int flags = SQLITE_OPEN_READONLY) {
    sqlite3* database = nullptr;
    int code = sqlite3_open_v2(path.c_str(), &database, flags, ReadOnlyVfs());
    if (code == SQLITE_OK) {
      Run(database, "PRAGMA locking_mode = EXCLUSIVE");
      code = Run(database, text);
    }
    sqlite3_close(database);
    return code;
  }

  int FilesInFolder() const {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "a.db";
};

TEST_F(ReadOnlyVfsTest, ADatabaseIsReadAndNotWritten) {
  const std::string bytes = ReadFile(path_);
  EXPECT_EQ(RunReadOnly(path_, "SELECT * FROM t"), SQLITE_OK);
  EXPECT_EQ(RunReadOnly(path_, "DELETE FROM t"), SQLITE_READONLY);
  EXPECT_NE(RunReadOnly(path_, "DELETE FROM t", SQLITE_OPEN_READWRITE), SQLITE_OK);
  EXPECT_NE(RunReadOnly(path_, "PRAGMA journal_mode = WAL; DELETE FROM t", SQLITE_OPEN_READWRITE),
            SQLITE_OK);
  EXPECT_EQ(ReadFile(path_), bytes);
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(ReadOnlyVfsTest, ADatabaseThatIsMissingIsNotMade) {
  EXPECT_EQ(
      RunReadOnly(folder_.path() / "b.db", "SELECT 1", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE),
      SQLITE_CANTOPEN);
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(ReadOnlyVfsTest, AFolderOrPipeIsNotOpened) {
  EXPECT_EQ(RunReadOnly(folder_.path(), "SELECT * FROM t"), SQLITE_CANTOPEN);
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(RunReadOnly(folder_.path() / "pipe", "SELECT * FROM t"), SQLITE_CANTOPEN);
}

TEST_F(ReadOnlyVfsTest, OnlyTheDatabaseItselfIsOpened) {
  const std::string attach = "ATTACH '" + (folder_.path() / "b.db").string() + "' AS b";
  EXPECT_NE(RunReadOnly(path_, attach.c_str(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE),
            SQLITE_OK);
  EXPECT_EQ(FilesInFolder(), 1);
}

TEST_F(ReadOnlyVfsTest, TheModeWalNeedsNoFiles) {
  sqlite3* writer = nullptr;
  sqlite3_open(path_.c_str(), &writer);
  Run(writer, "PRAGMA journal_mode = WAL");
  sqlite3_close(writer);
  EXPECT_EQ(RunReadOnly(path_, "SELECT * FROM t"), SQLITE_OK);
  EXPECT_EQ(FilesInFolder(), 1);
}

// The log is a link, so its content is not known.
TEST_F(ReadOnlyVfsTest, ALogThatIsALinkIsNotOpened) {
  const auto other = folder_.Write("other", std::string(10'000, 'x'));
  std::filesystem::create_symlink(other, path_.string() + "-wal");
  EXPECT_EQ(RunReadOnly(path_, "SELECT * FROM t"), SQLITE_CANTOPEN);
}

// Sorting that does not fit into the cache writes temporary files, which are those of SQLite.
TEST_F(ReadOnlyVfsTest, MuchIsSortedInTemporaryFiles) {
  EXPECT_EQ(RunReadOnly(path_,
                        "PRAGMA cache_size = 10; WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT "
                        "i + 1 FROM n LIMIT 100000) SELECT hex(randomblob(8)) AS h FROM n ORDER BY "
                        "h"),
            SQLITE_OK);
  EXPECT_EQ(FilesInFolder(), 1);
}

}  // namespace
}  // namespace hullslam
