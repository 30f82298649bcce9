// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace hullslam {

// The rows of a matrix, one after the other.
struct FloatRows {
  size_t rows = 0;
  size_t columns = 0;
  std::vector<float> values;  // rows x columns

  std::span<const float> Row(size_t row) const {
    return std::span(values).subspan(row * columns, columns);
  }
};

// Reads an array that numpy.save() wrote: one row (one dimension) or rows (two dimensions) of
// finite little-endian numbers of 16, 32 or 64 bits, in the order of C. Format: numpy.lib.format,
// versions 1 to 3. Throws InputError with the name of the file and what was expected. (libcnpy is
// not used because it does not tell numbers from integers and believes any size in a damaged file.)
FloatRows ReadNpy(const std::filesystem::path& path);

}  // namespace hullslam
