// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/visibility.h"

#include <algorithm>
#include <vector>

#include "geometry/polygon.h"
#include "map/keyframe_order.h"
#include "objects/resolved_observation.h"
#include "objects/validity.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kFewSamples = 3;  // with fewer samples on an object, it does not count as hidden

// Counts how many of the samples on a projected ellipse are nearer than a depth.
class HiddenCounter {
 public:
  HiddenCounter(const Ellipse& ellipse, double depth)
      : center_(ellipse.center), inverse_shape_(ellipse.shape.inverse()), depth_(depth) {}

  // A sample at an undistorted pixel, at depth z (m).
  void Add(const Eigen::Vector2d& pixel, double z) {
    const Eigen::Vector2d offset = pixel - center_;
    if (offset.dot(inverse_shape_ * offset) <= 1.0) {
      ++samples_;
      nearer_ += z < depth_ ? 1 : 0;
    }
  }

  bool IsHidden(double max_hidden) const {
    return samples_ >= kFewSamples &&
           static_cast<double>(nearer_) > max_hidden * static_cast<double>(samples_);
  }

 private:
  Eigen::Vector2d center_;
  Eigen::Matrix2d inverse_shape_;
  double depth_;
  size_t samples_ = 0;
  size_t nearer_ = 0;
};

// The box of raw pixels of a box of undistorted ones, whose sides a lens bends.
Eigen::AlignedBox2d RawBoxOf(const PinholeCamera& camera, const Eigen::AlignedBox2d& bounds) {
  Eigen::AlignedBox2d raw(camera.Distort(bounds.min()), camera.Distort(bounds.max()));
  constexpr int kSteps = 8;
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Vector2d at = bounds.min() + i / static_cast<double>(kSteps) * bounds.sizes();
    raw.extend(camera.Distort({at.x(), bounds.min().y()}));
    raw.extend(camera.Distort({at.x(), bounds.max().y()}));
    raw.extend(camera.Distort({bounds.min().x(), at.y()}));
    raw.extend(camera.Distort({bounds.max().x(), at.y()}));
  }
  return raw;
}

// Calls `use` with the undistorted pixel and the depth (z, m) of each known sample in a box of
// undistorted pixels.
template <typename Use>
void ForEachSample(const DepthGrid& grid, const PinholeCamera& camera,
                   const Eigen::AlignedBox2d& bounds, const Use& use) {
  // Distortion moves the corners of the box, so a sample at its rim may be missed; that does no
  // harm.
  const Eigen::AlignedBox2d raw = RawBoxOf(camera, bounds);
  const Eigen::Vector2d first = raw.min() / DepthGrid::kStep;
  const Eigen::Vector2d last = raw.max() / DepthGrid::kStep;
  const int last_column = std::min(grid.columns() - 1, static_cast<int>(last.x()));
  const int last_row = std::min(grid.rows() - 1, static_cast<int>(last.y()));
  for (int row = std::max(0, static_cast<int>(first.y())); row <= last_row; ++row) {
    for (int column = std::max(0, static_cast<int>(first.x())); column <= last_column; ++column) {
      if (const double z = grid.At(column, row); z > 0.0) {
        use(camera.Undistort(DepthGrid::RawPixel(column, row)), z);
      }
    }
  }
}

// The same for the depth of each sample that the image has in a box or, without a depth image, of
// each landmark that it shows.
template <typename Use>
void ForEachDepth(const Map& map, const PinholeCamera& camera, const ImageKnowledge& image,
                  const Eigen::AlignedBox2d& bounds, const Use& use) {
  if (!image.frame.depth.empty()) {
    ForEachSample(image.frame.depth, camera, bounds, use);
    return;
  }
  for (size_t i = 0; i < image.landmarks.size(); ++i) {
    if (image.landmarks[i].IsValid()) {
      const Eigen::Vector3d& position = map.landmarks().At(image.landmarks[i]).position;
      use(image.frame.features.keypoints[i].undistorted.template cast<double>(),
          (image.cam_from_world * position).z());
    }
  }
}

// The part of a ray inside an ellipsoid, as depths (z, m).
struct RayThrough {
  double middle = 0.0;
  double half = 0.0;
};

// Passes the rays near the centre of an ellipsoid on, with their measured depth (z, m).
class RayFilter {
 public:
  RayFilter(const PinholeCamera& camera, const Rigid3& cam_from_world, const Ellipsoid& ellipsoid)
      : camera_(camera),
        object_from_cam_(Inverse(cam_from_world * ellipsoid.world_from_object)),
        half_axes_(ellipsoid.half_axes) {}

  template <typename Use>
  void Pass(const Eigen::Vector2d& pixel, double z, const Use& use) const {
    constexpr double kMiddle = 0.5;  // squared distance of a ray from the centre, in radii
    // In coordinates in which the ellipsoid is the unit sphere, a sample of depth z is at
    // origin + z * direction.
    const Eigen::Vector3d origin = object_from_cam_.translation.cwiseQuotient(half_axes_);
    const Eigen::Vector3d direction =
        (object_from_cam_.rotation * camera_.Unproject(pixel, 1.0)).cwiseQuotient(half_axes_);
    const double middle = -origin.dot(direction) / direction.squaredNorm();
    const double from_center = (origin + middle * direction).squaredNorm();
    if (from_center <= kMiddle) {
      use(RayThrough{middle, std::sqrt((1.0 - from_center) / direction.squaredNorm())}, z);
    }
  }

 private:
  const PinholeCamera& camera_;
  Rigid3 object_from_cam_;
  Eigen::Vector3d half_axes_;
};

// The share of the outline of an ellipse that is in the image; exactly 1 if it is there as a whole.
double ShareInside(const Ellipse& ellipse, const Sensor& sensor) {
  const std::vector<Eigen::Vector2d> outline = ellipse.Polygon();
  const auto inside = std::count_if(outline.begin(), outline.end(),
                                    [&](const auto& pixel) { return sensor.Sees(pixel); });
  return static_cast<double>(inside) / static_cast<double>(outline.size());
}

// Depths (z, m) of the nearest and of the farthest point of an ellipsoid.
struct DepthRange {
  double nearest;
  double farthest;
};

DepthRange DepthsOf(const Ellipsoid& in_cam) {
  const Eigen::Vector3d axes = in_cam.half_axes.cwiseProduct(
      in_cam.world_from_object.rotation.conjugate() * Eigen::Vector3d::UnitZ());
  const double center = in_cam.world_from_object.translation.z();
  return {center - axes.norm(), center + axes.norm()};
}

// Whether the image shows a mapped object that covers the centre of the ellipse and is
// nearer than `depth` as a whole.
bool IsBehindObject(const Map& map, const ImageKnowledge& image, const Ellipse& ellipse,
                    double depth) {
  for (size_t i = 0; i < image.objects.size(); ++i) {
    const ObjectLandmark* other = map.objects().Find(image.objects[i]);
    if (other == nullptr || other->state != ObjectState::kMapped) {
      continue;
    }
    if (DepthsOf(image.cam_from_world * other->ellipsoid).farthest < depth &&
        IsInOrNearConvex(image.frame.detections[i].hull, ellipse.center, 0.0)) {
      return true;
    }
  }
  return false;
}

}  // namespace

LocationVisibility FindVisibility(const Map& map, const Sensor& sensor, const ImageKnowledge& image,
                                  const ObjectLandmark& object, const ObjectOptions& options,
                                  double min_inside) {
  const auto ellipse =
      ProjectEllipsoid(sensor.camera.Matrix(), image.cam_from_world, object.ellipsoid);
  if (!ellipse || !(ShareInside(*ellipse, sensor) >= min_inside)) {
    return LocationVisibility::kOutside;
  }
  const Ellipsoid in_cam = image.cam_from_world * object.ellipsoid;
  const double distance = in_cam.world_from_object.translation.norm();
  const double farthest = LargestDistance(ResolveObservations(map, object),
                                          object.ellipsoid.world_from_object.translation);
  if (distance > options.culling.max_range * farthest) {
    return LocationVisibility::kOutside;
  }
  // A smaller difference of depth may come from the object's own surface.
  const double depth =
      DepthsOf(in_cam).nearest - NearSurface(object.ellipsoid, distance, options.validity);
  HiddenCounter counter(*ellipse, depth);
  ForEachDepth(map, sensor.camera, image, ellipse->Bounds(),
               [&](const Eigen::Vector2d& pixel, double z) { counter.Add(pixel, z); });
  return counter.IsHidden(options.culling.max_hidden) || IsBehindObject(map, image, *ellipse, depth)
             ? LocationVisibility::kHidden
             : LocationVisibility::kVisible;
}

LocationVisibility FindVisibility(const Map& map, const Sensor& sensor, KeyframeId keyframe,
                                  const ObjectLandmark& object, const ObjectOptions& options,
                                  double min_inside) {
  const Keyframe& observer = map.keyframes().At(keyframe);
  return FindVisibility(map, sensor,
                        ImageKnowledge{*observer.frame, observer.cam_from_world, observer.landmarks,
                                       observer.objects},
                        object, options, min_inside);
}

std::optional<SeenSurface> MeasureSurface(const Map& map, const Sensor& sensor,
                                          const ImageKnowledge& image, const Ellipsoid& ellipsoid) {
  const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), image.cam_from_world, ellipsoid);
  if (!ellipse) {
    return std::nullopt;
  }
  std::vector<double> behind;
  std::vector<double> thickness;
  const RayFilter filter(sensor.camera, image.cam_from_world, ellipsoid);
  ForEachDepth(map, sensor.camera, image, ellipse->Bounds(),
               [&](const Eigen::Vector2d& pixel, double z) {
                 filter.Pass(pixel, z, [&](const RayThrough& ray, double depth) {
                   behind.push_back(depth - (ray.middle - ray.half));
                   thickness.push_back(2.0 * ray.half);
                 });
               });
  if (behind.size() < kFewSamples) {
    return std::nullopt;
  }
  return SeenSurface{.behind = Median(std::move(behind)),
                     .thickness = Median(std::move(thickness))};
}

bool SeesThrough(const Sensor& sensor, const Frame& frame, const Rigid3& cam_from_world,
                 const Ellipsoid& ellipsoid, double min_share) {
  const auto ellipse = ProjectEllipsoid(sensor.camera.Matrix(), cam_from_world, ellipsoid);
  if (!ellipse) {
    return false;
  }
  const RayFilter filter(sensor.camera, cam_from_world, ellipsoid);
  size_t samples = 0;
  size_t behind = 0;
  ForEachSample(frame.depth, sensor.camera, ellipse->Bounds(),
                [&](const Eigen::Vector2d& pixel, double z) {
                  filter.Pass(pixel, z, [&](const RayThrough& ray, double depth) {
                    ++samples;
                    behind += depth > ray.middle + ray.half ? 1 : 0;
                  });
                });
  return samples >= kFewSamples &&
         static_cast<double>(behind) >= min_share * static_cast<double>(samples);
}

bool IsContradicted(const Map& map, const Sensor& sensor, KeyframeId current, ObjectId id,
                    const ChangeOptions& options, Contradictions<ObjectId>& contradictions) {
  const Keyframe& keyframe = map.keyframes().At(current);
  const ObjectLandmark& object = map.objects().At(id);
  const FrameId last_seen = FrameIdOf(map, LastObserver(map, object.observations));
  return last_seen < keyframe.frame->id &&
         SeesThrough(sensor, *keyframe.frame, keyframe.cam_from_world, object.ellipsoid,
                     options.min_seen_through) &&
         contradictions.Add(id, last_seen) >= options.min_keyframes;
}

}  // namespace hullslam
