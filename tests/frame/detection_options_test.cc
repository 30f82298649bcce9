// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/detection_options.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(DetectionOptions, AreSetByTheirKeys) {
  DetectionOptions options;
  OptionTable table;
  options.Bind(OptionScope(table, "objects.detection"));
  table.Set("objects.detection.primitive", "bbox", "test");
  table.Set("objects.detection.epsilon_px", "6", "test");
  table.Set("objects.detection.min_score", "0.5", "test");
  EXPECT_EQ(options.primitive, ObjectPrimitive::kBox);
  EXPECT_EQ(options.epsilon_px, 6.0);
  EXPECT_EQ(options.min_score, 0.5);
}

TEST(DetectionOptions, TellWhatIsExpected) {
  DetectionOptions options;
  OptionTable table;
  options.Bind(OptionScope(table, "objects.detection"));
  ExpectInputError(
      [&] { table.Set("objects.detection.primitive", "outline", "--set"); },
      {"objects.detection.primitive", "'outline'", "support, hull, contour, bbox, conic"});
  ExpectInputError([&] { table.Set("objects.detection.epsilon_px", "-1", "--set"); },
                   {"objects.detection.epsilon_px", "'-1'", "from 0 to 100"});
  ExpectInputError([&] { table.Set("objects.detection.min_score", "1.5", "--set"); },
                   {"objects.detection.min_score", "'1.5'", "from 0 to 1"});
}

}  // namespace
}  // namespace hullslam
