// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/embedded_masks.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "masks/mask_fixture.h"
#include "support/made_npy.h"

namespace hullslam {
namespace {

// The first of the two frames has three instances, of which the second is outside of the image.
class EmbeddedMasksTest : public MaskFixture {
 protected:
  EmbeddedMasksTest() : MaskFixture("boxes") {
    Write("1.5.txt", "41 10 10 50 50 0.9\n41 900 10 50 50 0.9\n63 100 100 80 80 0.5\n");
    Write("2.5.txt", "41 10 10 50 50 0.9\n");
  }
  void WriteVectors(const std::string& name, const std::string& shape,
                    const std::vector<float>& values) const {
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    Write(name, NpyHeader("<f4", shape) + bytes);
  }
};

TEST_F(EmbeddedMasksTest, WithoutFilesThereAreNoVectors) {
  EXPECT_TRUE(ReadFrame(0).masks.at(0).embedding.empty());
}

TEST_F(EmbeddedMasksTest, RowsBelongToTheInstancesOfTheFile) {
  WriteVectors("1.5.npy", "(3, 2)", {3, 0, 7, 7, 0, -2});
  const FrameMasks frame = ReadFrame(0);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks[0].embedding, (std::vector<float>{3, 0}));
  EXPECT_EQ(frame.masks[1].embedding, (std::vector<float>{0, -2}));
  EXPECT_TRUE(ReadFrame(1).masks.at(0).embedding.empty()) << "the frame has no file of vectors";
}

TEST_F(EmbeddedMasksTest, AJsonFileHasAFolderOfItsName) {
  EXPECT_EQ(EmbeddingFolder(folder_.path() / "sam.json"), folder_.path() / "sam");
  EXPECT_EQ(EmbeddingFolder(Path()), Path());
}

TEST_F(EmbeddedMasksTest, RefusesVectorsThatDoNotFit) {
  WriteVectors("1.5.npy", "(2, 2)", {3, 0, 0, 1});
  ExpectRefusal({Path("1.5.npy"), "2 vector(s) of 2 numbers", "each of the 3 instance(s)"});
  WriteVectors("1.5.npy", "(3, 2)", {3, 0, 1, 1, 0, 0});
  ExpectRefusal({Path("1.5.npy"), "row 2 has only zeros"});
  WriteVectors("1.5.npy", "(3, 2)", {3, 0, 1, 1, 0, 1});
  WriteVectors("2.5.npy", "(1, 3)", {3, 0, 1});
  ExpectRefusal({Path("2.5.npy"), "1 vector(s) of 3 numbers", "2 numbers as in the first"});
  Write("2.5.npy", "text");
  ExpectRefusal({Path("2.5.npy"), "is no array"});
}

}  // namespace
}  // namespace hullslam
