// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/frame/built_frame.h"
#include "hullslam/frame/image_input.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/map/map.h"
#include "hullslam/map/messages.h"
#include "hullslam/objects/object_changes.h"
#include "hullslam/system/options.h"
#include "hullslam/util/cancellation.h"
#include "hullslam/util/eigen_alignment.h"
#include "hullslam/util/mapped_vector.h"
#include "hullslam/util/stage_timer.h"

namespace hullslam {

class FrameBuilder;
class Pipeline;
class TaskRunner;
struct RememberedFrame;

enum class PipelineKind {
  kSequential,  // reproducible to the bit
  kThreaded,    // mapping in a thread of its own; waits for it and leaves out no keyframe
  kRealtime,    // like kThreaded, but never waits; for live cameras
};

// The initial state of a System.
struct SystemStart {
  // The map of earlier sessions, for example from ReadMap(), made with the same camera, image
  // pyramid and vocabulary. Tracking is lost until a frame is found in it. A map without keyframes
  // stands for a new map.
  Map map = {};
  std::string session_name = {};  // for Map::sessions(), such as the name of the sequence
  // Whether poses are found in the map without changing anything in it.
  bool localization_only = false;
  // The pose of the camera in the first image of a new map, at a robot's dock for example; the
  // world is the frame of this camera if absent. A loaded map has a world of its own.
  std::optional<Rigid3> world_from_cam = {};
};

// The number of masks of a run that became detections, and the numbers of rejected ones by reason.
struct ObjectCounts {
  size_t detections = 0;
  size_t frames_with_masks = 0;
  size_t frames_without_masks = 0;
  // The number of masks that gave no detection ("mask_too_small") and of objects that were not
  // mapped ("low_overlap"), by reason.
  std::map<std::string, size_t> rejections;
};

// A part of a run that could not be joined to the rest: the camera was lost before it, and saw no
// earlier place again. Its poses have no known relation to the map.
struct LeftIsland {
  IslandId id;  // counted from 0, in the order in which the islands were begun
  std::shared_ptr<const Map> map;
  Trajectory trajectory;
};

// SLAM as one object: images in, poses and map out.
//
//   System system(options, PipelineKind::kSequential);
//   for each frame: TrackedFrame tracked = system.Track(timestamp, image, depth);  // or right
//   system.Finish();
//   Trajectory trajectory = system.trajectory();
//
// Its functions are called by one thread at a time, with two exceptions: Build() may be called by
// another thread meanwhile, and map() by any thread. docs/library.md has more about threads.
class System {
 public:
  // Throws InputError if SystemOptions::Validate does and for a map whose vocabulary has another
  // content than the options have, and CheckError for localization without a map and for a start
  // pose that is not finite. With a map of earlier sessions, frame and keyframe ids go on after the
  // largest of the map, and time stamps may begin anywhere.
  System(const SystemOptions& options, PipelineKind kind, SystemStart start = {});
  ~System();

  // `image` is CV_8UC1, or CV_8UC3 or CV_8UC4 in the order of cv::imread, blue first, unless
  // SystemOptions::rgb_order says that red is first. `second` is the depth image of an RGB-D
  // camera, as in ImageInput, or the right image of a stereo camera, which may have colours; a
  // monocular camera has none. The images of a stereo camera are rectified (StereoRectifier).
  // `masks` show the objects in the image, in its raw pixels (hullslam/frame/mask_image.h
  // makes them from images), `right_masks` those in the right image, which add lines of the same
  // objects. `motion` is that of the camera since the frame before, by wheels or an inertial sensor
  // (ImageInput). Throws InputError for images of another type or size, for depth in metres that
  // cannot be metres, for pairs that are swapped, twice the same or not rectified, for masks that
  // ValidateMasks() refuses, and for a motion of a monocular camera, with numbers that cannot be
  // used or from another stamp than that of the frame before. Time stamps (s) must increase; throws
  // CheckError otherwise. A refused frame changes nothing.
  //
  // If mapping fails, this call or a later one throws its exception, and so do all calls of Track
  // and Finish after it. map() and trajectory() then give the last published state.
  TrackedFrame Track(double timestamp, const cv::Mat& image, const cv::Mat& second = {},
                     std::vector<InstanceMask> masks = {},
                     std::vector<InstanceMask> right_masks = {},
                     const std::optional<MotionPrior>& motion = {});
  TrackedFrame Track(const ImageInput& image);

  // The two halves of Track(image). Building needs no map, so one other thread may build the next
  // frames while this one tracks, but not during Reset(). Frames must be tracked in the order in
  // which they were built; the results are then the same bits as with Track(image). Both throw
  // as Track(image) does.
  BuiltFrame Build(const ImageInput& image);
  TrackedFrame Track(BuiltFrame built);

  // From the next frame on, poses are found in the current map without requesting keyframes, or
  // keyframes are requested again. Keyframes that were requested before still enter the map. The
  // poses of frames that were only localised are not computed again in Finish. Throws CheckError if
  // it is switched on before the map has a keyframe. Reset() returns to the value of the start.
  void SetLocalizationOnly(bool is_on);
  bool is_localization_only() const { return is_localization_only_; }

  // For masks that are made more slowly than images come, as by a network in a run in real time:
  // from now on, a frame that is built without masks awaits those that AddMasks() brings. A
  // keyframe of such a frame says nothing about objects until then, instead of that there are none.
  // Reset() switches this off.
  void AwaitMasks(bool is_on);
  // Adds the masks of a frame that was tracked without, also an empty list if the image shows no
  // object. The keyframe of the frame gets their detections, and objects are mapped with them; if
  // there is none and the masks show objects, it is made now. Landmarks on things of the dynamic
  // classes are removed. To be called by the thread of Track. Returns false, and does nothing, for
  // a frame that awaits no masks (any more): its masks were added, or its time stamp is more than
  // kMaskPatience before the last frame. Throws as Track does.
  bool AddMasks(FrameId frame, std::vector<InstanceMask> masks);
  static constexpr double kMaskPatience = 2.0;  // s

  // Changes of one object by a user, also of a loaded map and when poses are only localised. A name
  // has at most 100 bytes of UTF-8 without control characters; an empty one removes it. A locked
  // object keeps its shape, its place relative to the world around it, and its id
  // (ObjectLandmark::IsFixed); it goes on to hold poses. A deleted object goes with its
  // observations, but later detections of the thing may be mapped as a new object. If the object
  // was fused into another one, that one is changed. In the pipelines with threads map() shows the
  // change when the mapper has come to it. To be called by the thread of Track. Throws InputError
  // for an object that map() does not have, for another name and for another size, and CheckError
  // after Finish.
  //
  // The size is that of the longest side, 0.001 to 100 m; 0 takes it back, and the unit of length
  // stays. For this object it counts before the size of its class in ObjectOptions::sizes. So a
  // monocular map gets the metre as its unit (the event kRescaled has the factor): at once if the
  // objects of known size have ten observations, or any in a loaded map without new keyframes; else
  // later, as with ObjectOptions::sizes. An object that is not mapped yet, or that cannot be
  // measured, waits. If sizes contradict each other, the median over all observations counts. In a
  // map of several islands, sizes wait until these are joined, or for the end. With another sensor
  // the size is only kept with the object.
  void NameObject(ObjectId object, std::string name);
  void LockObject(ObjectId object, bool is_locked);
  void SetObjectSize(ObjectId object, double longest_side);
  void DeleteObject(ObjectId object);

  // `callback` is called at the end of every Track, in the thread that called Track. It may call
  // the const functions of this object; frames() contains the frame already. An exception from it
  // is thrown by Track; the frame has been tracked then. Reset() keeps the callback.
  void SetFrameCallback(std::function<void(const FrameReport&)> callback) {
    frame_callback_ = std::move(callback);
  }

  // Waits until all keyframes are in the map. Then it adjusts the whole map if
  // mapping.final_bundle_adjustment is set. If the camera was lost, only the main island of the map
  // stays (Map::BeginIsland), and frames in other islands become lost; left_islands() has these.
  // Then the poses of the last 5000 frames are computed again from the final positions of their
  // landmarks, unless the map was fixed (Track does this with older ones, in the map of that time),
  // and lost frames and frames before a monocular map are localised in it. So frames() may change.
  // Track must not be called after Finish.
  //
  // If `cancellation` (may be null) is requested, the adjustment ends early with its current
  // result, and the frames that are left keep the poses that they have. `on_map` is called in this
  // thread after each iteration of the adjustment. `on_poses` is called after each frame whose pose
  // is computed again and then, counting from 1 again, after each frame that is localised.
  void Finish(const Cancellation* cancellation = nullptr, const ProgressCallback& on_map = {},
              const ProgressCallback& on_poses = {});

  // Sets the system back to its state after construction: with the map that it was given, without
  // frames, times and counts, and ready for Track, also after Finish. Ids begin again, and time
  // stamps may begin again. Waits until the mapper has ended. Snapshots that were taken before are
  // not changed.
  void Reset();

  // The newest snapshot; null before the first keyframe of a new map.
  std::shared_ptr<const Map> map() const;
  // One entry per call of Track. Valid until the next call of Track or Finish.
  std::span<const TrackedFrame> frames() const { return frames_.all(); }
  // All tracked frames in the main island of the current map.
  Trajectory trajectory() const;
  // Durations of the stages. "frame" is building a frame, "pose" is tracking it. With kRealtime,
  // "track" is the time from the begin of building to the pose, with all waiting in between. Else
  // frames may be built long before they are tracked, and "track" is the sum of the two. May be
  // called at any time by the thread that calls Track; complete after Finish.
  StageTimes times() const;
  // The changes of the objects of the map that the system began with, and the new objects
  // (docs/maps.md). Empty before Finish, and if no keyframe was added.
  const std::vector<ChangedObject>& object_changes() const;
  // The number of landmarks that were removed because later depth images show that nothing is there
  // any more. To be called after Finish.
  size_t contradicted_landmarks() const;
  // The islands that were not joined to the map, in the order in which they were begun. Empty
  // before Finish.
  const std::vector<LeftIsland>& left_islands() const { return left_islands_; }
  // What Finish() has done to the map. Before, each FrameReport has the events of its frame.
  const std::vector<MapEvent>& events_at_end() const { return events_at_end_; }
  // The number of mapped objects that have a known size (SetObjectSize, ObjectOptions::sizes) and
  // could be measured. If there are any, they set the unit of length of a monocular map to the
  // metre.
  size_t sized_objects() const;
  // The counts of masks. May be called like times().
  ObjectCounts object_counts() const;
  // Messages for the user about input that can be used, but hardly is what was meant: depth in
  // another unit, a baseline that no camera has, pairs that are not taken at the same time. More
  // come while frames are built; Reset() begins again.
  std::vector<std::string> warnings() const;
  // The options as they are used: if the depth images are smaller than the images, their
  // disparities are less precise (depth.disparity_sigma).
  const SystemOptions& options() const { return options_; }

 private:
  std::unique_ptr<Pipeline> BeginPipeline();
  std::unique_ptr<TaskRunner> MakeRunner();
  std::vector<MapEvent> TakeEvents();
  void KeepAwaiting(const FrameReport& report, std::shared_ptr<const DetectionInput> input);
  uint32_t OldestRevision() const;
  void Edit(ObjectEdit edit);
  void FitDepthError(const ImageInput& image);
  void CheckStamp(double timestamp) const;
  void CheckMotion(const Frame& frame) const;
  void CheckVectors(const Frame& frame);

  SystemOptions options_;
  const PipelineKind kind_;
  SystemStart start_;
  bool is_localization_only_ = false;
  size_t vector_length_ = 0;  // of InstanceMask::embedding in all masks; 0: not known yet
  Sensor sensor_;
  bool has_depth_size_ = false;  // FitDepthError() knows the size of the depth images
  std::unique_ptr<FrameBuilder> frame_builder_;
  std::unique_ptr<Pipeline> pipeline_;
  std::atomic<bool> is_tracking_ = false;
  std::unique_ptr<TaskRunner> runner_;  // for building frames
  std::atomic<bool> awaits_masks_ = false;
  // The frames that await masks, in the order of their stamps.
  struct AwaitingFrame {
    FrameId frame;
    double timestamp = 0.0;
    std::shared_ptr<const DetectionInput> input;
    std::optional<KeyframeRequest> request;  // as in LateDetections
  };
  std::deque<AwaitingFrame> awaiting_;
  DetectionCounts mask_counts_;  // counts of the tracked frames
  std::function<void(const FrameReport&)> frame_callback_;
  MappedVector<TrackedFrame> frames_;
  std::list<RememberedFrame> remembered_;  // until Finish, but not all frames of a long run
  std::vector<LeftIsland> left_islands_;
  std::shared_ptr<const Map> known_map_;  // whose events were told
  std::vector<MapEvent> events_at_end_;
  StageTimes times_;
};

}  // namespace hullslam
