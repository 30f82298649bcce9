// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/run_pictures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>

#include "geometry/polygon.h"
#include "hullslam/util/error.h"
#include "images/image_codecs.h"
#include "sequences/image_list.h"
#include "util/lists.h"

namespace hullslam {
namespace {

constexpr int kPictureWidth = 480;  // px
constexpr int kCutoutSize = 220;    // px, of the longer side
constexpr size_t kCutouts = 3;      // of each object
constexpr int kQuality = 78;        // of JPEG

// Undistorted px as raw px.
std::vector<Eigen::Vector2d> Distorted(const std::vector<Eigen::Vector2d>& points,
                                       const PinholeCamera& camera) {
  std::vector<Eigen::Vector2d> raw;
  raw.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    raw.push_back(camera.Distort(point));
  }
  return raw;
}

// The shapes of one object in one image, raw px.
struct SeenShapes {
  ViewShape outline;
  std::optional<ViewShape> ellipse;
};

SeenShapes ShapesOf(const ObjectResult& object, const ObservationResult& view,
                    const PinholeCamera& camera) {
  SeenShapes shapes;
  shapes.outline = {object.id, object.label,
                    Distorted(view.contour.empty() ? view.hull : view.contour, camera)};
  const auto ellipse = ProjectEllipsoid(camera.Matrix(), view.cam_from_world, object.ellipsoid);
  if (ellipse && object.state == ObjectState::kMapped) {
    shapes.ellipse = ViewShape{object.id, object.label, Distorted(ellipse->Polygon(), camera)};
  }
  return shapes;
}

// The part `part` of an image, scaled by `scale`, with the shapes in it.
ViewPicture MakePicture(const cv::Mat& image, double timestamp, const cv::Rect& part, double scale,
                        const std::vector<SeenShapes>& shapes) {
  cv::Mat scaled;
  cv::resize(image(part), scaled, {}, scale, scale, cv::INTER_AREA);
  ViewPicture picture{.timestamp = timestamp,
                      .jpeg = EncodeJpeg(scaled, kQuality),
                      .width = scaled.cols,
                      .height = scaled.rows,
                      .outlines = {},
                      .ellipses = {}};
  const auto move = [&](ViewShape shape) {
    for (Eigen::Vector2d& point : shape.points) {
      point = scale * (point - Eigen::Vector2d(part.x, part.y));
    }
    return shape;
  };
  for (const SeenShapes& seen : shapes) {
    picture.outlines.push_back(move(seen.outline));
    if (seen.ellipse) {
      picture.ellipses.push_back(move(*seen.ellipse));
    }
  }
  return picture;
}

// The box around a mask with a margin, inside of the image.
cv::Rect CutoutBox(const std::vector<Eigen::Vector2d>& outline, const cv::Size& size) {
  constexpr double kMargin = 0.18;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& point : outline) {
    box.extend(point);
  }
  const double margin = kMargin * box.sizes().maxCoeff() + 4.0;
  const cv::Rect around(cv::Point(static_cast<int>(std::floor(box.min().x() - margin)),
                                  static_cast<int>(std::floor(box.min().y() - margin))),
                        cv::Point(static_cast<int>(std::ceil(box.max().x() + margin)),
                                  static_cast<int>(std::ceil(box.max().y() + margin))));
  return around & cv::Rect(cv::Point(), size);
}

Eigen::Vector3d DirectionOf(const ObjectResult& object, const ObservationResult& view) {
  return (Inverse(view.cam_from_world).translation - object.ellipsoid.world_from_object.translation)
      .normalized();
}

// A view is good if the mask is large, surely of its class, and not cut by the border.
double Goodness(const ObservationResult& view) {
  return SignedArea(view.hull) * view.score * (view.is_cut ? 0.1 : 1.0);
}

// The best views, the best one first. Views from nearly the same side are only taken if there are
// no others.
std::vector<const ObservationResult*> BestObservations(const ObjectResult& object) {
  const double similar = std::cos(12.0 / 180.0 * std::numbers::pi);
  std::vector<const ObservationResult*> sorted;
  for (const ObservationResult& view : object.observations) {
    sorted.push_back(&view);
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const ObservationResult* a, const ObservationResult* b) {
                     return Goodness(*a) > Goodness(*b);
                   });
  std::vector<const ObservationResult*> best;
  std::vector<const ObservationResult*> others;
  for (const ObservationResult* view : sorted) {
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const ObservationResult* taken) {
      return DirectionOf(object, *view).dot(DirectionOf(object, *taken)) > similar;
    });
    (is_new ? best : others).push_back(view);
  }
  best.insert(best.end(), others.begin(), others.end());
  // gcc 12 wrongly warns of resize().
  return {best.begin(), best.begin() + static_cast<ptrdiff_t>(std::min(best.size(), kCutouts))};
}

void AddCutoutTasks(ViewObject& shown, const PinholeCamera& camera, std::vector<ImageTask>& tasks) {
  const std::vector<const ObservationResult*> best = BestObservations(shown.object);
  shown.cutouts.resize(best.size());
  for (size_t i = 0; i < best.size(); ++i) {
    tasks.push_back(
        {best[i]->timestamp, [&shown, &camera, view = *best[i], i](const cv::Mat& image) {
           const SeenShapes shapes = ShapesOf(shown.object, view, camera);
           const cv::Rect part = CutoutBox(shapes.outline.points, image.size());
           if (part.empty()) {
             return;
           }
           const double scale =
               std::min(2.0, static_cast<double>(kCutoutSize) / std::max(part.width, part.height));
           shown.cutouts[i] = MakePicture(image, view.timestamp, part, scale, {shapes});
         }});
  }
}

// The stamps of the pictures, which are stamps of keyframes.
std::vector<double> PictureStamps(const ViewModel& model, size_t most) {
  std::vector<double> stamps;
  for (const StampedPose& pose : model.keyframes.poses) {
    stamps.push_back(pose.timestamp);
  }
  std::sort(stamps.begin(), stamps.end());
  return Thin(stamps, most);
}

}  // namespace

LeftOutTasks RunImageTasks(const ImageSequence& sequence, const PinholeCamera& camera,
                           std::vector<ImageTask> tasks) {
  std::stable_sort(tasks.begin(), tasks.end(), [](const ImageTask& a, const ImageTask& b) {
    return a.timestamp < b.timestamp;
  });
  LeftOutTasks left_out;
  const FramePaths* loaded = nullptr;
  cv::Mat image;
  for (const ImageTask& task : tasks) {
    const FramePaths* const frame = FindFrameAt(sequence, task.timestamp);
    if (frame != nullptr && frame != loaded) {
      try {
        image = LoadColour(sequence, *frame, camera);
      } catch (const InputError&) {
        image = cv::Mat();
      }
      loaded = frame;
    }
    if (frame == nullptr) {
      ++left_out.absent;
    } else if (image.empty()) {
      ++left_out.unreadable;
    } else {
      task.use(image);
    }
  }
  return left_out;
}

std::vector<ImageTask> ColourTasks(const Map& map, const PinholeCamera& camera,
                                   PointColours& colours) {
  std::vector<ImageTask> tasks;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    tasks.push_back({keyframe.frame->timestamp, [id, &camera, &colours](const cv::Mat& image) {
                       colours.Add(id, image, camera);
                     }});
  });
  return tasks;
}

std::vector<ImageTask> PictureTasks(size_t most, ViewModel& model) {
  std::vector<ImageTask> tasks;
  const PinholeCamera& camera = *model.camera;
  const std::vector<double> stamps = PictureStamps(model, most);
  model.pictures.reserve(stamps.size());
  for (const double stamp : stamps) {
    tasks.push_back({stamp, [&model, &camera, stamp](const cv::Mat& image) {
                       std::vector<SeenShapes> shapes;
                       for (const ViewObject& shown : model.objects) {
                         for (const ObservationResult& view : shown.object.observations) {
                           if (std::abs(view.timestamp - stamp) < kSameMoment) {
                             shapes.push_back(ShapesOf(shown.object, view, camera));
                           }
                         }
                       }
                       model.pictures.push_back(MakePicture(
                           image, stamp, cv::Rect(cv::Point(), image.size()),
                           std::min(1.0, static_cast<double>(kPictureWidth) / image.cols), shapes));
                     }});
  }
  for (ViewObject& shown : model.objects) {
    AddCutoutTasks(shown, camera, tasks);
  }
  return tasks;
}

}  // namespace hullslam
