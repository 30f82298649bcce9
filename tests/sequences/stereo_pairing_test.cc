// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/stereo_pairing.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

constexpr double kRate = 20.0;  // images per second

class StereoPairing : public ::testing::Test {
 protected:
  // Stamps that begin at `begin` and are `step` apart.
  static std::vector<double> Stamps(size_t count, double begin = 100.0, double step = 1.0 / kRate) {
    std::vector<double> stamps;
    for (size_t i = 0; i < count; ++i) {
      stamps.push_back(begin + step * static_cast<double>(i));
    }
    return stamps;
  }
  std::vector<IndexPair> Pair(const std::vector<double>& left, const std::vector<double>& right) {
    return PairStereoStamps("a.bag", {"/left", left}, {"/right", right}, kRate, warnings_);
  }

  std::vector<std::string> warnings_;
};

TEST_F(StereoPairing, ASmallDelayChangesNothing) {
  const std::vector<IndexPair> pairs = Pair(Stamps(30), Stamps(30, 100.002));
  ASSERT_EQ(pairs.size(), 30u);
  EXPECT_EQ(pairs[7], (IndexPair{7, 7}));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(StereoPairing, ImagesWithoutAPartnerAreCountedAndSaid) {
  std::vector<double> right = Stamps(31, 99.95);  // one more at the begin
  right.erase(right.begin() + 4);                 // the partner of 3
  const std::vector<IndexPair> pairs = Pair(Stamps(30), right);
  ASSERT_EQ(pairs.size(), 29u);
  EXPECT_EQ(pairs[2], (IndexPair{2, 3}));
  EXPECT_EQ(pairs[3], (IndexPair{4, 4}));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0],
            "a.bag: 1 of 30 images of /left and 1 of 30 of /right have no partner within 2.5 ms "
            "and are left out");
}

TEST_F(StereoPairing, CamerasThatAreNotSynchronisedAreRefused) {
  ExpectInputError([&] { Pair(Stamps(30), Stamps(30, 100.02)); },
                   {"a.bag: 0 of 30 images of /left have one of /right within 2.5 ms",
                    "smallest gap is 20.0 ms", "synchronised"});
  ExpectInputError([&] { Pair(Stamps(30), {}); }, {"0 of 30"});
}

// Each pair is near enough, so nothing but the drift tells.
TEST_F(StereoPairing, StampsThatDriftApartAreRefused) {
  ExpectInputError([&] { Pair(Stamps(100), Stamps(100, 99.998, 0.05004)); },
                   {"a.bag: the stamps of /left and /right drift apart",
                    "-1.8 ms later at the begin", "1.8 ms later at the end"});
  EXPECT_EQ(Pair(Stamps(100), Stamps(100, 99.998, 0.05002)).size(), 100u);
}

}  // namespace
}  // namespace hullslam
