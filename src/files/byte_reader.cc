// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/byte_reader.h"

#include "hullslam/util/error.h"

namespace hullslam {

void ByteReader::Fail(const char* fault) const { throw InputError(name_ + ' ' + fault); }

}  // namespace hullslam
