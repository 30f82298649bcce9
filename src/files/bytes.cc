// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/bytes.h"

#include "hullslam/util/error.h"

namespace hullslam {

void ByteReader::Fail(const char* fault) const { throw InputError(name_ + ' ' + fault); }

}  // namespace hullslam
