// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "camera/wide_lens.h"
#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

// Blocks of 4 x 2 pixels are cast together.
constexpr int kBlockColumns = 4;
constexpr int kBlockRows = RayPacket::kSize / kBlockColumns;

struct PartPlacement {
  Matrix3f part_from_world;
  Vector3f centre;  // world frame
};

// An ellipsoid around an object that blocks ambient light from the surfaces near it.
struct Occluder {
  Matrix3f unit_from_world;
  Vector3f centre;
  float reach = 0.0F;  // metres
};

// The occluders that are within their reach of some point of the box around the part.
std::vector<Occluder> OccludersNear(const Part& part, const PartPlacement& placement,
                                    const std::vector<Occluder>& all) {
  std::vector<Occluder> near;
  const Vector3f half = part.shape.half.cast<float>();
  for (const Occluder& occluder : all) {
    const Vector3f local = placement.part_from_world * (occluder.centre - placement.centre);
    const Vector3f outside = (local.cwiseAbs() - half).cwiseMax(0.0F);
    if (outside.norm() < occluder.reach) {
      near.push_back(occluder);
    }
  }
  return near;
}

// The fraction of the ambient light that the occluders let through. It gives soft shadows under and
// beside objects.
float AmbientLeft(const std::vector<Occluder>& occluders, const Vector3f& point,
                  const Vector3f& normal) {
  float left = 1.0F;
  for (const Occluder& occluder : occluders) {
    const Vector3f offset = occluder.centre - point;
    const float squared = offset.squaredNorm();
    if (squared > occluder.reach * occluder.reach) {
      continue;
    }
    const float facing = normal.dot(offset);
    if (facing <= 0.0F) {
      continue;
    }
    const float unit = std::max(1.0F, (occluder.unit_from_world * offset).squaredNorm());
    // The last factor fades the shadow out, so that it has no visible edge at the distance `reach`.
    const float fade = 1.0F - squared / (occluder.reach * occluder.reach);
    left *= 1.0F - 0.75F * facing / std::sqrt(squared) / unit * fade;
  }
  return left;
}

float Lambert(const Scene& scene, const Vector3f& point, const Vector3f& normal, float ambient) {
  float light = scene.ambient * ambient;
  for (const PointLight& source : scene.lights) {
    const Vector3f offset = source.position - point;
    const float towards = normal.dot(offset);
    if (towards <= 0.0F) {
      continue;
    }
    const float squared = offset.squaredNorm();
    const float facing = towards / std::sqrt(squared);
    // The 1 in the denominator stands for the size of the lamps: near a lamp the light does not
    // grow without limit.
    light += facing * source.strength / (1.0F + squared) * (0.4F + 0.6F * ambient);
  }
  return light;
}

int DominantAxis(const Vector3f& v) {
  Eigen::Index axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

// Texture coordinates on the plane perpendicular to `axis`, in units of a repeat. Seen from
// outside, u goes to the right and v down.
Vector2f PlaneCoordinates(int axis, float side, const Vector3f& repeats) {
  switch (axis) {
    case 0:
      return {side * repeats.y(), -repeats.z()};
    case 1:
      return {-side * repeats.x(), -repeats.z()};
    default:
      return {repeats.x(), -repeats.y()};
  }
}

// Pixels with a neighbour that shows another facet.
std::vector<cv::Point> FacetEdges(const cv::Mat& facet) {
  std::vector<cv::Point> edges;
  for (int y = 0; y < facet.rows; ++y) {
    for (int x = 0; x < facet.cols; ++x) {
      const int here = facet.at<int>(y, x);
      if ((x > 0 && facet.at<int>(y, x - 1) != here) ||
          (x + 1 < facet.cols && facet.at<int>(y, x + 1) != here) ||
          (y > 0 && facet.at<int>(y - 1, x) != here) ||
          (y + 1 < facet.rows && facet.at<int>(y + 1, x) != here)) {
        edges.emplace_back(x, y);
      }
    }
  }
  return edges;
}

}  // namespace

struct Renderer::Eye {
  Matrix3f world_from_cam;
  Vector3f centre;
};

struct Renderer::View {
  std::vector<Eye> eyes;  // one for each kBlockRows rows
  std::vector<Rigid3> world_from_object;
  std::vector<PartPlacement> placements;         // one per entry of RayCaster::parts()
  std::vector<std::vector<Occluder>> occluders;  // per part; empty for the parts of objects

  const Eye& EyeOf(int row) const { return eyes[static_cast<size_t>(row / kBlockRows)]; }
};

struct Renderer::Fragment {
  Vector3f colour = Vector3f::Zero();
  float cosine = 0.0F;
  int facet = 0;  // differs between parts and between sides of a part
};

Renderer::Renderer(const Scene& scene, const PinholeCamera& camera, double readout_time)
    : scene_(scene), camera_(camera), readout_time_(readout_time), caster_(scene) {
  if (camera.IsFisheye()) {
    largest_angle_ = LargestAngle(camera, std::numbers::pi);
  }
}

Vector3f Renderer::Direction(const Eye& eye, float x, float y) const {
  if (camera_.IsFisheye()) {
    return eye.world_from_cam * RayOfRawPixel(camera_, {x, y}, largest_angle_).cast<float>();
  }
  const Eigen::Vector2d pixel = camera_.Undistort({x, y});
  const Vector3f in_cam(static_cast<float>((pixel.x() - camera_.cx) / camera_.fx),
                        static_cast<float>((pixel.y() - camera_.cy) / camera_.fy), 1.0F);
  return eye.world_from_cam * in_cam;
}

Renderer::View Renderer::MakeView(double time) const {
  View view;
  std::vector<Occluder> occluders;
  for (int row = 0; row < camera_.height; row += kBlockRows) {
    const double middle = row + 0.5 * (kBlockRows - 1);
    const Rigid3 world_from_cam =
        scene_.world_from_cam(time + (middle / camera_.height - 0.5) * readout_time_);
    view.eyes.push_back({world_from_cam.rotation.toRotationMatrix().cast<float>(),
                         world_from_cam.translation.cast<float>()});
  }
  for (const SceneObject& object : scene_.objects) {
    const Rigid3 pose = object.WorldFromObject(time);
    view.world_from_object.push_back(pose);
    const Matrix3f turn = pose.rotation.conjugate().toRotationMatrix().cast<float>();
    const Vector3f half = object.half_extents.cast<float>();
    occluders.push_back({.unit_from_world = half.cwiseInverse().asDiagonal() * turn,
                         .centre = pose.translation.cast<float>(),
                         .reach = 2.5F * half.maxCoeff()});
  }
  for (const PlacedPart& placed : caster_.parts()) {
    const Rigid3 world_from_part =
        (placed.object < 0 ? Rigid3()
                           : view.world_from_object[static_cast<size_t>(placed.object)]) *
        placed.part->owner_from_part;
    view.placements.push_back(
        {world_from_part.rotation.conjugate().toRotationMatrix().cast<float>(),
         world_from_part.translation.cast<float>()});
    view.occluders.push_back(placed.object < 0
                                 ? OccludersNear(*placed.part, view.placements.back(), occluders)
                                 : std::vector<Occluder>());
  }
  return view;
}

Vector3f Renderer::TextureColour(const Material& material, const Vector3f& point,
                                 const Vector3f& normal, const Vector3f& direction, float distance,
                                 int max_samples) const {
  const int axis = DominantAxis(normal);
  const float side = normal[axis] < 0.0F ? -1.0F : 1.0F;
  // A pixel covers `across` metres perpendicular to the slant, and more along the slant of the
  // surface. Up to `max_samples` samples along the slant keep the detail in the other direction.
  const float across = distance / static_cast<float>(camera_.fx);
  const float cosine = std::max(0.05F, std::abs(normal.dot(direction)));
  const int samples = std::min(max_samples, static_cast<int>(1.0F / cosine));
  Vector3f along = direction - normal.dot(direction) * normal;
  along *= across / cosine / std::max(1e-3F, along.norm());
  const float width = std::max(across, across / cosine / static_cast<float>(samples));
  const float tile = axis == 0 ? material.tile.y() : material.tile.x();
  const Texture& texture = scene_.textures[static_cast<size_t>(material.texture)];
  const float level = texture.LevelOfDetail(width / tile);
  // The offset is always measured on the face as seen from outside, even if the coordinate
  // increases in the other direction.
  const Vector2f offset((axis == 0 ? material.offset.y() : material.offset.x()) / tile,
                        axis == 2 ? material.offset.y() / material.tile.y()
                                  : material.offset.z() / material.tile.z());
  const Vector2f middle = PlaneCoordinates(axis, side, point.cwiseQuotient(material.tile)) + offset;
  const Vector2f reach = PlaneCoordinates(axis, side, along.cwiseQuotient(material.tile));
  Vector3f sum = Vector3f::Zero();
  for (int i = 0; i < samples; ++i) {
    const float shift = (static_cast<float>(i) + 0.5F) / static_cast<float>(samples) - 0.5F;
    sum += texture.Sample(middle + shift * reach, level);
  }
  return (sum / static_cast<float>(samples)).cwiseProduct(material.tint);
}

Renderer::Fragment Renderer::Shade(const View& view, const Eye& eye, int part, float distance,
                                   const Vector3f& direction, int max_samples) const {
  Fragment fragment;
  const PlacedPart& placed = caster_.parts()[static_cast<size_t>(part)];
  const PartPlacement& placement = view.placements[static_cast<size_t>(part)];
  const Vector3f point = eye.centre + distance * direction;
  const Vector3f local = placement.part_from_world * (point - placement.centre);
  const Vector3f normal = placed.part->shape.Normal(local.cast<double>()).cast<float>();
  const Vector3f ray = direction.normalized();
  const Vector3f local_ray = placement.part_from_world * ray;
  const Vector3f world_normal = placement.part_from_world.transpose() * normal;
  const float ambient = placed.object < 0 ? AmbientLeft(view.occluders[static_cast<size_t>(part)],
                                                        point, world_normal)
                                          : 1.0F;
  const float light = Lambert(scene_, point, world_normal, ambient);
  fragment.colour =
      light * TextureColour(placed.part->material, local, normal, local_ray, distance, max_samples);
  fragment.cosine = std::abs(normal.dot(local_ray));
  const int axis = DominantAxis(normal);
  fragment.facet = part * 8 + 2 * axis + (normal[axis] < 0.0F ? 1 : 0);
  return fragment;
}

void Renderer::RenderBlock(const View& view, int x0, int y0, RenderedFrame& frame,
                           cv::Mat& facet) const {
  const Eye& eye = view.EyeOf(y0);
  RayPacket packet;
  for (int i = 0; i < RayPacket::kSize; ++i) {
    const int x = x0 + i % kBlockColumns;
    const int y = y0 + i / kBlockColumns;
    packet.direction[static_cast<size_t>(i)] =
        Direction(eye, static_cast<float>(x), static_cast<float>(y));
  }
  caster_.Cast(eye.centre, view.world_from_object, packet);
  for (int i = 0; i < RayPacket::kSize; ++i) {
    const int x = x0 + i % kBlockColumns;
    const int y = y0 + i / kBlockColumns;
    if (x >= camera_.width || y >= camera_.height) {
      continue;
    }
    const auto k = static_cast<size_t>(i);
    Check(packet.part[k] >= 0, "a ray left the room: the scene is not closed");
    const Fragment hit =
        Shade(view, eye, packet.part[k], packet.distance[k], packet.direction[k], 4);
    frame.colour.at<cv::Vec3f>(y, x) = {hit.colour[0], hit.colour[1], hit.colour[2]};
    frame.depth.at<float>(y, x) = packet.distance[k];
    frame.instance.at<int16_t>(y, x) =
        static_cast<int16_t>(caster_.parts()[static_cast<size_t>(packet.part[k])].object);
    frame.cosine.at<float>(y, x) = hit.cosine;
    if (!frame.axial.empty()) {
      frame.axial.at<float>(y, x) = eye.world_from_cam.col(2).dot(packet.direction[k]);
    }
    facet.at<int>(y, x) = hit.facet;
  }
}

void Renderer::RenderCentres(const View& view, RenderedFrame& frame, cv::Mat& facet) const {
  // The image is rendered in tiles, because a whole row touches too many memory pages of the
  // textures.
  constexpr int kTile = 32;
  for (int top = 0; top < camera_.height; top += kTile) {
    for (int left = 0; left < camera_.width; left += kTile) {
      for (int y = top; y < std::min(top + kTile, camera_.height); y += kBlockRows) {
        for (int x = left; x < std::min(left + kTile, camera_.width); x += kBlockColumns) {
          RenderBlock(view, x, y, frame, facet);
        }
      }
    }
  }
}

void Renderer::SmoothEdges(const View& view, const cv::Mat& facet, RenderedFrame& frame) const {
  // Four rays in a rotated grid, so that vertical and horizontal edges get four shades too. Two
  // pixels share a packet, and all rays of a packet begin at the same point. The two are nearly
  // always in the same row.
  constexpr std::array<std::array<float, 2>, 4> kOffsets = {
      {{-0.125F, -0.375F}, {0.375F, -0.125F}, {0.125F, 0.375F}, {-0.375F, 0.125F}}};
  const std::vector<cv::Point> edges = FacetEdges(facet);
  RayPacket packet;
  for (size_t first = 0; first < edges.size(); first += 2) {
    const std::array<cv::Point, 2> pixels = {edges[first],
                                             edges[std::min(first + 1, edges.size() - 1)]};
    const Eye& eye = view.EyeOf(pixels[0].y);
    for (size_t i = 0; i < RayPacket::kSize; ++i) {
      const cv::Point& pixel = pixels[i / kOffsets.size()];
      const auto& offset = kOffsets[i % kOffsets.size()];
      packet.direction[i] = Direction(eye, static_cast<float>(pixel.x) + offset[0],
                                      static_cast<float>(pixel.y) + offset[1]);
    }
    caster_.Cast(eye.centre, view.world_from_object, packet);
    std::array<Vector3f, 2> sums = {Vector3f::Zero(), Vector3f::Zero()};
    for (size_t i = 0; i < RayPacket::kSize; ++i) {
      Check(packet.part[i] >= 0, "a ray left the room: the scene is not closed");
      sums[i / kOffsets.size()] +=
          Shade(view, eye, packet.part[i], packet.distance[i], packet.direction[i], 1).colour;
    }
    for (size_t i = 0; i < pixels.size(); ++i) {
      const Vector3f colour = sums[i] / static_cast<float>(kOffsets.size());
      frame.colour.at<cv::Vec3f>(pixels[i]) = {colour[0], colour[1], colour[2]};
    }
  }
}

RenderedFrame Renderer::Render(double time) const {
  const cv::Size size(camera_.width, camera_.height);
  RenderedFrame frame{.colour = cv::Mat(size, CV_32FC3),
                      .depth = cv::Mat(size, CV_32FC1),
                      .instance = cv::Mat(size, CV_16SC1),
                      .cosine = cv::Mat(size, CV_32FC1),
                      .axial = camera_.IsFisheye() ? cv::Mat(size, CV_32FC1) : cv::Mat()};
  cv::Mat facet(size, CV_32SC1);
  const View view = MakeView(time);
  RenderCentres(view, frame, facet);
  SmoothEdges(view, facet, frame);
  return frame;
}

}  // namespace hullslam::synthetic
