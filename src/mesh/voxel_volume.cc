// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/voxel_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "util/lists.h"

namespace hullslam {
namespace {

constexpr int64_t kMostPlace = 1 << 20;  // blocks from the origin, along an axis
constexpr int kRowsPerTask = 16;
constexpr size_t kBlocksPerTask = 32;
constexpr double kNearest = 1e-2;  // m in front of the camera

// A pose as numbers of single precision, for inner loops.
struct FastPose {
  explicit FastPose(const Rigid3& cam_from_world)
      : rotation(cam_from_world.rotation.toRotationMatrix().cast<float>()),
        translation(cam_from_world.translation.cast<float>()) {}
  Eigen::Vector3f operator*(const Eigen::Vector3f& point) const {
    return rotation * point + translation;
  }

  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;
};

// What a view measures at a raw pixel.
struct Sample {
  float depth = 0.0F;  // m along z
  float cosine = 0.0F;
  float weight = 0.0F;
  cv::Vec3b colour;
};

// The depths up to which a view has distances in front of and behind its surfaces, in tiles of the
// raw image: the largest ones, m; 0 where no surface is known.
class FarthestDepths {
 public:
  FarthestDepths(const DepthView& view, double truncation)
      : depths_((view.inverse_depth.rows + kTile - 1) / kTile,
                (view.inverse_depth.cols + kTile - 1) / kTile, CV_32FC1, cv::Scalar(0.0)) {
    for (int y = 0; y < view.inverse_depth.rows; ++y) {
      const auto* const row = view.inverse_depth.ptr<float>(y);
      const auto* const cosines = view.cosine.ptr<float>(y);
      auto* const tiles = depths_.ptr<float>(y / kTile);
      for (int x = 0; x < view.inverse_depth.cols; ++x) {
        if (row[x] > 0.0F) {
          const float behind = static_cast<float>(truncation) / cosines[x];
          tiles[x / kTile] = std::max(tiles[x / kTile], 1.0F / row[x] + behind);
        }
      }
    }
    for (int y = 0; y < depths_.rows; ++y) {
      const auto* const tiles = depths_.ptr<float>(y);
      all_ = std::max(all_, *std::max_element(tiles, tiles + depths_.cols));
    }
  }

  float all() const { return all_; }
  // The largest one at most `radius` px away from a raw pixel.
  float Near(const Eigen::Vector2d& raw, double radius) const {
    const auto tile = [&](double at, int count) {
      return static_cast<int>(std::clamp(at / kTile, 0.0, count - 1.0));
    };
    float most = 0.0F;
    for (int y = tile(raw.y() - radius, depths_.rows); y <= tile(raw.y() + radius, depths_.rows);
         ++y) {
      const auto* const tiles = depths_.ptr<float>(y);
      most = std::max(most, *std::max_element(tiles + tile(raw.x() - radius, depths_.cols),
                                              tiles + tile(raw.x() + radius, depths_.cols) + 1));
    }
    return most;
  }

 private:
  static constexpr int kTile = 16;  // px
  cv::Mat depths_;
  float all_ = 0.0F;
};

// Adds a view to blocks. Several threads may add it to different blocks.
class Fusion {
 public:
  Fusion(const DepthView& view, const FarthestDepths& farthest, double voxel, double truncation)
      : view_(view),
        farthest_(farthest),
        bounds_(view.camera.UndistortedBounds()),
        middle_(view.cam_from_world[view.cam_from_world.size() / 2]),
        voxel_(static_cast<float>(voxel)),
        truncation_(static_cast<float>(truncation)) {
    if (view.cam_from_world.size() > 1) {
      for (const Rigid3& pose : view.cam_from_world) {
        poses_.emplace_back(pose);
      }
      const Rigid3& middle = view.cam_from_world[view.cam_from_world.size() / 2];
      for (const Rigid3& end : {view.cam_from_world.front(), view.cam_from_world.back()}) {
        const Rigid3 moved = end * Inverse(middle);
        most_turn_ = std::max(most_turn_, static_cast<float>(LogSo3(moved.rotation).norm()));
        most_shift_ = std::max(most_shift_, static_cast<float>(moved.translation.norm()));
      }
    }
  }

  void AddTo(VoxelVolume::Block& block) const {
    constexpr int kSide = VoxelVolume::kSide;
    const Eigen::Vector3f origin = voxel_ * (kSide * block.place).cast<float>();
    if (!MaySee(origin)) {
      return;
    }
    const float most_depth = MostDepth(origin);
    const Eigen::Vector3f step = voxel_ * middle_.rotation.col(0);
    size_t i = 0;
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        Eigen::Vector3f point = origin + voxel_ * Eigen::Vector3i(0, y, z).cast<float>();
        Eigen::Vector3f in_cam = middle_ * point;
        for (int x = 0; x < kSide; ++x, ++i) {
          if (in_cam.z() <= most_depth) {
            AddTo(point, in_cam, block.voxels[i]);
          }
          point.x() += voxel_;
          in_cam += step;
        }
      }
    }
  }

 private:
  // Whether a part of the block may be in the image and not behind all that it shows.
  bool MaySee(const Eigen::Vector3f& origin) const {
    const float half = 0.5F * VoxelVolume::kSide * voxel_;
    const float radius = std::sqrt(3.0F) * half;
    const Eigen::Vector3f centre = middle_ * (origin + Eigen::Vector3f::Constant(half));
    if (centre.z() < -radius || centre.z() - radius > farthest_.all()) {
      return false;
    }
    // Other rows of a rolling shutter see this far beyond the borders of the middle row's image.
    const float beyond = most_turn_ * centre.norm() + most_shift_;
    const auto is_within = [&](float at, double least, double most) {
      const auto low = static_cast<float>(least);
      const auto high = static_cast<float>(most);
      return at - low * centre.z() > -beyond - radius * std::hypot(1.0F, low) &&
             at - high * centre.z() < beyond + radius * std::hypot(1.0F, high);
    };
    const PinholeCamera& camera = view_.camera;
    return is_within(centre.x(), (bounds_.min_x - camera.cx) / camera.fx,
                     (bounds_.max_x - camera.cx) / camera.fx) &&
           is_within(centre.y(), (bounds_.min_y - camera.cy) / camera.fy,
                     (bounds_.max_y - camera.cy) / camera.fy);
  }

  // The depth, m, beyond which all voxels of a block are too far behind the surfaces around its
  // image. A rolling shutter moves them a little.
  float MostDepth(const Eigen::Vector3f& origin) const {
    const float half = 0.5F * VoxelVolume::kSide * voxel_;
    const Eigen::Vector3f centre = middle_ * (origin + Eigen::Vector3f::Constant(half));
    const float reach = std::sqrt(3.0F) * half + most_turn_ * centre.norm() + most_shift_;
    const std::optional<Eigen::Vector2d> raw = RawPixel(centre);
    if (!raw || centre.z() < 2.0F * reach) {
      return farthest_.all() + reach;
    }
    // A point that moves by `reach` moves by this angle at most, and its image with the lens. (The
    // norm of the derivative is at least 1.4 times the stretch, which is enough for its changes.)
    const auto angle =
        static_cast<double>(reach / (centre.z() - reach) * centre.norm() / centre.z());
    const Eigen::Vector2d pixel = view_.camera.Project(centre.cast<double>());
    const double stretch = view_.camera.DistortionJacobian(pixel).norm();
    return farthest_.Near(*raw, view_.camera.fx * angle * stretch + 1.0) + most_turn_ * reach +
           most_shift_;
  }

  // The raw pixel of a point (camera frame, m).
  std::optional<Eigen::Vector2d> RawPixel(const Eigen::Vector3f& in_cam) const {
    if (!(in_cam.z() > static_cast<float>(kNearest))) {
      return std::nullopt;
    }
    const Eigen::Vector2d pixel = view_.camera.Project(in_cam.cast<double>());
    return bounds_.Contains(pixel) ? std::optional(view_.camera.Distort(pixel)) : std::nullopt;
  }

  // Interpolates the inverse depth, which is linear in the image of a plane, between four pixels.
  // Nothing if one of them is not used, because it may be at the border of a surface.
  std::optional<Sample> At(const Eigen::Vector2d& raw) const {
    const int x = static_cast<int>(std::floor(raw.x()));
    const int y = static_cast<int>(std::floor(raw.y()));
    if (x < 0 || y < 0 || x + 1 >= view_.inverse_depth.cols || y + 1 >= view_.inverse_depth.rows) {
      return std::nullopt;
    }
    const auto* const above = view_.inverse_depth.ptr<float>(y) + x;
    const auto* const below = view_.inverse_depth.ptr<float>(y + 1) + x;
    if (above[0] <= 0.0F || above[1] <= 0.0F || below[0] <= 0.0F || below[1] <= 0.0F) {
      return std::nullopt;
    }
    const auto right = static_cast<float>(raw.x() - x);
    const auto down = static_cast<float>(raw.y() - y);
    const float inverse = (1.0F - down) * ((1.0F - right) * above[0] + right * above[1]) +
                          down * ((1.0F - right) * below[0] + right * below[1]);
    const int column = right < 0.5F ? x : x + 1;
    const int row = down < 0.5F ? y : y + 1;
    return Sample{1.0F / inverse, view_.cosine.at<float>(row, column),
                  view_.weight.at<float>(row, column), view_.colour.at<cv::Vec3b>(row, column)};
  }

  // Moves a point of the camera frame of the middle row to that of the row that shows it. The
  // image moves by a few rows at most, so two steps are enough: each lowers the error by the share
  // of the image that it moves during its readout.
  std::optional<Eigen::Vector2d> Find(const Eigen::Vector3f& point, Eigen::Vector3f& in_cam) const {
    std::optional<Eigen::Vector2d> raw = RawPixel(in_cam);
    for (int i = 0; i < 2 && raw && !poses_.empty(); ++i) {
      in_cam = poses_[view_.PoseIndex(*raw)] * point;
      raw = RawPixel(in_cam);
    }
    return raw;
  }

  void AddTo(const Eigen::Vector3f& point, Eigen::Vector3f in_cam,
             VoxelVolume::Voxel& voxel) const {
    const std::optional<Eigen::Vector2d> raw = Find(point, in_cam);
    const std::optional<Sample> sample = raw ? At(*raw) : std::nullopt;
    if (!sample) {
      return;
    }
    // The distance from the plane that the pixel shows.
    const float distance =
        (sample->depth - in_cam.z()) * in_cam.norm() / in_cam.z() * sample->cosine;
    if (distance < -truncation_) {
      return;
    }
    // What is farther behind a surface more likely belongs to another one.
    const float behind = std::clamp((distance + truncation_) / (truncation_ - voxel_), 0.0F, 1.0F);
    const float weight = sample->weight * behind;
    const float sum = voxel.weight + weight;
    if (!(weight > 0.0F)) {
      return;
    }
    const float share = weight / sum;
    voxel.distance += share * (std::min(distance, truncation_) - voxel.distance);
    voxel.weight = sum;
    if (distance < truncation_) {
      MixColour(sample->colour, voxel.has_colour != 0 ? share : 1.0F, voxel);
    }
  }

  static void MixColour(const cv::Vec3b& bgr, float share, VoxelVolume::Voxel& voxel) {
    for (size_t channel = 0; channel < 3; ++channel) {
      const float before = voxel.colour[channel];
      const float seen = 256.0F * static_cast<float>(bgr[static_cast<int>(2 - channel)]);
      voxel.colour[channel] = static_cast<uint16_t>(std::lround(before + share * (seen - before)));
    }
    voxel.has_colour = 1;
  }

  const DepthView& view_;
  const FarthestDepths& farthest_;
  PinholeCamera::Bounds bounds_;
  FastPose middle_;
  std::vector<FastPose> poses_;  // empty for a global shutter
  float voxel_;
  float truncation_;
  float most_turn_ = 0.0F;   // radians, between the middle row and another one
  float most_shift_ = 0.0F;  // m
};

}  // namespace

std::optional<uint64_t> VoxelVolume::KeyOf(const Eigen::Vector3i& place) {
  uint64_t key = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const int64_t shifted = place[axis] + kMostPlace;
    if (shifted < 0 || shifted >= 2 * kMostPlace) {
      return std::nullopt;
    }
    key = (key << 21U) | static_cast<uint64_t>(shifted);
  }
  return key;
}

const VoxelVolume::Block* VoxelVolume::Find(const Eigen::Vector3i& place) const {
  const std::optional<uint64_t> key = KeyOf(place);
  const auto found = key ? index_.find(*key) : index_.end();
  return found != index_.end() ? blocks_[found->second].get() : nullptr;
}

void VoxelVolume::AddKeysOfRow(const DepthView& view, int row, int step,
                               std::vector<uint64_t>& keys) const {
  const double side = kSide * voxel_;
  const auto* const inverse = view.inverse_depth.ptr<float>(row);
  const auto* const rays = view.rays.ptr<cv::Vec2f>(row);
  for (int x = 0; x < view.inverse_depth.cols; x += step) {
    if (!(inverse[x] > 0.0F)) {
      continue;
    }
    const size_t pose = view.PoseIndex(Eigen::Vector2d(x, row));
    const Rigid3 world_from_cam = Inverse(view.cam_from_world[pose]);
    const Eigen::Vector3d ray(static_cast<double>(rays[x][0]), static_cast<double>(rays[x][1]),
                              1.0);
    const double at = ray.norm() / static_cast<double>(inverse[x]);
    const int parts = static_cast<int>(std::ceil(4.0 * truncation_ / side));
    for (int i = 0; i <= parts; ++i) {
      const double along = at + truncation_ * (2.0 * i / parts - 1.0);
      const Eigen::Vector3d point = world_from_cam * (along * ray.normalized());
      const Eigen::Vector3d place = (point / side).array().floor();
      if (place.cwiseAbs().maxCoeff() < static_cast<double>(kMostPlace)) {
        const auto key = KeyOf(place.cast<int>());
        if (key && (keys.empty() || keys.back() != *key)) {
          keys.push_back(*key);
        }
      }
    }
  }
}

std::vector<uint64_t> VoxelVolume::TouchedBlocks(const DepthView& view, double farthest,
                                                 TaskRunner& runner) const {
  // The pixels that are used are at most a third of a block apart.
  const double pixels = kSide * voxel_ * view.camera.fx / (3.0 * farthest);
  const int step = std::clamp(static_cast<int>(pixels), 1, 8);
  const int rows = view.inverse_depth.rows;
  const auto tasks = static_cast<size_t>((rows + kRowsPerTask - 1) / kRowsPerTask);
  std::vector<std::vector<uint64_t>> keys(tasks);
  runner.Run(tasks, [&](size_t task) {
    const int first = static_cast<int>(task) * kRowsPerTask;
    for (int row = first; row < std::min(rows, first + kRowsPerTask); row += step) {
      AddKeysOfRow(view, row, step, keys[task]);
    }
    SortUnique(keys[task]);
  });
  std::vector<uint64_t> all;
  for (const std::vector<uint64_t>& some : keys) {
    all.insert(all.end(), some.begin(), some.end());
  }
  SortUnique(all);
  std::erase_if(all, [&](uint64_t key) { return index_.contains(key); });
  return all;
}

bool VoxelVolume::Add(const DepthView& view, size_t most_blocks, TaskRunner& runner) {
  const FarthestDepths farthest(view, truncation_);
  if (farthest.all() <= 0.0F) {
    return true;
  }
  const std::vector<uint64_t> touched =
      TouchedBlocks(view, static_cast<double>(farthest.all()), runner);
  if (blocks_.size() + touched.size() > most_blocks) {
    return false;
  }
  for (const uint64_t key : touched) {
    constexpr uint64_t kMask = (1U << 21U) - 1U;
    const auto along = [&](unsigned axis) {
      return static_cast<int>(static_cast<int64_t>((key >> (21U * axis)) & kMask) - kMostPlace);
    };
    index_[key] = blocks_.size();
    blocks_.push_back(std::make_unique<Block>());
    blocks_.back()->place = {along(0), along(1), along(2)};
  }
  const Fusion fusion(view, farthest, voxel_, truncation_);
  runner.Run((blocks_.size() + kBlocksPerTask - 1) / kBlocksPerTask, [&](size_t task) {
    const size_t end = std::min(blocks_.size(), (task + 1) * kBlocksPerTask);
    for (size_t i = task * kBlocksPerTask; i < end; ++i) {
      fusion.AddTo(*blocks_[i]);
    }
  });
  return true;
}

}  // namespace hullslam
