// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_layout.h"

#include <gtest/gtest.h>

namespace hullslam::synthetic {
namespace {

TEST(SequenceLayout, TumHasStampsInMicroseconds) {
  const SequenceLayout layout;
  EXPECT_EQ(layout.Stamp(0), 1000.0);
  EXPECT_NEAR(layout.Stamp(1), 1000.033333, 1e-9);
  EXPECT_NEAR(layout.Stamp(30), 1001.0, 1e-9);
  EXPECT_EQ(layout.Stem(1), "1000.033333");
  EXPECT_EQ(layout.TumFolder(), "");
  EXPECT_EQ(DatasetName(layout.form), "tum");
}

TEST(SequenceLayout, IclHasNumbersFromZero) {
  const SequenceLayout layout{DatasetForm::kIcl};
  EXPECT_EQ(layout.Stamp(0), 0.0);
  EXPECT_NEAR(layout.Stamp(1), 0.033333, 1e-9);
  EXPECT_EQ(layout.Stem(0), "0");
  EXPECT_EQ(layout.Stem(120), "120");
  EXPECT_EQ(layout.TumFolder(), "tum");
  EXPECT_EQ(DatasetName(layout.form), "icl");
}

TEST(SequenceLayout, KnowsTheEntriesOfASequence) {
  const SequenceLayout tum;
  const SequenceLayout icl{DatasetForm::kIcl};
  EXPECT_TRUE(tum.IsEntry("rgb.txt", "desk"));
  EXPECT_FALSE(tum.IsEntry("associations.txt", "desk"));
  EXPECT_TRUE(icl.IsEntry("associations.txt", "icl0"));
  EXPECT_TRUE(icl.IsEntry("icl0.gt.freiburg", "icl0"));
  EXPECT_FALSE(icl.IsEntry("icl1.gt.freiburg", "icl0"));
  for (const SequenceLayout& layout : {tum, icl}) {
    EXPECT_FALSE(layout.IsEntry("thesis.txt", "icl0"));
    EXPECT_FALSE(layout.IsEntry("", "icl0"));
  }
}

}  // namespace
}  // namespace hullslam::synthetic
