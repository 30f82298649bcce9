// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <istream>
#include <string>

#include "hullslam/map_files/map_file.h"

namespace hullslam {

// Reads the records of a map file of this version of the format: everything except the first bytes,
// which name the format, and the checksum at the end. They are the next `size` bytes of the stream
// and may have any values. `name` begins all messages. `expected` are the settings of the run; null
// if any settings are allowed. Throws InputError and ReadingCancelled like ReadMap().
StoredMap ParseMap(std::istream& in, uint64_t size, const std::string& name,
                   const MapSettings* expected,
                   std::shared_ptr<const Vocabulary> vocabulary = nullptr,
                   const Cancellation* cancellation = nullptr);

// Throws ReadingCancelled if that was requested.
void EndIfCancelled(const Cancellation* cancellation, const std::string& name);

}  // namespace hullslam
