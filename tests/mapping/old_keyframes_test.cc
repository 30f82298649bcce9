// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/old_keyframes.h"

#include <gtest/gtest.h>

#include <vector>

#include "map/invariants.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

constexpr size_t kKeypoints = 60;

class OldKeyframes : public testing::Test {
 protected:
  // A chain of keyframes, of which each shares 20 landmarks with the next one.
  void MakeChain(int count) {
    for (int i = 0; i < count; ++i) {
      ids_.push_back(AddKeyframe(map_, kKeypoints));
      if (i > 0) {
        Share(map_, {ids_[ids_.size() - 2], ids_.back()}, 20);
        UpdateCovisibility(map_, ids_.back());
      }
    }
    full_ = ids_;
  }
  bool IsFull(KeyframeId id) const {
    return map_.keyframes().At(id).frame->features.size() == kKeypoints;
  }

  Map map_;
  std::vector<KeyframeId> ids_;
  std::vector<KeyframeId> full_;
};

TEST_F(OldKeyframes, TwentyStayFull) {
  MakeChain(30);
  CompactOldKeyframes(map_, ids_.back(), full_);
  for (size_t i = 0; i < ids_.size(); ++i) {
    EXPECT_EQ(IsFull(ids_[i]), i >= 9) << i;
  }
  EXPECT_EQ(full_, std::vector<KeyframeId>(ids_.begin() + 9, ids_.end()));
  EXPECT_TRUE(FindViolations(map_).empty());
}

TEST_F(OldKeyframes, NeighboursOfNeighboursStayFull) {
  MakeChain(30);
  // The camera is back at the sixth keyframe.
  Share(map_, {ids_[5], ids_.back()}, 20);
  UpdateCovisibility(map_, ids_.back());
  CompactOldKeyframes(map_, ids_.back(), full_);
  for (size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(IsFull(ids_[i]), i >= 4 && i <= 6) << i;
  }
  EXPECT_TRUE(FindViolations(map_).empty());
}

TEST_F(OldKeyframes, CulledOnesAreForgotten) {
  MakeChain(6);
  map_.CullKeyframe(ids_[2]);
  CompactOldKeyframes(map_, ids_.back(), full_);
  EXPECT_EQ(full_, (std::vector<KeyframeId>{ids_[0], ids_[1], ids_[3], ids_[4], ids_[5]}));
}

}  // namespace
}  // namespace hullslam
