// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

namespace hullslam {

// The changes of a RowTable: rows that were changed or added, and how many there are now.
struct RowChange {
  size_t count = 0;           // rows afterwards; those from here on are gone
  bool were_removed = false;  // whether there were such rows
  std::vector<uint32_t> at;   // the numbers of these rows
  std::vector<uint32_t> ids;  // one per entry of `at`
  std::vector<float> values;  // `width` per entry of `at`

  bool empty() const { return at.empty() && !were_removed; }
};

// A table of numbers as the browsers have it, by which only its changes need to be sent. Each row
// belongs to an id. Rows are without gaps: the last row moves to where one was removed.
class RowTable {
 public:
  // The first `compared` of the `width` numbers of a row may change.
  RowTable(size_t width, size_t compared) : width_(width), compared_(compared) {}

  // Gives the rows of the ids in `wanted`, which must differ. `read(i, row)` writes the `width`
  // numbers of wanted[i]. Rows of other ids are removed. Of the others, at most `most` rows are
  // added or changed, beginning where the last call has ended, so that each gets its turn. A row is
  // changed if one of its numbers has moved by more than `tolerance`.
  RowChange Update(const std::vector<uint32_t>& wanted,
                   const std::function<void(size_t, float*)>& read, float tolerance, size_t most);

  size_t size() const { return ids_.size(); }
  bool Contains(uint32_t id) const { return row_of_.count(id) != 0; }
  const std::vector<uint32_t>& ids() const { return ids_; }
  // `width` numbers for each id.
  const std::vector<float>& values() const { return values_; }

 private:
  void RemoveOthers(const std::vector<uint32_t>& wanted, std::vector<uint32_t>& moved);
  bool Differs(size_t row, const std::vector<float>& values, float tolerance) const;

  const size_t width_;
  const size_t compared_;
  std::vector<uint32_t> ids_;
  std::vector<float> values_;
  std::unordered_map<uint32_t, uint32_t> row_of_;
  size_t next_ = 0;  // index into `wanted` at which the next call begins
};

}  // namespace hullslam
