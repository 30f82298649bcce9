// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/colmap_model.h"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "files/bytes.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

class Colmap : public ::testing::Test {
 protected:
  Colmap() : made_(MakeSyntheticMap(world_, {0, 10, 20})), view_(world_.sensor().camera) {
    const LocatedLandmarks located = LocateLandmarks(made_.map, world_.sensor());
    std::vector<KeyframeImage> images;
    for (uint32_t i = 0; i < 3; ++i) {
      images.push_back({KeyframeId(i), {}, "image_" + std::to_string(i)});
    }
    const std::vector<Colour> colours(located.ids.size(), Colour{1, 2, 3});
    located_ = located.ids.size();
    model_ = MakeColmapModel(made_.map, located, colours, images, view_);
  }

  SyntheticWorld world_;
  SyntheticMap made_;
  ExportCamera view_;
  size_t located_ = 0;
  ColmapModel model_;
};

TEST_F(Colmap, KeypointsAreWhereTheirPointsAreProjected) {
  ASSERT_EQ(model_.images.size(), 3U);
  ASSERT_GT(model_.points.size(), 100U);
  EXPECT_LE(model_.points.size(), located_);
  std::map<uint32_t, const ColmapImage*> images;
  for (const ColmapImage& image : model_.images) {
    images[image.id] = &image;
  }
  for (const ColmapPoint& point : model_.points) {
    EXPECT_GE(point.track.size(), 2U);
    EXPECT_LT(point.error, 1e-3);
    for (const ColmapSighting& sighting : point.track) {
      const ColmapImage& image = *images.at(sighting.image);
      const ColmapKeypoint& keypoint = image.keypoints.at(sighting.keypoint);
      EXPECT_EQ(keypoint.point, point.id);
      const Eigen::Vector2d pixel = model_.camera.Project(image.cam_from_world * point.position);
      EXPECT_NEAR((pixel - keypoint.pixel).norm(), 0.0, 1e-3);
    }
  }
}

TEST_F(Colmap, EveryKeypointWithAPointIsInItsTrack) {
  size_t sightings = 0;
  for (const ColmapPoint& point : model_.points) {
    sightings += point.track.size();
  }
  for (const ColmapImage& image : model_.images) {
    for (const ColmapKeypoint& keypoint : image.keypoints) {
      sightings -= keypoint.point != ColmapKeypoint::kNone ? 1 : 0;
      EXPECT_GE(keypoint.pixel.minCoeff(), 0.0);
      EXPECT_LE(keypoint.pixel.x(), model_.camera.width);
      EXPECT_LE(keypoint.pixel.y(), model_.camera.height);
    }
  }
  EXPECT_EQ(sightings, 0U);
}

// The world's keypoints have columns in the right image of a virtual pair.
TEST_F(Colmap, PairsHaveASecondCamera) {
  const LocatedLandmarks located = LocateLandmarks(made_.map, world_.sensor());
  const std::vector<Colour> colours(located.ids.size());
  std::vector<KeyframeImage> images;
  for (uint32_t i = 0; i < 3; ++i) {
    images.push_back({KeyframeId(i), {}, "image_" + std::to_string(i)});
  }
  const ColmapModel pairs =
      MakeColmapModel(made_.map, located, colours, images, view_, world_.sensor().baseline());
  ASSERT_EQ(pairs.images.size(), 6U);
  EXPECT_EQ(pairs.images[3].name, "image_0_right.png");
  EXPECT_EQ(pairs.images[3].id, 4U);
  EXPECT_EQ(pairs.images[3].camera, 2U);
  EXPECT_GT(pairs.images[3].keypoints.size(), 50U);
  size_t in_right = 0;
  for (const ColmapPoint& point : pairs.points) {
    EXPECT_LT(point.error, 1e-2);
    for (const ColmapSighting& sighting : point.track) {
      in_right += sighting.image > 3 ? 1 : 0;
    }
  }
  EXPECT_GT(in_right, 100U);
  const std::string cameras = FormatColmapText(pairs)[0].content;
  EXPECT_NE(cameras.find("\n2 PINHOLE"), std::string::npos);
  EXPECT_EQ(FormatColmapBinary(pairs)[0].content.size(),
            2 * FormatColmapBinary(model_)[0].content.size() - 8);
}

// The observations of an image whose pose is turned by an angle have errors of 500 px times it.
TEST_F(Colmap, ObservationsWithLargeErrorsAreLeftOut) {
  const LocatedLandmarks located = LocateLandmarks(made_.map, world_.sensor());
  const std::vector<Colour> colours(located.ids.size());
  const std::vector<KeyframeImage> images = {
      {KeyframeId(0), {}, "0"}, {KeyframeId(1), {}, "1"}, {KeyframeId(2), {}, "2"}};
  const Rigid3 pose = made_.map.CamFromWorld(KeyframeId(2));
  const auto seen_by_last = [&](double error_px) {
    made_.map.SetPose(KeyframeId(2),
                      Rigid3(ExpSo3({error_px / 500.0, 0.0, 0.0}), Eigen::Vector3d::Zero()) * pose);
    const ColmapModel model = MakeColmapModel(made_.map, located, colours, images, view_);
    EXPECT_GT(model.points.size(), 100U);
    size_t seen = 0;
    for (const ColmapKeypoint& keypoint : model.images[2].keypoints) {
      seen += keypoint.point != ColmapKeypoint::kNone ? 1 : 0;
    }
    return seen;
  };
  const size_t before = seen_by_last(0.0);
  EXPECT_EQ(seen_by_last(2.5), before);  // the errors at the border are larger than in the middle
  EXPECT_EQ(seen_by_last(4.5), 0U);
}

TEST_F(Colmap, TheCentreOfTheFirstPixelIsAHalf) {
  EXPECT_EQ(model_.camera.cx, world_.sensor().camera.cx + 0.5);
  EXPECT_EQ(model_.camera.cy, world_.sensor().camera.cy + 0.5);
}

std::string ContentOf(const std::vector<FileContent>& files, const std::string& name) {
  for (const FileContent& file : files) {
    if (file.name == name) {
      return file.content;
    }
  }
  ADD_FAILURE() << "no " << name;
  return {};
}

// The lines without comments.
std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with('#')) {
      lines.push_back(line);
    }
  }
  return lines;
}

TEST_F(Colmap, TextHasOneCameraTwoLinesPerImageAndOnePerPoint) {
  const std::vector<FileContent> files = FormatColmapText(model_);
  const std::vector<std::string> cameras = LinesOf(ContentOf(files, "cameras.txt"));
  EXPECT_EQ(cameras, std::vector<std::string>{"1 PINHOLE 640 480 500 500 320.5 240.5"});
  const std::vector<std::string> images = LinesOf(ContentOf(files, "images.txt"));
  ASSERT_EQ(images.size(), 6U);
  std::istringstream head(images[2]);
  uint32_t id = 0;
  Eigen::Quaterniond q;
  Eigen::Vector3d t;
  uint32_t camera = 0;
  std::string name;
  head >> id >> q.w() >> q.x() >> q.y() >> q.z() >> t.x() >> t.y() >> t.z() >> camera >> name;
  EXPECT_EQ(id, 2U);
  EXPECT_EQ(name, "image_1.png");
  const Rigid3 expected = SyntheticWorld::CamFromWorld(10);
  EXPECT_NEAR((t - expected.translation).norm(), 0.0, 1e-9);
  EXPECT_NEAR(AngularDistance(q, expected.rotation), 0.0, 1e-7);
  std::istringstream keypoints(images[3]);
  size_t count = 0;
  for (double x = 0.0, y = 0.0, point = 0.0; keypoints >> x >> y >> point; ++count) {
    EXPECT_NE(point, 0.0);
  }
  EXPECT_EQ(count, model_.images[1].keypoints.size());
  EXPECT_EQ(LinesOf(ContentOf(files, "points3D.txt")).size(), model_.points.size());
}

TEST_F(Colmap, BinaryHasTheSameValues) {
  const std::vector<FileContent> files = FormatColmapBinary(model_);
  const std::string cameras = ContentOf(files, "cameras.bin");
  ByteReader camera(cameras, "cameras.bin");
  EXPECT_EQ(camera.Get<uint64_t>(), 1U);
  EXPECT_EQ(camera.Get<uint32_t>(), 1U);
  EXPECT_EQ(camera.Get<int32_t>(), 1);
  EXPECT_EQ(camera.Get<uint64_t>(), 640U);
  EXPECT_EQ(camera.Get<uint64_t>(), 480U);
  EXPECT_EQ(camera.GetMatrix<Eigen::Vector4d>(1e6), Eigen::Vector4d(500.0, 500.0, 320.5, 240.5));
  camera.ExpectEnd();

  const std::string images = ContentOf(files, "images.bin");
  ByteReader image(images, "images.bin");
  ASSERT_EQ(image.Get<uint64_t>(), 3U);
  for (const ColmapImage& expected : model_.images) {
    EXPECT_EQ(image.Get<uint32_t>(), expected.id);
    const auto q = image.GetMatrix<Eigen::Vector4d>(1.0);
    EXPECT_EQ(q[0], expected.cam_from_world.rotation.w());
    EXPECT_EQ(q[3], expected.cam_from_world.rotation.z());
    EXPECT_EQ(image.GetMatrix<Eigen::Vector3d>(1e6), expected.cam_from_world.translation);
    EXPECT_EQ(image.Get<uint32_t>(), 1U);
    std::string name;
    for (char letter = image.Get<char>(); letter != '\0'; letter = image.Get<char>()) {
      name += letter;
    }
    EXPECT_EQ(name, expected.name);
    ASSERT_EQ(image.Get<uint64_t>(), expected.keypoints.size());
    for (const ColmapKeypoint& keypoint : expected.keypoints) {
      EXPECT_EQ(image.GetMatrix<Eigen::Vector2d>(1e6), keypoint.pixel);
      EXPECT_EQ(image.Get<uint64_t>(), keypoint.point);
    }
  }
  image.ExpectEnd();

  const std::string points = ContentOf(files, "points3D.bin");
  ByteReader point(points, "points3D.bin");
  ASSERT_EQ(point.Get<uint64_t>(), model_.points.size());
  for (const ColmapPoint& expected : model_.points) {
    EXPECT_EQ(point.Get<uint64_t>(), expected.id);
    EXPECT_EQ(point.GetMatrix<Eigen::Vector3d>(1e6), expected.position);
    for (const uint8_t channel : expected.colour) {
      EXPECT_EQ(point.Get<uint8_t>(), channel);
    }
    EXPECT_EQ(point.Get<double>(), expected.error);
    ASSERT_EQ(point.Get<uint64_t>(), expected.track.size());
    for (const ColmapSighting& sighting : expected.track) {
      EXPECT_EQ(point.Get<uint32_t>(), sighting.image);
      EXPECT_EQ(point.Get<uint32_t>(), sighting.keypoint);
    }
  }
  point.ExpectEnd();
}

// The third image is turned by 2.5 px, so that only its observations have an error.
TEST_F(Colmap, PointsHaveTheirOwnColourAndTheMeanErrorOfTheirTrack) {
  const LocatedLandmarks located = LocateLandmarks(made_.map, world_.sensor());
  std::vector<Colour> colours;
  for (size_t i = 0; i < located.ids.size(); ++i) {
    colours.push_back({static_cast<uint8_t>(i % 256), static_cast<uint8_t>(i / 256), 0});
  }
  const std::vector<KeyframeImage> images = {
      {KeyframeId(0), {}, "0"}, {KeyframeId(1), {}, "1"}, {KeyframeId(2), {}, "2"}};
  made_.map.SetPose(KeyframeId(2), Rigid3(ExpSo3({0.005, 0.0, 0.0}), Eigen::Vector3d::Zero()) *
                                       made_.map.CamFromWorld(KeyframeId(2)));
  const ColmapModel model = MakeColmapModel(made_.map, located, colours, images, view_);
  ASSERT_GT(model.points.size(), 100U);
  double largest = 0.0;
  for (const ColmapPoint& point : model.points) {
    const size_t index = point.colour[0] + 256U * point.colour[1];
    EXPECT_EQ(located.positions.at(index), point.position);
    double sum = 0.0;
    for (const ColmapSighting& sighting : point.track) {
      const ColmapImage& image = model.images.at(sighting.image - 1);
      const Eigen::Vector2d pixel = model.camera.Project(image.cam_from_world * point.position);
      sum += (pixel - image.keypoints.at(sighting.keypoint).pixel).norm();
    }
    EXPECT_NEAR(point.error, sum / static_cast<double>(point.track.size()), 1e-9);
    largest = std::max(largest, point.error);
  }
  EXPECT_GT(largest, 0.5);
}

}  // namespace
}  // namespace hullslam
