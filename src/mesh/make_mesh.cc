// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/make_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "camera/fit_depth.h"
#include "datasets/run_sequence.h"
#include "datasets/view_images.h"
#include "eval/object_metrics.h"
#include "files/json_file.h"
#include "files/paths.h"
#include "frame/coarse_depth.h"
#include "frame/detection/mask_region.h"
#include "hullslam/datasets/dataset.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/settings/settings.h"
#include "hullslam/util/error.h"
#include "map/islands.h"
#include "masks/mask_all.h"
#include "results/finished_run.h"
#include "scene/up_direction.h"
#include "sequences/image_list.h"
#include "system/compose_trajectory.h"
#include "util/lists.h"
#include "util/statistics.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// ---- opening

constexpr const char* kNeedsDepth =
    "a mesh needs the depth of an RGB-D or a stereo camera, expected a run or a map that has it";

std::vector<ObjectResult> MappedOf(std::vector<ObjectResult> objects) {
  std::erase_if(objects, [](const ObjectResult& o) { return o.state != ObjectState::kMapped; });
  return objects;
}

fs::path FindSequence(const MeshSource& source, const FinishedRun& run) {
  const std::optional<fs::path> path =
      source.sequence.empty() ? run.Find(run.sequence.path) : std::optional(source.sequence);
  if (!path) {
    throw InputError(
        fmt::format("{}: the sequence '{}' of the run is not found, expected --sequence PATH",
                    source.input.string(), ShowText(run.sequence.path)));
  }
  return *path;
}

void OpenMasksOf(const fs::path& path, const std::string& format, MeshInput& input) {
  const cv::Size size = SizeAsRead(input.sequence, input.options.camera);
  input.masks = OpenMasks({path, format, size.width, size.height}, MaskFrames(input.sequence));
  input.read.push_back(path);
}

// The masks of the run, and that of all images.
void UseMasksOfRun(const MeshSource& source, const FinishedRun& run, MeshInput& input) {
  const fs::path summary = run.folder / "summary.json";
  const JsonNode provenance = JsonNode(summary, *run.summary).At("provenance");
  if (provenance.Has("mask_all")) {
    const std::string path = provenance.At("mask_all").At("path").Text();
    if (const std::optional<fs::path> found = run.Find(path)) {
      input.options.mask_all = ReadMaskAll(*found, input.sequence, input.options.camera);
    } else {
      input.notes.push_back("the mask of all images '" + path + "' is not found");
    }
  }
  if (!source.masks.empty()) {
    return;
  }
  if (const std::optional<fs::path> masks = run.Find(run.masks)) {
    OpenMasksOf(*masks, run.masks_format, input);
  } else if (!run.masks.empty() || provenance.Has("network")) {
    input.notes.push_back(
        fmt::format("the masks of the run are not found{}, so things that move are not left out; "
                    "--masks PATH names masks",
                    run.masks.empty() ? ", since a network made them" : " at '" + run.masks + "'"));
  }
}

void OpenRun(const MeshSource& source, MeshInput& input) {
  const FinishedRun run = OpenFinishedRun(source.input);
  if (!run.IsMetric()) {
    throw InputError(
        fmt::format("{}: the run is monocular; {}", source.input.string(), kNeedsDepth));
  }
  const fs::path settings =
      source.settings.empty() ? source.input / "settings.yaml" : source.settings;
  if (source.settings.empty() && !run.Has("settings.yaml")) {
    throw InputError(settings.string() +
                     ": is missing, because an earlier version has made the run; expected "
                     "--settings FILE with the settings of the run");
  }
  input.options = ReadSettings(settings, source.overrides);
  const fs::path sequence = FindSequence(source, run);
  input.sequence = OpenRunSequence(run.sequence, sequence, input.options.camera, true);
  input.read = {sequence};
  input.poses = run.ReadPoses();
  input.keyframes = StampsOf(run.ReadKeyframePoses());
  std::ranges::sort(input.keyframes);  // those of several sessions are not in order
  if (std::optional<ObjectResults> objects = run.ReadObjectResults()) {
    input.objects = MappedOf(std::move(objects->objects));
  }
  input.up = run.ReadSceneGraph().value_or(Scene()).up;
  UseMasksOfRun(source, run, input);
}

// The poses of the keyframes that this sequence has given.
Trajectory PosesOfSession(const Map& map, const fs::path& sequence) {
  if (map.sessions().size() < 2) {
    return KeyframeTrajectory(map);
  }
  Trajectory poses;
  for (size_t number = 1; number <= map.sessions().size(); ++number) {
    if (map.sessions()[number - 1].name == CanonicalName(sequence)) {
      const Trajectory more = KeyframeTrajectory(map, number);
      poses.insert(poses.end(), more.begin(), more.end());
    }
  }
  std::ranges::stable_sort(poses, {}, &StampedPose::timestamp);
  return poses;
}

void OpenMap(const MeshSource& source, MeshInput& input) {
  if (source.sequence.empty()) {
    throw InputError(source.input.string() +
                     ": a map has no images, expected --sequence PATH with those of its run");
  }
  StoredMap stored = ReadMap(source.input);
  KeepOnlyIsland(stored.map, MainIsland(stored.map));
  OpenedDataset opened = OpenFoundDataset(
      stored.settings.sensor,
      {.path = source.sequence, .settings = source.settings, .overrides = source.overrides});
  input.options = std::move(opened.settings.options);
  input.sequence = std::move(opened.sequence);
  if (!(input.options.camera == stored.settings.camera)) {
    throw InputError(fmt::format(
        "{}: the map was made with another camera than that of {}, expected --settings FILE with "
        "the settings of its run",
        source.input.string(), source.sequence.string()));
  }
  input.read = {source.input, source.sequence};
  input.poses = PosesOfSession(stored.map, source.sequence);
  input.keyframes = StampsOf(input.poses);
  input.objects = MappedOf(MeasuredObjects(stored.map, input.options.camera, {}).objects);
}

bool HasDepth(const ImageSequence& sequence) {
  return std::ranges::any_of(sequence.frames, [](const FramePaths& frame) {
    return !frame.depth.empty() || !frame.right.empty();
  });
}

}  // namespace

MeshInput OpenMeshInput(const MeshSource& source) {
  MeshInput input;
  std::error_code error;
  if (!fs::exists(source.input, error)) {
    throw InputError(source.input.string() +
                     ": does not exist, expected the output folder of a run or a map file");
  }
  fs::is_directory(source.input, error) ? OpenRun(source, input) : OpenMap(source, input);
  if (!HasDepth(input.sequence)) {
    throw InputError(fmt::format("{}: has no depth images and no right images; {}",
                                 source.input.string(), kNeedsDepth));
  }
  if (!source.masks.empty()) {
    OpenMasksOf(source.masks, source.masks_format, input);
  }
  if (!input.up) {
    input.up = UpFromImages(input.poses);
  }
  return input;
}

// ---- a view

namespace {

constexpr double kLeastCosine = 0.15;  // 81 degrees

// Whether the inverse depths of a surface at a pixel and at two opposite ones are linear in the
// image, as those of a plane are, up to the noise of a disparity; see KeypointDepth().
bool AreOnOneSurface(float before, float centre, float after, float most_bend) {
  return before > 0.0F && after > 0.0F && std::abs(0.5F * (before + after) - centre) <= most_bend;
}

// A row of the inverse depths without the pixels near the border of a surface and near unknown
// pixels.
void WriteInnerRow(const cv::Mat& inverse, int y, float most_bend, float* inner) {
  constexpr int kReach = 1;  // px
  if (y < kReach || y >= inverse.rows - kReach) {
    return;
  }
  const auto* const above = inverse.ptr<float>(y - kReach);
  const auto* const row = inverse.ptr<float>(y);
  const auto* const below = inverse.ptr<float>(y + kReach);
  for (int x = kReach; x < inverse.cols - kReach; ++x) {
    const auto is_plane = [&](float before, float after) {
      return AreOnOneSurface(before, row[x], after, most_bend);
    };
    if (row[x] > 0.0F && is_plane(row[x - kReach], row[x + kReach]) &&
        is_plane(above[x], below[x]) && is_plane(above[x - kReach], below[x + kReach]) &&
        is_plane(above[x + kReach], below[x - kReach])) {
      inner[x] = row[x];
    }
  }
}

// The points of a depth image (camera frame, m).
class Points {
 public:
  Points(const cv::Mat& inverse, const cv::Mat& rays, float most_bend)
      : inverse_(inverse), rays_(rays), most_bend_(most_bend) {}

  Eigen::Vector3f At(int x, int y) const {
    const auto& ray = rays_.at<cv::Vec2f>(y, x);
    return Eigen::Vector3f(ray[0], ray[1], 1.0F) / inverse_.at<float>(y, x);
  }

  // The cosine of the angle between the ray and the normal, from points on both sides of the pixel.
  // They are as far apart as the surface allows, because near ones differ by little more than their
  // noise. 0 if there are none.
  float Cosine(int x, int y) const {
    for (const int reach : {4, 2}) {
      if (IsPlane(x, y, reach, 0) && IsPlane(x, y, 0, reach)) {
        const Eigen::Vector3f across = At(x + reach, y) - At(x - reach, y);
        const Eigen::Vector3f down = At(x, y + reach) - At(x, y - reach);
        return std::abs(across.cross(down).normalized().dot(At(x, y).normalized()));
      }
    }
    return 0.0F;
  }

 private:
  bool IsPlane(int x, int y, int dx, int dy) const {
    return x >= dx && y >= dy && x + dx < inverse_.cols && y + dy < inverse_.rows &&
           AreOnOneSurface(inverse_.at<float>(y - dy, x - dx), inverse_.at<float>(y, x),
                           inverse_.at<float>(y + dy, x + dx), most_bend_);
  }

  const cv::Mat& inverse_;
  const cv::Mat& rays_;
  float most_bend_;
};

// A row of inverse depths, 1/m, 0 where the depth is unknown or beyond `max_depth`.
void WriteInverseRow(const cv::Mat& depth, int y, const DepthOptions& options, double max_depth,
                     float* inverse) {
  for (int x = 0; x < depth.cols; ++x) {
    const float metres = SampleDepth(depth, {x, y}, options.units_per_metre);
    const bool is_used = metres > 0.0F && static_cast<double>(metres) <= max_depth;
    inverse[x] = is_used ? 1.0F / metres : 0.0F;
  }
}

// Calls `task` for each row of an image.
void ForRows(int rows, TaskRunner& runner, const std::function<void(int)>& task) {
  constexpr int kPerTask = 32;
  runner.Run(static_cast<size_t>((rows + kPerTask - 1) / kPerTask), [&](size_t i) {
    const int first = kPerTask * static_cast<int>(i);
    for (int y = first; y < std::min(rows, first + kPerTask); ++y) {
      task(y);
    }
  });
}

}  // namespace

cv::Mat RaysOf(const PinholeCamera& camera, cv::Mat& is_seen) {
  cv::Mat rays = cv::Mat::zeros(camera.height, camera.width, CV_32FC2);
  is_seen = cv::Mat::zeros(rays.size(), CV_8UC1);
  for (int y = 0; y < rays.rows; ++y) {
    for (int x = 0; x < rays.cols; ++x) {
      const Eigen::Vector2d raw(x, y);
      if (camera.SeesRaw(raw)) {
        const Eigen::Vector3d ray = camera.Unproject(camera.Undistort(raw), 1.0);
        rays.at<cv::Vec2f>(y, x) = {static_cast<float>(ray.x()), static_cast<float>(ray.y())};
        is_seen.at<uint8_t>(y, x) = 255;
      }
    }
  }
  return rays;
}

std::vector<Rigid3> PosesOfRows(const SystemOptions& options, const Rigid3& cam_from_world,
                                const PointVelocity& velocity) {
  if (options.readout_time == 0.0 || !options.tracking.correct_shutter) {
    return {cam_from_world};
  }
  const int rows = options.readout_direction == ReadoutDirection::kRows ? options.camera.height
                                                                        : options.camera.width;
  std::vector<Rigid3> poses;
  for (int row = 0; row < rows; ++row) {
    // As in frame/rolling_shutter.cc: x(t) = Exp(t w) x(0) + t v.
    const double time = (static_cast<double>(row) / rows - 0.5) * options.readout_time;
    poses.push_back(Rigid3(ExpSo3(time * velocity.angular), time * velocity.linear) *
                    cam_from_world);
  }
  return poses;
}

DepthView MakeDepthView(const cv::Mat& depth, const SystemOptions& options, double max_depth,
                        const cv::Mat& rays, TaskRunner& runner) {
  constexpr double kMostBend = 0.3;  // px of disparity; see frame/depth_source.cc
  const auto most_bend = static_cast<float>(kMostBend / options.camera.bf);
  cv::Mat inverse(depth.size(), CV_32FC1);
  ForRows(depth.rows, runner, [&](int y) {
    WriteInverseRow(depth, y, options.depth, max_depth, inverse.ptr<float>(y));
  });
  DepthView view;
  view.camera = options.camera;
  view.readout = options.readout_direction;
  view.rays = rays;
  for (cv::Mat* const image : {&view.inverse_depth, &view.cosine, &view.weight}) {
    *image = cv::Mat(depth.size(), CV_32FC1, cv::Scalar(0.0));
  }
  const Points points(inverse, rays, most_bend);
  const double per_inverse = options.camera.bf / options.depth.error.disparity_sigma;
  ForRows(depth.rows, runner, [&](int y) {
    auto* const inner = view.inverse_depth.ptr<float>(y);
    WriteInnerRow(inverse, y, most_bend, inner);
    for (int x = 0; x < depth.cols; ++x) {
      const float cosine = inner[x] > 0.0F ? points.Cosine(x, y) : 0.0F;
      if (static_cast<double>(cosine) < kLeastCosine) {
        inner[x] = 0.0F;
        continue;
      }
      // The depth z has the standard deviation z^2 disparity_sigma / bf.
      const double per_sigma = per_inverse * std::pow(static_cast<double>(inner[x]), 2);
      view.cosine.at<float>(y, x) = cosine;
      view.weight.at<float>(y, x) = cosine * static_cast<float>(per_sigma * per_sigma);
    }
  });
  return view;
}

// ---- the mesh

namespace {

constexpr size_t kMostBlocks = 50'000;  // 8 kB each, of all volumes together
constexpr double kTruncation = 4.0;     // voxels
constexpr size_t kLeastTriangles = 100;

// A frame that is used, with its pose.
struct MeshFrame {
  size_t frame = 0;  // index in the sequence
  size_t pose = 0;   // index in the trajectory
};

// The frames that have the stamps of these poses.
std::vector<MeshFrame> ChooseFrames(const MeshInput& input, size_t every) {
  std::vector<MeshFrame> chosen;
  size_t next_keyframe = 0;
  for (size_t i = 0; i < input.poses.size(); ++i) {
    const double stamp = input.poses[i].timestamp;
    while (next_keyframe < input.keyframes.size() &&
           input.keyframes[next_keyframe] < stamp - kSameMoment) {
      ++next_keyframe;
    }
    const bool is_keyframe = next_keyframe < input.keyframes.size() &&
                             input.keyframes[next_keyframe] <= stamp + kSameMoment;
    if (every > 0 ? i % every != 0 : !is_keyframe) {
      continue;
    }
    const FramePaths* const frame = FindFrameAt(input.sequence, stamp);
    if (frame != nullptr && !(frame->depth.empty() && frame->right.empty())) {
      chosen.push_back({static_cast<size_t>(frame - input.sequence.frames.data()), i});
    }
  }
  if (chosen.empty()) {
    throw InputError(fmt::format(
        "no frame of the sequence with depth has the time stamp of a chosen pose ({} poses, {} "
        "keyframes), expected the sequence of the run; a run that only localised needs --every N",
        input.poses.size(), input.keyframes.size()));
  }
  return chosen;
}

// The velocity of points between the neighbours of a pose.
PointVelocity VelocityAt(const Trajectory& poses, size_t index) {
  constexpr double kMostGap = 0.25;  // s
  const auto is_near = [&](size_t other) {
    return std::abs(poses[other].timestamp - poses[index].timestamp) <= kMostGap;
  };
  const size_t before = index > 0 && is_near(index - 1) ? index - 1 : index;
  const size_t after = index + 1 < poses.size() && is_near(index + 1) ? index + 1 : index;
  const double duration = poses[after].timestamp - poses[before].timestamp;
  return duration > 0.0
             ? MeanVelocity(Inverse(poses[after].world_from_cam) * poses[before].world_from_cam,
                            duration)
             : PointVelocity{};
}

// The depth image of a frame, of the size of the camera.
cv::Mat ReadDepth(const MeshInput& input, const FramePaths& frame, TaskRunner& runner) {
  const PinholeCamera& camera = input.options.camera;
  if (frame.depth.empty()) {
    const ImageInput pair = input.sequence.load(frame, camera);
    return CoarseDepth(pair.grey, pair.right, camera,
                       {cv::Rect(0, 0, camera.width, camera.height), {}}, runner);
  }
  const DepthOptions& depth = input.options.depth;
  return WithoutDisparityOffset(ReadView(input.sequence, frame, camera, false).depth,
                                depth.disparity_offset, camera.bf, depth.units_per_metre);
}

// The region of a view that may show an object, and the contour of the object in the middle row's
// image.
class ObjectRegion {
 public:
  // `contour` has undistorted pixels, three or more.
  ObjectRegion(const DepthView& view, const std::vector<Eigen::Vector2d>& contour) {
    constexpr int kMargin = 32;  // px, more than a rolling shutter moves pixels
    std::vector<cv::Point> outline;
    for (const Eigen::Vector2d& point : contour) {
      outline.emplace_back(cvRound(point.x()), cvRound(point.y()));
      const Eigen::Vector2i raw = view.camera.Distort(point).cast<int>();
      box_ |= cv::Rect(raw.x() - kMargin, raw.y() - kMargin, 2 * kMargin, 2 * kMargin);
    }
    box_ &= cv::Rect({0, 0}, view.inverse_depth.size());
    inside_ = cv::boundingRect(outline);
    filled_ = cv::Mat(inside_.size(), CV_8UC1, cv::Scalar(0));
    cv::fillPoly(filled_, std::vector{outline}, cv::Scalar(255), cv::LINE_8, 0, -inside_.tl());
  }

  const cv::Rect& box() const { return box_; }  // raw px
  bool Contains(const Eigen::Vector2d& undistorted) const {
    const cv::Point at(cvRound(undistorted.x()), cvRound(undistorted.y()));
    return inside_.contains(at) && filled_.at<uint8_t>(at - inside_.tl()) != 0;
  }

 private:
  cv::Rect box_;
  cv::Rect inside_;
  cv::Mat filled_;
};

// The part of a view inside the contour of an object and inside its ellipsoid, which is enlarged,
// because objects are no ellipsoids.
DepthView OnlyObject(const DepthView& view, const Ellipsoid& ellipsoid,
                     const ObjectRegion& region) {
  constexpr double kEnlarged = 1.3;
  const Rigid3& middle = view.cam_from_world[view.cam_from_world.size() / 2];
  const Rigid3 object_from_world = Inverse(ellipsoid.world_from_object);
  DepthView part = view;
  part.inverse_depth = cv::Mat(view.inverse_depth.size(), CV_32FC1, cv::Scalar(0.0));
  std::vector<Rigid3> world_from_cam;
  for (const Rigid3& pose : view.cam_from_world) {
    world_from_cam.push_back(Inverse(pose));
  }
  for (int y = region.box().y; y < region.box().br().y; ++y) {
    for (int x = region.box().x; x < region.box().br().x; ++x) {
      const float inverse = view.inverse_depth.at<float>(y, x);
      if (inverse <= 0.0F) {
        continue;
      }
      const auto& ray = view.rays.at<cv::Vec2f>(y, x);
      const Eigen::Vector3f in_cam = Eigen::Vector3f(ray[0], ray[1], 1.0F) / inverse;
      const Eigen::Vector3d point =
          world_from_cam[view.PoseIndex(Eigen::Vector2d(x, y))] * in_cam.cast<double>();
      const Eigen::Vector3d in_object = object_from_world * point;
      if (in_object.cwiseQuotient(ellipsoid.half_axes).norm() <= kEnlarged &&
          region.Contains(view.camera.Project(middle * point))) {
        part.inverse_depth.at<float>(y, x) = inverse;
      }
    }
  }
  return part;
}

class MeshMaker {
 public:
  MeshMaker(const MeshInput& input, const MeshOptions& options, TaskRunner& runner)
      : input_(input),
        options_(options),
        runner_(runner),
        frames_(ChooseFrames(input, options.every)) {
    rays_ = RaysOf(input.options.camera, seen_);
    if (!input.options.mask_all.empty()) {
      seen_.setTo(0, input.options.mask_all == 0);
    }
    if (input.masks != nullptr) {
      names_ = MaskFrames(input.sequence);
    }
    const PinholeCamera& camera = input.options.camera;
    max_depth_ =
        options.max_depth.value_or(input.options.depth.close_baselines * camera.bf / camera.fx);
  }

  std::optional<Mesh> Make(const std::function<bool(size_t, size_t)>& go_on) {
    voxel_ = options_.voxel.value_or(0.0);
    if (!options_.voxel) {
      voxel_ = ChooseVoxel();
    }
    for (;; voxel_ *= 2.0) {
      const Outcome outcome = AddViews(go_on);
      if (outcome == Outcome::kStopped) {
        return std::nullopt;
      }
      if (outcome == Outcome::kDone) {
        return Extract();
      }
      if (options_.voxel) {
        throw InputError(fmt::format(
            "voxels of {:g} m need more than {} blocks of memory, expected larger ones (--voxel) "
            "or a smaller --max-depth",
            voxel_, kMostBlocks));
      }
    }
  }

 private:
  enum class Outcome { kDone, kStopped, kTooLarge };

  // The median depth over 150, rounded to one digit: 1 cm at 1.5 m.
  double ChooseVoxel() const {
    std::vector<float> depths;
    for (const MeshFrame& frame : Thin(frames_, 8)) {
      const DepthView view = ReadView(frame);
      for (int y = 0; y < view.inverse_depth.rows; y += 4) {
        for (int x = 0; x < view.inverse_depth.cols; x += 4) {
          if (const float inverse = view.inverse_depth.at<float>(y, x); inverse > 0.0F) {
            depths.push_back(1.0F / inverse);
          }
        }
      }
    }
    if (depths.empty()) {
      throw InputError(fmt::format(
          "the depth images have no usable depth up to {:g} m, expected a larger --max-depth",
          max_depth_));
    }
    const double wanted = static_cast<double>(Median(std::move(depths))) / 150.0;
    const double power = std::pow(10.0, std::floor(std::log10(wanted)));
    return power * std::round(wanted / power);
  }

  // The view of a frame, without things that move.
  DepthView ReadView(const MeshFrame& chosen) const {
    const FramePaths& frame = input_.sequence.frames[chosen.frame];
    const PinholeCamera& camera = input_.options.camera;
    cv::Mat depth = ReadDepth(input_, frame, runner_).clone();
    depth.setTo(0, seen_ == 0);
    if (input_.masks != nullptr) {
      std::vector<InstanceMask> masks = input_.masks->Read(names_[chosen.frame]).masks;
      FitMasks(input_.sequence.warps, ImageSide::kLeft, masks);
      ValidateMasks(masks, camera.width, camera.height);
      const cv::Mat moving =
          DynamicMask(masks, SplitNames(input_.options.tracking.dynamic_classes), depth.size());
      if (!moving.empty()) {
        depth.setTo(0, moving);
      }
    }
    DepthView view = MakeDepthView(depth, input_.options, max_depth_, rays_, runner_);
    view.colour = LoadColour(input_.sequence, frame, camera);
    view.cam_from_world =
        PosesOfRows(input_.options, Inverse(input_.poses[chosen.pose].world_from_cam),
                    VelocityAt(input_.poses, chosen.pose));
    return view;
  }

  Outcome AddViews(const std::function<bool(size_t, size_t)>& go_on) {
    scene_.emplace(voxel_, kTruncation * voxel_);
    objects_.clear();
    blocks_ = 0;
    for (size_t i = 0; i < frames_.size(); ++i) {
      const DepthView view = ReadView(frames_[i]);
      if (!AddTo(*scene_, view) || !AddToObjects(input_.poses[frames_[i].pose], view)) {
        return Outcome::kTooLarge;
      }
      if (!go_on(i + 1, frames_.size())) {
        return Outcome::kStopped;
      }
    }
    return Outcome::kDone;
  }

  bool AddTo(VoxelVolume& volume, const DepthView& view) {
    const size_t before = volume.blocks().size();
    const bool has_room = volume.Add(view, kMostBlocks - (blocks_ - before), runner_);
    blocks_ += volume.blocks().size() - before;
    return has_room;
  }

  // Adds a keyframe's view of its objects to their volumes.
  bool AddToObjects(const StampedPose& pose, const DepthView& view) {
    for (const ObjectResult& object : input_.objects) {
      const auto seen = std::ranges::find_if(object.observations, [&](const auto& observation) {
        return std::abs(observation.timestamp - pose.timestamp) <= kSameMoment;
      });
      if (seen == object.observations.end() || seen->contour.size() < 3) {
        continue;
      }
      auto [volume, is_new] = objects_.try_emplace(object.id, voxel_, kTruncation * voxel_);
      if (!AddTo(volume->second,
                 OnlyObject(view, object.ellipsoid, ObjectRegion(view, seen->contour)))) {
        return false;
      }
    }
    return true;
  }

  Mesh Extract() {
    Mesh mesh{.scene = WithoutSmallParts(ExtractSurface(*scene_, runner_), kLeastTriangles),
              .objects = {},
              .up = input_.up,
              .voxel = voxel_,
              .truncation = scene_->truncation(),
              .max_depth = max_depth_,
              .views = frames_.size()};
    for (const ObjectResult& object : input_.objects) {
      if (const auto volume = objects_.find(object.id); volume != objects_.end()) {
        SurfaceMesh surface =
            WithoutSmallParts(ExtractSurface(volume->second, runner_), kLeastTriangles);
        if (!surface.triangles.empty()) {
          mesh.objects.push_back({object.id, object.label, std::move(surface)});
        }
      }
    }
    return mesh;
  }

  const MeshInput& input_;
  const MeshOptions& options_;
  TaskRunner& runner_;
  std::vector<MeshFrame> frames_;
  std::vector<MaskFrame> names_;  // one per frame of the sequence, if there are masks
  cv::Mat rays_;
  cv::Mat seen_;            // CV_8UC1, 0 at raw pixels that are not used
  double max_depth_ = 0.0;  // m
  double voxel_ = 0.0;      // m
  size_t blocks_ = 0;       // of all volumes
  std::optional<VoxelVolume> scene_;
  std::map<ObjectId, VoxelVolume> objects_;
};

}  // namespace

std::optional<Mesh> MakeMesh(const MeshInput& input, const MeshOptions& options, TaskRunner& runner,
                             const std::function<bool(size_t done, size_t all)>& go_on) {
  return MeshMaker(input, options, runner).Make(go_on);
}

}  // namespace hullslam
