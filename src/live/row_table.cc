// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/row_table.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "util/lists.h"

namespace hullslam {

// Removing goes from the last row to the first, so the row that fills a gap is always wanted.
void RowTable::RemoveOthers(const std::vector<uint32_t>& wanted, std::vector<uint32_t>& moved) {
  const std::unordered_set<uint32_t> kept(wanted.begin(), wanted.end());
  for (size_t row = ids_.size(); row-- > 0;) {
    if (kept.count(ids_[row]) != 0) {
      continue;
    }
    row_of_.erase(ids_[row]);
    const size_t last = ids_.size() - 1;
    if (row != last) {
      ids_[row] = ids_[last];
      std::copy_n(values_.begin() + static_cast<ptrdiff_t>(last * width_), width_,
                  values_.begin() + static_cast<ptrdiff_t>(row * width_));
      row_of_[ids_[row]] = static_cast<uint32_t>(row);
      moved.push_back(static_cast<uint32_t>(row));
    }
    ids_.pop_back();
    values_.resize(last * width_);
  }
}

bool RowTable::Differs(size_t row, const std::vector<float>& values, float tolerance) const {
  for (size_t i = 0; i < compared_; ++i) {
    if (std::abs(values[i] - values_[row * width_ + i]) > tolerance) {
      return true;
    }
  }
  return false;
}

RowChange RowTable::Update(const std::vector<uint32_t>& wanted,
                           const std::function<void(size_t, float*)>& read, float tolerance,
                           size_t most) {
  std::vector<uint32_t> changed;
  const size_t before = ids_.size();
  RemoveOthers(wanted, changed);
  const bool were_removed = ids_.size() < before;
  // A row that has moved into a gap can later lie behind the end.
  std::erase_if(changed, [&](uint32_t row) { return row >= ids_.size(); });
  std::vector<float> values(width_);
  next_ = next_ < wanted.size() ? next_ : 0;
  size_t visited = 0;
  size_t taken = 0;
  for (; visited < wanted.size() && taken < most; ++visited) {
    const size_t i = (next_ + visited) % wanted.size();
    read(i, values.data());
    const auto [found, is_new] = row_of_.try_emplace(wanted[i], static_cast<uint32_t>(ids_.size()));
    if (is_new) {
      ids_.push_back(wanted[i]);
      values_.insert(values_.end(), values.begin(), values.end());
    } else if (Differs(found->second, values, tolerance)) {
      std::copy(values.begin(), values.end(),
                values_.begin() + static_cast<ptrdiff_t>(found->second * width_));
    } else {
      continue;
    }
    changed.push_back(found->second);
    ++taken;
  }
  next_ = wanted.empty() ? 0 : (next_ + visited) % wanted.size();
  SortUnique(changed);
  RowChange change{.count = ids_.size(),
                   .were_removed = were_removed,
                   .at = std::move(changed),
                   .ids = {},
                   .values = {}};
  for (const uint32_t row : change.at) {
    change.ids.push_back(ids_[row]);
    const auto begin = values_.begin() + static_cast<ptrdiff_t>(row * width_);
    change.values.insert(change.values.end(), begin, begin + static_cast<ptrdiff_t>(width_));
  }
  return change;
}

}  // namespace hullslam
