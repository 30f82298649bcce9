// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "hullslam/frame/frame.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/keyframe.h"
#include "hullslam/map/map.h"
#include "tracking/local_map_tracking.h"
#include "tracking/pose_refinement.h"
#include "tracking/tracking_context.h"

namespace hullslam {

// Remembers the keyframes that were requested only to join parts of the map, and what the camera
// saw then. Place recognition compares each of them with the other parts. A few keyframes of one
// view suffice to recognise a place. More of them would be compared in vain, and a camera that
// stands still would add keyframes for ever.
class JoinRequests {
 public:
  // Whether a frame with this pose may still be requested: the last keyframes were requested in
  // another view, or there were few of them. `estimate` has the landmarks of the frame.
  bool MayAskAgain(const Map& map, const Sensor& sensor, KeyframeId reference,
                   const PoseEstimate& estimate);
  void Add(const Map& map, KeyframeId reference, const PoseEstimate& estimate);

 private:
  bool IsSameView(const Map& map, const Sensor& sensor, KeyframeId reference,
                  const PoseEstimate& estimate) const;

  int requests_ = 0;  // in the view
  // The first frame in the view: its pose, and the landmarks that it showed.
  RelativePose pose_;
  std::vector<LandmarkId> landmarks_;
};

// Whether a keyframe of this session that is more than 30 s older shows what the frame shows from
// almost the same place, so that another keyframe would double its landmarks. It is one of those
// that are covisible with `reference`; the frame finds enough of its landmarks, and most of what
// the frame finds would be almost where the frame shows it, at almost the same distance. A camera
// that goes to and fro thus makes no keyframe where it has been before. A later session looks at
// all places anew, because things may have changed.
bool IsKnownView(const Map& map, const Sensor& sensor, const Frame& frame, FrameId first_of_session,
                 KeyframeId reference, const PoseEstimate& estimate);

// Whether the map is mature where the camera is, so that a keyframe would add nothing: three
// keyframes of this session that are more than a minute older show most of what the frame finds,
// from a similar direction and distance; or one of them does, and at least four such keyframes see
// each of nine tenths of the landmarks, so that a new one would be redundant at once
// (CullKeyframes). This does not hold at the end of a lap that is not yet tied to its beginning.
// The frame must also find at least half of the landmarks that should be visible (a place that is
// mapped by day and by lamp shows one half at a time), and all parts of the image show landmarks.
bool IsWellMapped(const Map& map, const Sensor& sensor, const Frame& frame,
                  FrameId first_of_session, const LocalTracking& tracking);

// Follows from frame to frame what differs from the map's objects: detections that show no mapped
// object, and objects of the reference keyframe where the depth image shows what is behind them.
// Where the map is mature, only such a change that lasts is a reason for a keyframe, not the
// mistakes of a detector, and only some times at one place: some things can never be mapped.
class LastingChanges {
 public:
  // To be called once per frame. `tracking` has the final pose. Returns how many changes were seen
  // in ten of the last frames (they may be missed twice in a row) and are still a reason.
  int Follow(const Frame& frame, const Map& map, const TrackingContext& context,
             const LocalTracking& tracking);
  // A keyframe is made of the last frame because of them.
  void NoteRequest();
  // Whether one of them has made a keyframe before and is still a reason. The landmarks of that
  // keyframe are new, so the map is not mature there any more, but the change needs another one.
  bool IsBeingLearnt();

 private:
  struct Change {
    ObjectId gone;             // invalid: something unknown
    std::string label;         // of the unknown thing
    Eigen::AlignedBox2d box;   // of the unknown thing, px
    Eigen::Vector3d position;  // m, world frame
    int seen = 0;              // number of frames
    int missed = 0;            // since it was seen last
  };
  struct Place {
    Eigen::Vector3d position;  // m, world frame
    int requests = 0;
    double time = 0.0;  // s, of the last one
  };
  void Note(const Change& change);
  Place* FindPlace(const Eigen::Vector3d& position);
  bool IsReason(const Change& change);

  std::vector<Change> changes_;
  std::vector<Place> places_;
  Eigen::Vector3d camera_ = Eigen::Vector3d::Zero();  // m, of the last frame
  double time_ = 0.0;                                 // s, of the last frame
};

}  // namespace hullslam
