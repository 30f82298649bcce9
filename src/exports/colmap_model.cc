// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/colmap_model.h"

#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>

#include "files/bytes.h"

namespace hullslam {
namespace {

constexpr uint32_t kRight = 2;      // id of the right camera of a pair
constexpr double kHalfPixel = 0.5;  // COLMAP's pixels minus ours

// The index of the keypoint of each landmark in an image.
using LandmarkKeypoints = std::unordered_map<LandmarkId, uint32_t>;

ColmapImage MakeImage(const KeyframeImage& image, const Keyframe& keyframe,
                      const ExportCamera& view, LandmarkKeypoints& landmarks) {
  ColmapImage made{.id = image.keyframe.value + 1,
                   .name = image.name + ".png",
                   .cam_from_world = keyframe.cam_from_world};
  for (size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const Eigen::Vector2d pixel =
        view.FromUndistorted(keyframe.frame->features.keypoints[i].undistorted.cast<double>());
    if (!view.Contains(pixel)) {
      continue;
    }
    if (keyframe.landmarks[i].IsValid()) {
      landmarks[keyframe.landmarks[i]] = static_cast<uint32_t>(made.keypoints.size());
    }
    made.keypoints.push_back({pixel + Eigen::Vector2d::Constant(kHalfPixel)});
  }
  return made;
}

// The right image of a pair. `first` is its id if the keyframe's id is 0.
ColmapImage MakeRightImage(const KeyframeImage& image, uint32_t first, double baseline,
                           const Keyframe& keyframe, const ExportCamera& view,
                           LandmarkKeypoints& landmarks) {
  const Rigid3 right_from_left{Eigen::Quaterniond::Identity(), {-baseline, 0.0, 0.0}};
  ColmapImage made{.id = first + image.keyframe.value,
                   .name = image.name + "_right.png",
                   .camera = kRight,
                   .cam_from_world = right_from_left * keyframe.cam_from_world};
  const FrameFeatures& features = keyframe.frame->features;
  for (size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (!(features.depth[i] > 0.0F) || !keyframe.landmarks[i].IsValid()) {
      continue;
    }
    const double disparity = baseline * view.camera().fx / static_cast<double>(features.depth[i]);
    const Eigen::Vector2d pixel =
        view.FromUndistorted(features.keypoints[i].undistorted.cast<double>()) -
        Eigen::Vector2d(disparity, 0.0);
    if (view.Contains(pixel)) {
      landmarks[keyframe.landmarks[i]] = static_cast<uint32_t>(made.keypoints.size());
      made.keypoints.push_back({pixel + Eigen::Vector2d::Constant(kHalfPixel)});
    }
  }
  return made;
}

// Where a landmark is seen: the index of the image in the model, and the keypoint.
struct Place {
  size_t image = 0;
  uint32_t keypoint = 0;
};

double ErrorAt(const Eigen::Vector3d& position, const Place& place, const ColmapModel& model) {
  const ColmapImage& image = model.images[place.image];
  const Eigen::Vector3d point = image.cam_from_world * position;
  return point.z() > 0.0
             ? (model.camera.Project(point) - image.keypoints[place.keypoint].pixel).norm()
             : std::numeric_limits<double>::infinity();
}

// COLMAP's mapper removes observations with a larger error, px (Mapper.filter_max_reproj_error).
// The map has some, because keypoints of high pyramid levels are allowed larger errors there.
constexpr double kMostError = 4.0;

void AddPoint(const Eigen::Vector3d& position, const Colour& colour, std::vector<Place> places,
              ColmapModel& model) {
  std::erase_if(places,
                [&](const Place& place) { return ErrorAt(position, place, model) > kMostError; });
  if (places.size() < 2) {
    return;
  }
  ColmapPoint point{model.points.size() + 1, position, colour, 0.0, {}};
  for (const Place& place : places) {
    point.error += ErrorAt(position, place, model) / static_cast<double>(places.size());
    ColmapImage& image = model.images[place.image];
    image.keypoints[place.keypoint].point = point.id;
    point.track.push_back({image.id, place.keypoint});
  }
  model.points.push_back(std::move(point));
}

}  // namespace

ColmapModel MakeColmapModel(const Map& map, const LocatedLandmarks& located,
                            std::span<const Colour> colours, std::span<const KeyframeImage> images,
                            const ExportCamera& view, double baseline) {
  const bool are_pairs = baseline > 0.0;
  ColmapModel model{view.camera(), are_pairs ? kRight : 1, {}, {}};
  model.camera.cx += kHalfPixel;
  model.camera.cy += kHalfPixel;
  std::unordered_map<LandmarkId, std::vector<Place>> places;
  const auto add = [&](ColmapImage image, const LandmarkKeypoints& landmarks) {
    model.images.push_back(std::move(image));
    for (const auto& [landmark, keypoint] : landmarks) {
      places[landmark].push_back({model.images.size() - 1, keypoint});
    }
  };
  for (const KeyframeImage& image : images) {
    LandmarkKeypoints landmarks;
    ColmapImage made = MakeImage(image, map.keyframes().At(image.keyframe), view, landmarks);
    add(std::move(made), landmarks);
  }
  const uint32_t first_right = images.empty() ? 1 : images.back().keyframe.value + 2;
  for (const KeyframeImage& image : are_pairs ? images : std::span<const KeyframeImage>()) {
    LandmarkKeypoints landmarks;
    ColmapImage made = MakeRightImage(image, first_right, baseline,
                                      map.keyframes().At(image.keyframe), view, landmarks);
    add(std::move(made), landmarks);
  }
  for (size_t i = 0; i < located.ids.size(); ++i) {
    const auto seen = places.find(located.ids[i]);
    if (seen != places.end()) {
      AddPoint(located.positions[i], colours[i], seen->second, model);
    }
  }
  return model;
}

std::vector<FileContent> FormatColmapText(const ColmapModel& model) {
  const PinholeCamera& camera = model.camera;
  std::string cameras = "# CAMERA_ID MODEL WIDTH HEIGHT fx fy cx cy\n";
  for (uint32_t id = 1; id <= model.cameras; ++id) {
    cameras += fmt::format("{} PINHOLE {} {} {} {} {} {}\n", id, camera.width, camera.height,
                           camera.fx, camera.fy, camera.cx, camera.cy);
  }
  std::string images =
      "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then X Y POINT3D_ID of each keypoint\n";
  for (const ColmapImage& image : model.images) {
    const Eigen::Quaterniond& q = image.cam_from_world.rotation;
    const Eigen::Vector3d& t = image.cam_from_world.translation;
    fmt::format_to(std::back_inserter(images), "{} {} {} {} {} {} {} {} {} {}\n", image.id, q.w(),
                   q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), image.camera, image.name);
    for (const ColmapKeypoint& keypoint : image.keypoints) {
      const bool shows_point = keypoint.point != ColmapKeypoint::kNone;
      fmt::format_to(std::back_inserter(images), "{:.3f} {:.3f} {} ", keypoint.pixel.x(),
                     keypoint.pixel.y(), shows_point ? static_cast<int64_t>(keypoint.point) : -1);
    }
    images += '\n';
  }
  std::string points = "# POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX of its track\n";
  for (const ColmapPoint& point : model.points) {
    const Eigen::Vector3d& p = point.position;
    fmt::format_to(std::back_inserter(points), "{} {} {} {} {} {} {} {}", point.id, p.x(), p.y(),
                   p.z(), point.colour[0], point.colour[1], point.colour[2], point.error);
    for (const ColmapSighting& sighting : point.track) {
      fmt::format_to(std::back_inserter(points), " {} {}", sighting.image, sighting.keypoint);
    }
    points += '\n';
  }
  return {{"cameras.txt", cameras}, {"images.txt", images}, {"points3D.txt", points}};
}

namespace {

std::string CamerasInBinary(const ColmapModel& model) {
  constexpr int32_t kPinhole = 1;
  const PinholeCamera& camera = model.camera;
  ByteWriter writer;
  writer.Put(uint64_t{model.cameras});
  for (uint32_t id = 1; id <= model.cameras; ++id) {
    writer.Put(id);
    writer.Put(kPinhole);
    writer.Put(static_cast<uint64_t>(camera.width));
    writer.Put(static_cast<uint64_t>(camera.height));
    for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) {
      writer.Put(value);
    }
  }
  return writer.bytes();
}

std::string ImagesInBinary(std::span<const ColmapImage> images) {
  ByteWriter writer;
  writer.Put(uint64_t{images.size()});
  for (const ColmapImage& image : images) {
    const Eigen::Quaterniond& q = image.cam_from_world.rotation;
    writer.Put(image.id);
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) {
      writer.Put(value);
    }
    writer.PutMatrix(image.cam_from_world.translation);
    writer.Put(image.camera);
    for (const char letter : image.name) {
      writer.Put(letter);
    }
    writer.Put('\0');
    writer.Put(uint64_t{image.keypoints.size()});
    for (const ColmapKeypoint& keypoint : image.keypoints) {
      writer.PutMatrix(keypoint.pixel);
      writer.Put(keypoint.point);
    }
  }
  return writer.bytes();
}

std::string PointsInBinary(std::span<const ColmapPoint> points) {
  ByteWriter writer;
  writer.Put(uint64_t{points.size()});
  for (const ColmapPoint& point : points) {
    writer.Put(point.id);
    writer.PutMatrix(point.position);
    for (const uint8_t channel : point.colour) {
      writer.Put(channel);
    }
    writer.Put(point.error);
    writer.Put(uint64_t{point.track.size()});
    for (const ColmapSighting& sighting : point.track) {
      writer.Put(sighting.image);
      writer.Put(sighting.keypoint);
    }
  }
  return writer.bytes();
}

}  // namespace

std::vector<FileContent> FormatColmapBinary(const ColmapModel& model) {
  return {{"cameras.bin", CamerasInBinary(model)},
          {"images.bin", ImagesInBinary(model.images)},
          {"points3D.bin", PointsInBinary(model.points)}};
}

}  // namespace hullslam
