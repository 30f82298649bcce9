// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/bag_sequence.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/masks/mask_source.h"
#include "support/expect_error.h"
#include "support/made_bags.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr MessageCoding kCdr = MessageCoding::kCdr;
constexpr uint64_t kSecond = 1'000'000'000;  // ns
constexpr uint64_t kStart = 1'305'031'102 * kSecond;
constexpr uint32_t kBagWidth = 64;
constexpr uint32_t kBagHeight = 48;

class BagSequenceTest : public ::testing::Test {
 protected:
  // An image of this grey value, `stamp` ns after the start.
  static MadeMessage Image(int64_t stamp, int grey, MessageCoding coding = kCdr) {
    const uint64_t time = kStart + static_cast<uint64_t>(stamp);
    return {"/cam/image", "sensor_msgs/Image", time,
            MadeImage(coding, time, "mono8", kBagWidth, kBagHeight,
                      std::string(kBagWidth * kBagHeight, static_cast<char>(grey)))};
  }
  // A depth image whose values have two bytes `value`.
  static MadeMessage Depth(int64_t stamp, char value, MessageCoding coding = kCdr) {
    const uint64_t time = kStart + static_cast<uint64_t>(stamp);
    return {"/cam/depth", "sensor_msgs/Image", time,
            MadeImage(coding, time, "16UC1", kBagWidth, kBagHeight,
                      std::string(2 * kBagWidth * kBagHeight, value))};
  }
  static MadeMessage Camera(MessageCoding coding = kCdr) {
    return {"/cam/camera_info", "sensor_msgs/CameraInfo", kStart,
            MadeCameraInfo(coding, kBagWidth, kBagHeight)};
  }
  static std::vector<MadeMessage> Usual(MessageCoding coding = kCdr) {
    return {Camera(coding),
            Image(0, 10, coding),
            Depth(1'000'000, 1, coding),
            Image(33'000'000, 20, coding),
            Image(66'000'000, 30, coding),
            Depth(67'000'000, 3, coding)};
  }

  BagSequence Open(const std::vector<MadeMessage>& messages,
                   const BagSequenceOptions& options = {}) const {
    return OpenBagSequence(folder_.Write("a.mcap", MadeMcap(messages, "zstd")), options);
  }

  void ExpectRefusal(const std::vector<MadeMessage>& messages,
                     const std::vector<std::string>& parts,
                     const BagSequenceOptions& options = {}) const {
    ExpectInputError([&] { Open(messages, options); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(BagSequenceTest, AllFormatsGiveTheSameFrames) {
  const std::vector<std::filesystem::path> files = {
      folder_.Write("a.mcap", MadeMcap(Usual(), "lz4")),
      WriteMadeSqlite(folder_.path() / "a.db3", Usual(), "zstd"),
      folder_.Write("a.bag", MadeRos1(Usual(MessageCoding::kRos1), "bz2"))};
  for (const auto& file : files) {
    const BagSequence bag = OpenBagSequence(file);
    const ImageSequence& images = bag.images;
    EXPECT_TRUE(bag.warnings.empty());
    ASSERT_EQ(images.frames.size(), 2u) << file;
    EXPECT_EQ(images.unpaired, 1u);
    EXPECT_EQ(images.frames[1].timestamp, 1305031102.066);
    EXPECT_EQ(MaskFrames(images)[1].stem, "1305031102.066000");
    ASSERT_TRUE(bag.camera.has_value());
    const PinholeCamera& camera = bag.camera->camera;
    EXPECT_EQ(camera.fx, 300.0);
    EXPECT_EQ(camera.width, 64);
    EXPECT_NEAR(bag.camera->frames_per_second, 1.0 / 0.033, 1e-3);
    for (const size_t i : {1, 0}) {
      const ImageInput frame = images.load(images.frames[i], camera);
      EXPECT_EQ(frame.grey.at<uint8_t>(9, 9), i == 0 ? 10 : 30);
      EXPECT_EQ(frame.depth.at<uint16_t>(9, 9), i == 0 ? 0x101 : 0x303);
      EXPECT_EQ(images.load_colour(images.frames[i]).at<cv::Vec3b>(9, 9)[2], i == 0 ? 10 : 30);
    }
  }
}

TEST_F(BagSequenceTest, WithoutDepthAllImagesAreFrames) {
  const BagSequence bag = Open(Usual(), {.use_depth = false, .selection = {.first = 1}});
  EXPECT_EQ(bag.images.available, 3u);
  ASSERT_EQ(bag.images.frames.size(), 2u);
  EXPECT_TRUE(bag.images.frames[0].depth.empty());
  EXPECT_TRUE(bag.images.load(bag.images.frames[0], bag.camera->camera).depth.empty());
}

TEST_F(BagSequenceTest, AnotherCameraIsRefusedWhenAFrameIsLoaded) {
  const BagSequence bag = Open(Usual());
  PinholeCamera other = bag.camera->camera;
  other.width = 65;
  ExpectInputError([&] { bag.images.load(bag.images.frames[0], other); },
                   {"a.mcap/cam/depth/1305031102.001000: 64x48 px", "65x48"});
}

TEST_F(BagSequenceTest, StampsThatGoBackwardsAreRefusedUnlessRecordingTimesAreUsed) {
  std::vector<MadeMessage> messages = {Camera(), Image(0, 10), Image(33'000'000, 20)};
  MadeMessage late = Image(-2'000'000'000, 30);
  late.time = kStart + 66'000'000;
  messages.push_back(late);
  const BagSequenceOptions mono = {.use_depth = false};
  ExpectRefusal(messages,
                {"a.mcap: /cam/image: the time stamp 1305031100.000000 s comes 2.033000 s before",
                 "--recording-times"},
                mono);
  const BagSequence bag = Open(messages, {.use_depth = false, .use_recording_times = true});
  ASSERT_EQ(bag.images.frames.size(), 3u);
  EXPECT_EQ(bag.images.frames[2].timestamp, 1305031102.066);
}

TEST_F(BagSequenceTest, ImagesThatCameALittleLateAreSortedByTheirStamps) {
  MadeMessage late = Image(33'000'000, 20);
  late.time = kStart + 99'000'000;
  const BagSequence bag =
      Open({Camera(), Image(0, 10), Image(66'000'000, 30), late, Image(100'000'000, 40)},
           {.use_depth = false});
  ASSERT_EQ(bag.images.frames.size(), 4u);
  EXPECT_EQ(bag.images.frames[1].timestamp, 1305031102.033);
  EXPECT_EQ(bag.images.load(bag.images.frames[1], bag.camera->camera).grey.at<uint8_t>(9, 9), 20);
  ASSERT_EQ(bag.warnings.size(), 1u);
  EXPECT_NE(bag.warnings[0].find("1 images come after images with later"), std::string::npos);
}

TEST_F(BagSequenceTest, DepthInFloatsHasTheGivenUnits) {
  std::string millimetres;
  for (uint32_t i = 0; i < kBagWidth * kBagHeight; ++i) {
    millimetres.append("\0\0\xfa\x44", 4);  // 2000
  }
  const std::vector<MadeMessage> messages = {
      Camera(),
      Image(0, 10),
      {"/cam/depth", "sensor_msgs/Image", kStart,
       MadeImage(kCdr, kStart, "32FC1", kBagWidth, kBagHeight, millimetres)}};
  const BagSequence bag = Open(messages, {.float_units = 1000.0});
  const ImageInput frame = bag.images.load(bag.images.frames.at(0), bag.camera->camera);
  EXPECT_FLOAT_EQ(frame.depth.at<float>(9, 9), 2.0f);
  EXPECT_EQ(bag.images.choices.at("float_units"), "1000");
  EXPECT_NE(bag.notes[1].find("DepthMapFactor has no effect"), std::string::npos) << bag.notes[1];
  ExpectRefusal(messages, {"--float-units is '0'"}, {.float_units = 0.0});
}

TEST_F(BagSequenceTest, MessagesOfFoxgloveAreRead) {
  const std::string pixels(kBagWidth * kBagHeight, '\x21');
  const std::string image = ProtobufStamp(kStart) + ProtobufNumber(2, kBagWidth) +
                            ProtobufNumber(3, kBagHeight) + ProtobufField(4, "mono8") +
                            ProtobufNumber(5, kBagWidth) + ProtobufField(6, pixels);
  const BagSequence bag = OpenBagSequence(
      folder_.Write("a.mcap",
                    MadeMcap({{"/image", "foxglove.RawImage", kStart, image}}, "zstd", "protobuf")),
      {.use_depth = false, .need_camera = false});
  ASSERT_EQ(bag.images.frames.size(), 1u);
  EXPECT_EQ(bag.images.frames[0].timestamp, 1305031102.0);
  EXPECT_EQ(bag.images.load_colour(bag.images.frames[0]).at<cv::Vec3b>(9, 9)[1], 0x21);
}

TEST_F(BagSequenceTest, RepeatedStampsAndLongGapsAreWarnings) {
  const BagSequence bag =
      Open({Camera(), Image(0, 10), Image(0, 20), Image(7200 * kSecond, 30)}, {.use_depth = false});
  EXPECT_EQ(bag.images.frames.size(), 2u);
  ASSERT_EQ(bag.warnings.size(), 2u);
  EXPECT_NE(bag.warnings[0].find("jump by 2.0 hours at 1305038302.0"), std::string::npos)
      << bag.warnings[0];
  EXPECT_NE(bag.warnings[1].find("1 images have the time stamp"), std::string::npos);
}

TEST_F(BagSequenceTest, ImagesWithoutStampsHaveTheTimesOfTheirRecording) {
  std::vector<MadeMessage> messages = {Camera()};
  for (int i = 0; i < 3; ++i) {
    messages.push_back({"/cam/image", "sensor_msgs/Image", kStart + i * kSecond,
                        MadeImage(kCdr, 0, "mono8", kBagWidth, kBagHeight,
                                  std::string(kBagWidth * kBagHeight, '\x20'))});
  }
  const BagSequence bag = Open(messages, {.use_depth = false});
  EXPECT_EQ(bag.images.frames[2].timestamp, 1305031104.0);
  EXPECT_NE(bag.notes[0].find("no time stamps"), std::string::npos);
}

TEST_F(BagSequenceTest, WithoutPairsTheSmallestGapIsShown) {
  ExpectRefusal(
      {Camera(), Image(0, 10), Depth(3600 * kSecond, 1)},
      {"no image of /cam/image has one of /cam/depth within 0.02 s", "3600.000000", "mono_bag"});
}

TEST_F(BagSequenceTest, MissingTopicsAreReportedWithAList) {
  ExpectRefusal({Camera(), Image(0, 10)}, {"a.mcap: has no topic with depth images",
                                           "/cam/image (sensor_msgs/Image mono8, 1 "
                                           "message)"});
  ExpectRefusal({Image(0, 10), Depth(0, 1)},
                {"0 topics with sensor_msgs/CameraInfo", "--settings"});
  EXPECT_FALSE(Open({Image(0, 10), Depth(0, 1)}, {.need_camera = false}).camera.has_value());
}

TEST_F(BagSequenceTest, CamerasThatCannotBeUsedAreRefused) {
  const auto with_camera = [&](const std::string& camera) {
    return std::vector<MadeMessage>{{"/cam/camera_info", "sensor_msgs/CameraInfo", kStart, camera},
                                    Image(0, 10)};
  };
  const BagSequenceOptions mono = {.use_depth = false};
  ExpectRefusal(with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "omni", {1, 2, 3, 4})),
                {"/cam/camera_info", "'omni' with 4", "plumb_bob", "--settings"}, mono);
  ExpectRefusal(with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "equidistant", {1, 2})),
                {"'equidistant' with 2 coefficients, expected 4 coefficients"}, mono);
  ExpectRefusal(with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "plumb_bob", {}, 0.0)),
                {"not calibrated"}, mono);
  const BagSequence bag =
      Open(with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "rational_polynomial",
                                      {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8})),
           mono);
  EXPECT_EQ(bag.camera->camera.k4, 0.6);
  EXPECT_EQ(bag.camera->camera.k6, 0.8);
  EXPECT_EQ(bag.camera->camera.k2, 0.2);
  EXPECT_EQ(bag.camera->camera.p1, 0.3);
  EXPECT_EQ(bag.camera->camera.k3, 0.5);
  const BagSequence fisheye = Open(
      with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "equidistant", {0.1, 0.2, 0.3, 0.4})),
      mono);
  EXPECT_TRUE(fisheye.camera->camera.IsFisheye());
  EXPECT_EQ(fisheye.camera->camera.k4, 0.4);
  // Models that HullSLAM does not have are those of a pinhole if there is no distortion.
  const BagSequence pinhole =
      Open(with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "Inverse Brown Conrady")), mono);
  EXPECT_FALSE(pinhole.camera->camera.IsDistorted());
  ExpectRefusal(with_camera(MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "Inverse Brown Conrady",
                                           {0.1, 0, 0, 0, 0})),
                {"'Inverse Brown Conrady' with 5"}, mono);
}

// The CameraInfo that ROS's image_proc republishes is that of the raw images: K and D. Undistorting
// rectified images with them would bend them.
TEST_F(BagSequenceTest, RectifiedImagesHaveTheProjectionAndNoDistortion) {
  const auto open = [&](const std::string& topic, const std::vector<double>& distortion,
                        double projected) {
    MadeMessage image = Image(0, 10);
    image.topic = topic;
    return Open({{"/cam/camera_info", "sensor_msgs/CameraInfo", kStart,
                  MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "plumb_bob", distortion, 300.0, 0.0,
                                 projected)},
                 image},
                {.use_depth = false});
  };
  const std::vector<double> bent = {0.1, 0.2, 0.0, 0.0, 0.0};
  const BagSequence rectified = open("/cam/image_rect_color", bent, 280.0);
  EXPECT_EQ(rectified.camera->camera.fx, 280.0);
  EXPECT_EQ(rectified.camera->camera.fy, 280.0);
  EXPECT_EQ(rectified.camera->camera.cx, 0.5 * (kBagWidth - 1));
  EXPECT_EQ(rectified.camera->camera.cy, 0.5 * (kBagHeight - 1));
  EXPECT_FALSE(rectified.camera->camera.IsDistorted());
  EXPECT_EQ(rectified.notes.back(),
            "camera: /cam/camera_info, rectified images by the name of their topic: P");
  const BagSequence raw = open("/cam/direct_image", bent, 280.0);
  EXPECT_EQ(raw.camera->camera.fx, 300.0);
  EXPECT_EQ(raw.camera->camera.k1, 0.1);
  EXPECT_EQ(raw.notes.back(), "camera: /cam/camera_info, raw images: K and D");
  const BagSequence without_projection = open("/cam/image_rect", {}, 0.0);
  EXPECT_EQ(without_projection.camera->camera.fx, 300.0);
  EXPECT_NE(without_projection.notes.back().find("K, as P is 0"), std::string::npos);
  ExpectInputError(
      [&] { open("/cam/image_rect", bent, 0.0); },
      {"a.mcap: /cam/camera_info: the images are rectified by the name of their topic, "
       "but its matrix P is 0; expected --settings FILE"});
}

TEST_F(BagSequenceTest, ACutRecordingIsUsedUpToTheCut) {
  const std::string whole = MadeMcap(Usual(), "none");
  const auto file = folder_.Write("a.mcap", whole.substr(0, whole.size() - 3000));
  const BagSequence bag = OpenBagSequence(file);
  EXPECT_EQ(bag.images.frames.size(), 1u);
  ASSERT_EQ(bag.warnings.size(), 1u);
  EXPECT_NE(bag.warnings[0].find("cut off"), std::string::npos);
}

class BagPairsTest : public BagSequenceTest {
 protected:
  static MadeMessage Half(const std::string& side, int64_t stamp, int grey) {
    MadeMessage message = Image(stamp, grey);
    message.topic = "/" + side + "/image";
    return message;
  }
  static MadeMessage HalfCamera(const std::string& side, double baseline) {
    return {
        "/" + side + "/camera_info", "sensor_msgs/CameraInfo", kStart,
        MadeCameraInfo(kCdr, kBagWidth, kBagHeight, "plumb_bob", {0, 0, 0, 0, 0}, 300.0, baseline)};
  }
  // Pairs 50 ms apart. The right image of the third one is missing.
  static std::vector<MadeMessage> UsualPairs(double baseline = 0.1) {
    std::vector<MadeMessage> messages = {HalfCamera("left", 0.0), HalfCamera("right", baseline)};
    for (int i = 0; i < 4; ++i) {
      messages.push_back(Half("left", 50'000'000 * i, 10 + i));
      if (i != 2) {
        messages.push_back(Half("right", 50'000'000 * i + 1'000'000, 20 + i));
      }
    }
    return messages;
  }
  BagPairs OpenPairs(const std::vector<MadeMessage>& messages,
                     const BagSequenceOptions& options = {}) const {
    return OpenBagPairs(folder_.Write("a.mcap", MadeMcap(messages, "zstd")), options);
  }
};

TEST_F(BagPairsTest, TwoTopicsArePairedByTheirStamps) {
  const BagPairs bag = OpenPairs(UsualPairs());
  ASSERT_EQ(bag.images.frames.size(), 3u);
  ASSERT_TRUE(bag.calibration.has_value());
  EXPECT_NEAR(bag.calibration->camera.bf, 30.0, 1e-9);
  EXPECT_NEAR(bag.calibration->frames_per_second, 20.0, 1e-3);
  const ImageInput pair = bag.images.load(bag.images.frames[2], bag.calibration->camera);
  EXPECT_EQ(pair.grey.at<uint8_t>(9, 9), 13);
  EXPECT_EQ(pair.right.at<uint8_t>(9, 9), 23);
  EXPECT_TRUE(pair.depth.empty());
  ASSERT_EQ(bag.warnings.size(), 1u);
  EXPECT_NE(bag.warnings[0].find("1 of 4 images of /left/image"), std::string::npos);
  EXPECT_EQ(bag.images.unpaired, 1u);
  EXPECT_EQ(bag.images.choices.at("right_topic"), "/right/image");
}

// "direct" has the letters of "rect". The distortion of raw images must be undone.
TEST_F(BagPairsTest, TheLastPartOfATopicSaysWhetherAPairIsRectified) {
  const auto rectifier_note = [&](const std::string& folder, const std::string& name) {
    std::vector<MadeMessage> messages = UsualPairs();
    for (MadeMessage& message : messages) {
      message.topic = folder + message.topic;
      if (message.topic.ends_with("/image")) {
        message.topic = message.topic.substr(0, message.topic.rfind('/') + 1) + name;
      }
    }
    return OpenPairs(messages).notes.back();
  };
  EXPECT_EQ(rectifier_note("/direct_drive", "image"),
            "cameras: /direct_drive/left/camera_info (raw images: K and D) and "
            "/direct_drive/right/camera_info (raw images: K and D)");
  EXPECT_EQ(rectifier_note("", "image_rect"),
            "cameras: /left/camera_info (rectified images by the name of their topic: P) and "
            "/right/camera_info (rectified images by the name of their topic: P)");
}

TEST_F(BagPairsTest, OtherSettingsNeedNoCamera) {
  std::vector<MadeMessage> messages = UsualPairs();
  messages.erase(messages.begin(), messages.begin() + 2);
  EXPECT_EQ(OpenPairs(messages, {.need_camera = false}).images.frames.size(), 3u);
  ExpectInputError([&] { OpenPairs(messages); }, {"a.mcap", "CameraInfo", "--settings"});
}

TEST_F(BagPairsTest, CamerasThatAreNoPairAreRefused) {
  ExpectInputError([&] { OpenPairs(UsualPairs(0.0)); }, {"a.mcap: the baseline is 0 m"});
  ExpectInputError([&] { OpenPairs(UsualPairs(-0.1)); }, {"left and right are swapped"});
  std::vector<MadeMessage> late = UsualPairs();
  for (MadeMessage& message : late) {
    if (message.topic == "/right/image") {
      message = Half("right", static_cast<int64_t>(message.time - kStart) + 20'000'000, 1);
    }
  }
  ExpectInputError([&] { OpenPairs(late); }, {"a.mcap: 0 of 4 images of /left/image"});
}

}  // namespace
}  // namespace hullslam
