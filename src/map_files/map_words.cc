// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/map_records.h"

namespace hullslam {

void WriteWords(const Frame& frame, ByteWriter& out) {
  out.PutFlag(!frame.words.empty());
  for (const WordId word : frame.words) {
    out.Put(word.value);
  }
}

void ReadWords(Frame& frame, ByteReader& in) {
  if (!in.GetFlag()) {
    return;
  }
  in.Require(frame.features.size() <= in.left() / sizeof(uint32_t),
             "has fewer words than keypoints");
  frame.words.reserve(frame.features.size());
  for (size_t i = 0; i < frame.features.size(); ++i) {
    frame.words.push_back(WordId(in.Get<uint32_t>()));
  }
}

}  // namespace hullslam
