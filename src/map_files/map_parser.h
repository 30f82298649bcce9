// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <istream>
#include <string>

#include "hullslam/map_files/map_file.h"

namespace hullslam {

// Reads the records of a map file of this version of the format: everything but the first bytes,
// which name the format, and the checksum at the end. There are `size` bytes from the stream's
// place on. They may be any bytes. Throws InputError that begins with `name` as ReadMap() does;
// `expected` may be null.
StoredMap ParseMap(std::istream& in, uint64_t size, uint32_t version, const std::string& name,
                   const MapSettings* expected,
                   std::shared_ptr<const Vocabulary> vocabulary = nullptr,
                   const Cancellation* cancellation = nullptr);

// Throws ReadingCancelled if that was requested.
void EndIfCancelled(const Cancellation* cancellation, const std::string& name);

}  // namespace hullslam
