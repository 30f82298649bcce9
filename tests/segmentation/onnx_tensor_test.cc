// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "segmentation/onnx_file.h"
#include "support/expect_error.h"
#include "support/made_network.h"

namespace hullslam {
namespace {

constexpr int kFloat = 1;
constexpr int kInt64 = 7;
constexpr int kHalf = 10;

ProtobufMessage Tensor(const std::vector<int64_t>& shape, uint64_t type) {
  ProtobufMessage tensor;
  for (const int64_t side : shape) {
    tensor.Number(1, static_cast<uint64_t>(side));
  }
  return tensor.Number(2, type).Text(8, "w");
}

// Field 9 has bytes, the others numbers of their own types.
TEST(OnnxTensor, HasAsManyValuesAsItsShapeSays) {
  for (const ProtobufMessage& good : {
           Tensor({2, 3}, kFloat).Text(9, std::string(24, 'x')), Tensor({}, kFloat).Text(9, "1234"),
           Tensor({0}, kFloat), Tensor({2}, kFloat).Text(4, std::string(8, 'x')),  // packed
           Tensor({2}, kInt64).Number(7, 300).Number(7, 1),                        // not packed
           Tensor({2}, kInt64).Text(7, "\xac\x02\x01"),  // packed: 300 and 1
           Tensor({3}, kHalf).Text(9, "123456"), Tensor({1}, kHalf).Number(5, 7),
           Tensor({2}, 8).Text(6, "").Text(6, "b"),  // texts
       }) {
    EXPECT_EQ(ReadTensor(good.bytes()).name, "w");
  }
  EXPECT_EQ(ReadTensor(Tensor({2, 3}, kFloat).Text(9, std::string(24, 'x')).bytes()).shape,
            (std::vector<int64_t>{2, 3}));
}

TEST(OnnxTensor, OthersAreRefusedBecauseOpencvWouldReadBehindTheirEnd) {
  const std::string raw(24, 'x');
  for (const auto& [tensor, part] : std::vector<std::pair<ProtobufMessage, std::string>>{
           {Tensor({2, 4}, kFloat).Text(9, raw), "has 6 values of the type float, expected 8"},
           {Tensor({1}, kFloat).Text(9, raw), "expected 1"},
           {Tensor({2, 3}, kFloat), "has 0 values"},
           {Tensor({0, 3}, kFloat).Text(9, raw), "expected 0"},
           {Tensor({2, 3}, 3).Text(9, raw), "has 24 values of the type int8"},
           {Tensor({2, 3}, kInt64).Text(9, raw), "has 3 values"},
           {Tensor({5}, kFloat).Text(9, std::string(23, 'x')), "another type"},
           {Tensor({2}, kFloat).Number(5, 1).Number(5, 2), "another type"},
           {Tensor({2}, kFloat).Text(9, "12345678").Text(4, "12345678"), "another type"},
           {Tensor({1}, 8).Text(9, "text"), "another type"},
           {Tensor({-1, 6}, kFloat).Text(9, raw), "negative or too large"},
           {Tensor({int64_t{1} << 32, 0}, kFloat), "negative or too large"},
           {Tensor({1 << 16, 1 << 16}, kFloat).Text(9, raw), "negative or too large"},
           {Tensor({int64_t{1} << 31, int64_t{1} << 31, int64_t{1} << 31, 4}, kFloat), "too large"},
           {Tensor({6}, 99).Text(9, raw), "the data type 99"},
           {Tensor({6}, 0).Text(9, raw), "the data type 0"},
       }) {
    ExpectInputError([&, bytes = tensor.bytes()] { ReadTensor(bytes); }, {"'w'", part});
  }
}

TEST(OnnxTensor, ValuesInAnotherFileAreNotCounted) {
  const OnnxTensor tensor =
      ReadTensor(Tensor({2, 3}, kFloat)
                     .Message(13, ProtobufMessage().Text(1, "location").Text(2, "weights.bin"))
                     .Message(13, ProtobufMessage().Text(1, "offset").Text(2, "0"))
                     .bytes());
  EXPECT_EQ(tensor.file, "weights.bin");
}

TEST(OnnxTensor, IntegersMayBePacked) {
  EXPECT_EQ(ReadIntegers(ProtobufMessage().Number(8, 3).Number(7, 1).Number(8, 4).bytes(), 8),
            (std::vector<int64_t>{3, 4}));
  EXPECT_EQ(ReadIntegers(ProtobufMessage().Text(8, "\x03\xac\x02").bytes(), 8),
            (std::vector<int64_t>{3, 300}));
  EXPECT_EQ(ReadIntegers(ProtobufMessage().Number(8, ~uint64_t{0}).bytes(), 8),
            (std::vector<int64_t>{-1}));
  EXPECT_TRUE(ReadIntegers(ProtobufMessage().Text(8, "").bytes(), 8).empty());
}

}  // namespace
}  // namespace hullslam
