// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/open_network.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "support/made_network.h"

namespace hullslam {
namespace {

TEST(OpenNetwork, OutputsAreInTheOrderOfTheFileAndOutliveTheNextRun) {
  const auto network = OpenNetwork(MadeNetwork().Bytes());
  const std::array<int, 4> shape = {1, 3, 96, 128};
  const auto first = network->Run(cv::Mat(4, shape.data(), CV_32F, cv::Scalar(0)));
  ASSERT_EQ(first.size(), 4U);
  EXPECT_EQ(first[3].name, "prototypes");
  EXPECT_EQ(first[3].values.size[2], 24);
  EXPECT_FLOAT_EQ(first[3].values.ptr<float>()[0], -10.0F);
  network->Run(cv::Mat(4, shape.data(), CV_32F, cv::Scalar(0.5)));
  network->Run(cv::Mat(4, shape.data(), CV_32F, cv::Scalar(1)));
  EXPECT_FLOAT_EQ(first[3].values.ptr<float>()[0], -10.0F);
}

TEST(OpenNetwork, OpencvSaysWhatItCannotReadOnlyInItsException) {
  EXPECT_THROW(OpenNetwork("no network"), NetworkError);
  ProtobufMessage node;
  node.Text(1, "images").Text(2, "out").Text(4, "Nonsense");
  ProtobufMessage graph;
  graph.Message(1, node).Text(2, "graph");
  ProtobufMessage model;
  model.Number(1, 8).Message(7, graph);
  testing::internal::CaptureStderr();
  EXPECT_THROW(OpenNetwork(model.bytes()), NetworkError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace hullslam
