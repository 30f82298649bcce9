// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace hullslam {

// What numpy.save() writes before the numbers.
inline std::string NpyHeader(const std::string& type, const std::string& shape,
                             const std::string& fortran_order = "False") {
  const std::string header = "{'descr': '" + type + "', 'fortran_order': " + fortran_order +
                             ", 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY\x01";
  bytes += '\0';
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  return bytes + header;
}

}  // namespace hullslam
