// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/bag_topics.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "support/expect_error.h"

namespace hullslam {
namespace {

IndexedTopic Colour(const std::string& name, bool is_compressed = false) {
  return {name,
          is_compressed ? "sensor_msgs/CompressedImage" : "sensor_msgs/Image",
          "bgr8",
          9,
          BagImageKind::kColour,
          std::vector<BagImage>(9),
          std::nullopt,
          is_compressed};
}

IndexedTopic Depth(const std::string& name) {
  return {name, "sensor_msgs/Image", "16UC1", 9, BagImageKind::kDepth, std::vector<BagImage>(9)};
}

IndexedTopic Camera(const std::string& name) {
  IndexedTopic topic{name, "sensor_msgs/CameraInfo", "", 9};
  topic.camera = CameraInfoMessage();
  return topic;
}

std::string ColourOfTopics(std::vector<IndexedTopic> topics, const std::string& name = "") {
  return ChooseImageTopic({"a.bag", std::move(topics)}, BagImageKind::kColour, name,
                          "--image-topic")
      .name;
}

std::string DepthOfTopics(std::vector<IndexedTopic> topics, const std::string& name = "") {
  return ChooseImageTopic({"a.bag", std::move(topics)}, BagImageKind::kDepth, name, "--depth-topic")
      .name;
}

TEST(BagTopicsTest, TheOnlyTopicOfAKindIsTaken) {
  EXPECT_EQ(ColourOfTopics({Colour("/cam"), Depth("/d"), Camera("/c")}), "/cam");
  EXPECT_EQ(DepthOfTopics({Colour("/cam"), Depth("/d")}), "/d");
}

TEST(BagTopicsTest, OfSeveralTopicsTheRawAndTheNamedOneIsTaken) {
  EXPECT_EQ(ColourOfTopics({Colour("/cam/image"), Colour("/cam/image/compressed", true)}),
            "/cam/image");
  EXPECT_EQ(ColourOfTopics({Colour("/cam/ir"), Colour("/cam/rgb/image")}), "/cam/rgb/image");
  EXPECT_EQ(DepthOfTopics({Depth("/cam/depth/image"), Depth("/cam/aligned_depth_to_color/image")}),
            "/cam/aligned_depth_to_color/image");
  EXPECT_EQ(ColourOfTopics({Colour("/left"), Colour("/right")}, "/right"), "/right");
}

std::string PairOfTopics(std::vector<IndexedTopic> topics, const std::string& left = "",
                         const std::string& right = "") {
  const BagIndex index{"a.bag", std::move(topics)};
  const auto pair = ChoosePairTopics(index, left, right, "--image-topic", "--right-topic");
  return pair[0]->name + " " + pair[1]->name;
}

TEST(BagTopicsTest, ThePairDiffersByOneWord) {
  EXPECT_EQ(PairOfTopics({Colour("/z/left/image"), Colour("/z/right/image"), Colour("/rgb"),
                          Depth("/z/left/depth")}),
            "/z/left/image /z/right/image");
  EXPECT_EQ(PairOfTopics({Colour("/infra1/image"), Colour("/infra2/image")}),
            "/infra1/image /infra2/image");
  EXPECT_EQ(PairOfTopics({Colour("/cam0/image_raw"), Colour("/cam0/image_raw/compressed", true),
                          Colour("/cam1/image_raw"), Colour("/cam1/image_raw/compressed", true)}),
            "/cam0/image_raw /cam1/image_raw");
  EXPECT_EQ(PairOfTopics({Colour("/left/raw"), Colour("/right/raw"), Colour("/left/image_rect"),
                          Colour("/right/image_rect")}),
            "/left/image_rect /right/image_rect");
}

TEST(BagTopicsTest, TheLastPartOfTheNameSaysWhetherImagesAreRectified) {
  for (const char* const name :
       {"/camera/rgb/image_rect_color", "/left/image_rect", "/infra1/image_rect_raw", "image_rect",
        "/left/Image_Rectified", "/rectified", "/cam/image_rect0", "/cam/rect.image"}) {
    EXPECT_TRUE(IsRectifiedTopic(Colour(name))) << name;
  }
  for (const char* const name :
       {"/camera/rgb/image_raw", "/direct_drive/left/image_raw", "/colour_corrected/image",
        "/rect/left/image_raw", "/left_rect/image", "/cam/direct", "/cam/image_rectangle",
        "/cam/"}) {
    EXPECT_FALSE(IsRectifiedTopic(Colour(name))) << name;
  }
  EXPECT_TRUE(IsRectifiedTopic(Colour("/left/image_rect/compressed", true)));
  EXPECT_FALSE(IsRectifiedTopic(Colour("/image_rect/left/compressed", true)));
}

TEST(BagTopicsTest, APairIsNotRectifiedByTheNameOfItsVehicle) {
  EXPECT_EQ(PairOfTopics({Colour("/direct/left/raw"), Colour("/direct/right/raw"),
                          Colour("/direct/left/image_rect"), Colour("/direct/right/image_rect")}),
            "/direct/left/image_rect /direct/right/image_rect");
}

TEST(BagTopicsTest, ThePairCanBeNamed) {
  const std::vector<IndexedTopic> topics = {Colour("/left/a"), Colour("/left/b"), Colour("/other"),
                                            Colour("/right/a"), Colour("/right/b")};
  EXPECT_EQ(PairOfTopics(topics, "/left/b"), "/left/b /right/b");
  EXPECT_EQ(PairOfTopics(topics, "", "/right/a"), "/left/a /right/a");
  EXPECT_EQ(PairOfTopics(topics, "/left/b", "/other"), "/left/b /other");
  ExpectInputError(
      [&] { PairOfTopics(topics); },
      {"a.bag: has 2 pairs of topics", "--image-topic TOPIC and --right-topic TOPIC", "/left/a"});
  ExpectInputError([&] { PairOfTopics(topics, "/other"); }, {"has 0 pairs"});
  ExpectInputError([&] { PairOfTopics(topics, "/other", "/other"); }, {"has 0 pairs"});
}

// mono16 is the depth of some cameras, and the image of others.
TEST(BagTopicsTest, GreyOf16BitsIsWhatNoOtherTopicIs) {
  const auto either = [](const std::string& name) {
    IndexedTopic topic = Depth(name);
    topic.kind = BagImageKind::kEither;
    return topic;
  };
  EXPECT_EQ(DepthOfTopics({Colour("/cam"), either("/depth")}), "/depth");
  EXPECT_EQ(DepthOfTopics({Colour("/cam"), either("/range")}), "/range");
  EXPECT_EQ(DepthOfTopics({either("/cam"), either("/depth")}), "/depth");
  EXPECT_EQ(DepthOfTopics({either("/cam"), Depth("/d")}), "/d");
  EXPECT_EQ(ColourOfTopics({either("/cam"), Depth("/d")}), "/cam");
  EXPECT_EQ(ColourOfTopics({either("/cam"), Colour("/c")}), "/c");
  EXPECT_EQ(ColourOfTopics({either("/cam"), Colour("/c")}, "/cam"), "/cam");
  ExpectInputError([&] { ColourOfTopics({either("/depth/image")}); },
                   {"no topic with colour images that can be read (mono8, ", "yuyv, mono16; JPEG"});
}

TEST(BagTopicsTest, TopicsOfTheRealSenseViewerAreFound) {
  const std::string device = "/device_0/sensor_";
  const std::vector<IndexedTopic> topics = {
      Colour(device + "0/Infrared_1/image/data"), Colour(device + "1/Color_0/image/data"),
      Camera(device + "0/Depth_0/info/camera_info"), Camera(device + "1/Color_0/info/camera_info")};
  EXPECT_EQ(ColourOfTopics(topics), device + "1/Color_0/image/data");
  EXPECT_EQ(ChooseInfoTopic({"a.bag", topics}, topics[1], "", "--info-topic").name,
            device + "1/Color_0/info/camera_info");
}

TEST(BagTopicsTest, WithoutATopicOrWithAChoiceTheTopicsAreListed) {
  ExpectInputError(
      [] {
        ColourOfTopics({Colour("/left"), Colour("/right")});
      },
      {"a.bag: has 2 topics with colour images", "--image-topic TOPIC",
       "/left (sensor_msgs/Image bgr8, 9 messages), /right"});
  ExpectInputError([] { DepthOfTopics({Colour("/cam")}); },
                   {"a.bag: has no topic with depth images", "its topics: /cam"});
  ExpectInputError([] { ColourOfTopics({Colour("/cam")}, "/none"); },
                   {"--image-topic is '/none', which it does not have", "/cam"});
  ExpectInputError([] { ColourOfTopics({Depth("/d")}, "/d"); },
                   {"--image-topic is '/d', which has no colour images"});
  ExpectInputError([] { ColourOfTopics({}); }, {"it has no topics"});
  std::vector<IndexedTopic> many(30, Camera("/c"));
  many.push_back(Depth("/shown/first"));
  ExpectInputError([&] { ColourOfTopics(many); }, {"and 21 more"});
}

TEST(BagTopicsTest, TheCameraIsBesideTheImagesOrTheOnlyOne) {
  const auto choose = [](std::vector<IndexedTopic> topics, const std::string& images,
                         const std::string& name = "") {
    return ChooseInfoTopic({"a.bag", std::move(topics)},
                           Colour(images, images.ends_with("/compressed")), name, "--info-topic")
        .name;
  };
  const std::vector<IndexedTopic> two = {Camera("/l/camera_info"), Camera("/r/camera_info")};
  EXPECT_EQ(choose(two, "/r/image"), "/r/camera_info");
  EXPECT_EQ(choose(two, "/r/image/compressed"), "/r/camera_info");
  EXPECT_EQ(choose(two, "/x/image", "/l/camera_info"), "/l/camera_info");
  EXPECT_EQ(choose({Camera("/c")}, "/x/image"), "/c");
  ExpectInputError([&] { choose(two, "/x/image"); },
                   {"2 topics with sensor_msgs/CameraInfo but no /x/camera_info", "--info-topic",
                    "--settings FILE"});
  ExpectInputError([&] { choose({Depth("/d")}, "/x/image", "/d"); },
                   {"--info-topic is '/d', which has no sensor_msgs/CameraInfo"});
}

}  // namespace
}  // namespace hullslam
