// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "bags/bag.h"
#include "bags/decompress.h"

struct sqlite3;
struct sqlite3_stmt;

namespace hullslam {

// A file of rosbag2 in the format of SQLite: the tables `topics` (id, name, type,
// serialization_format) and `messages` (id, topic_id, timestamp, data). Messages that rosbag2
// compressed one by one with zstd are recognised by their first bytes. Nothing is written or
// deleted. Messages that a recorder has left in the log beside the file (-wal) are read. A file
// with a journal beside it (-journal) holds a change that was never finished, and is refused,
// because only SQLite can undo the change, and a journal can make it delete any file of the user.
class SqliteBag final : public Bag {
 public:
  explicit SqliteBag(std::filesystem::path path);

  void Scan(const std::function<void(const BagMessage& message)>& visit) override;
  // The offset of a position is the id of the message.
  std::string Read(const MessagePosition& place) override;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  [[noreturn]] void Fail() const;
  void CheckTables() const;
  Statement Prepare(const char* text) const;
  // Goes to the next row; returns false behind the last one.
  bool Next(const Statement& statement) const;
  // The bytes in a column, decompressed.
  std::string Message(const Statement& statement, int column, int64_t id) const;
  // The indices of the topics by their ids in the file.
  std::map<int64_t, size_t> ReadTopics();

  std::filesystem::path path_;
  std::filesystem::path opened_;  // the same file, with its log beside it
  ExpansionLimit expansion_;
  std::unique_ptr<sqlite3, Close> database_;
  Statement read_;
};

}  // namespace hullslam
