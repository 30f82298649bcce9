// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/map_records.h"

namespace hullslam {

void WriteWords(const Frame&, ByteWriter& out) { out.PutFlag(false); }

void ReadWords(Frame&, ByteReader& in) {
  in.Require(!in.GetFlag(), "has words, which this version does not read");
}

}  // namespace hullslam
