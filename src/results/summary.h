// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/util/stage_timer.h"
#include "report/lost_frames.h"

namespace hullslam {

// The summary of a run, field by field as in `summary.json` (docs/outputs.md). A value that is not
// known, such as an error without ground truth, is absent here and null in the file.
struct TrajectorySummary {
  std::optional<double> ate_rmse_m = std::nullopt;
  std::string alignment = "se3";  // none, se3 or sim3
  std::optional<double> scale = std::nullopt;
  size_t pairs = 0;                  // pairs of an estimated and a true pose
  size_t frames = 0;                 // frames given to the run
  size_t tracked = 0;                // frames with a pose
  size_t lost = 0;                   // decoded frames without a pose
  std::string poses = "all frames";  // the poses that the errors refer to; or "keyframes"
  std::string pairing = "tum";       // the rule that pairs poses: tum or evo
  // Share of the sequence's frames (those that the run was asked for) that have a pose.
  std::optional<double> coverage = std::nullopt;
  std::optional<double> rpe_rmse_m = std::nullopt;  // over one second
  std::optional<double> rpe_rmse_deg = std::nullopt;
  size_t skipped = 0;                     // frames with a broken image
  size_t unpaired = 0;                    // colour images without depth
  std::vector<LostStretch> losses = {};   // where frames have no pose, in order of time
  std::vector<FrameStretch> unsure = {};  // where poses may be wrong, in order of time
};

// Mapped objects: means over the observations of each object, and then over the objects.
struct ObjectsSummary {
  size_t count = 0;                                     // mapped objects
  std::optional<double> siou_mean = std::nullopt;       // with the hull
  std::optional<double> siou_mask_mean = std::nullopt;  // with the contour
  std::optional<double> mtd_mean_m2 = std::nullopt;
  std::optional<double> tangent_mean_px = std::nullopt;
  size_t observations = 0;  // observations of mapped objects in keyframes
  size_t candidates = 0;    // objects that are not mapped at the end of the run
  size_t detections = 0;    // usable detections in all frames
  size_t frames_with_masks = 0;
  size_t frames_without_masks = 0;  // frames without a file of masks, or with an empty one
  std::map<std::string, size_t> rejections =
      {};  // numbers of rejected masks and objects, by reason
  // The numbers of objects that were seen again, moved and so on, by the names of ObjectChange.
  // Only for a run that went on with a map of earlier sessions.
  std::optional<std::map<std::string, size_t>> changes = std::nullopt;
};

// How a monocular run got its first map.
struct InitialisationSummary {
  std::optional<double> seconds = std::nullopt;  // from the first image to the map; absent: no map
  std::map<std::string, size_t> failures = {};   // frames that made no map, by reason
};

// An island of the map (Map::BeginIsland) at the end of a run.
struct IslandSummary {
  size_t number = 0;     // counted from 1, in the order in which the islands were begun
  bool is_main = false;  // it is the map of the run; the others could not be joined to it
  size_t keyframes = 0;
  size_t landmarks = 0;
  size_t frames = 0;                                     // with a pose in this island
  std::optional<double> first_timestamp = std::nullopt;  // s, of these frames
  std::optional<double> last_timestamp = std::nullopt;
  std::optional<double> ate_rmse_m = std::nullopt;  // after an alignment of its own
};

struct IslandsSummary {
  size_t begun = 0;                        // parts of the map, the first one included
  size_t joined = 0;                       // those that were joined to an older one
  std::vector<IslandSummary> at_end = {};  // the main one first
};

struct TimingSummary {
  TimeStatistics track_ms;
  std::map<std::string, TimeStatistics> stages_ms;
  double total_s = 0.0;
  double frames_per_second = 0.0;
};

struct MapSummary {
  size_t keyframes = 0;
  size_t landmarks = 0;
  size_t landmarks_at_infinity = 0;  // those whose distance is not known (located_landmarks.h)
  // Landmarks of the run that were removed because later depth images show that nothing is there.
  size_t contradicted_landmarks = 0;
  size_t loops = 0;
  size_t sessions = 0;  // runs that added keyframes
  // Median of the distances between keypoints and projected landmarks. Absent without a map.
  std::optional<double> reprojection_px = std::nullopt;
  // The number of objects of known size that determine the unit of length. Absent in RGB-D runs,
  // and without objects.sizes and objects of known size.
  std::optional<size_t> known_sizes = std::nullopt;
};

// A setting of a preset that another source has replaced.
struct PresetOverrideSummary {
  std::string key;
  std::string preset_value;
  std::string value;
  std::string source;  // FILE:LINE, the name of a calibration, or --set
};

// The network that made the masks of a run (--segment).
struct NetworkSummary {
  std::string path;
  std::string hash;                            // Segmenter::network_hash()
  std::optional<size_t> every = std::nullopt;  // --segment-every; absent in real time
  std::vector<std::string> classes = {};       // that it knows
  size_t images = 0;                           // that it was run on
  size_t failures = 0;                         // of these, the ones that it made no masks of
};

// One mask of all images.
struct MaskAllSummary {
  std::string path;
  double ignored = 0.0;  // share of the pixels
};

struct ProvenanceSummary {
  std::optional<std::string> program = std::nullopt;  // "rgbd_tum"
  std::optional<std::string> version = std::nullopt;
  std::optional<std::string> git = std::nullopt;
  std::optional<std::string> settings_hash = std::nullopt;
  std::optional<std::string> preset = std::nullopt;
  std::vector<PresetOverrideSummary> preset_overrides = {};
  uint64_t seed = 0;
  std::string pipeline = "sequential";              // or "threaded"
  std::optional<std::string> masks = std::nullopt;  // the path of --masks
  std::optional<std::string> masks_format = std::nullopt;
  std::optional<NetworkSummary> network = std::nullopt;  // absent without --segment
  std::optional<MaskAllSummary> mask_all = std::nullopt;
  std::optional<MaskAllSummary> mask_all_right = std::nullopt;
  std::optional<std::string> sequence = std::nullopt;
  std::optional<std::string> dataset = std::nullopt;         // ImageSequence::dataset
  std::map<std::string, std::string> sequence_choices = {};  // ImageSequence::choices
  std::optional<std::string> map = std::nullopt;             // the path of --save-map
  std::optional<std::string> loaded_map = std::nullopt;      // the path of --load-map
  bool interrupted = false;  // a signal ended the run before its end
  // The input that ended the run before its end, and what is wrong with it.
  std::optional<std::string> input_failure = std::nullopt;
};

struct RunSummary {
  TrajectorySummary trajectory;
  std::optional<InitialisationSummary> initialisation = std::nullopt;  // only of monocular runs
  std::optional<IslandsSummary> islands = std::nullopt;                // only of SLAM
  std::optional<ObjectsSummary> objects = std::nullopt;  // absent for a run without masks
  TimingSummary timing;
  double peak_memory_mb = 0.0;
  MapSummary map;
  ProvenanceSummary provenance;
  std::vector<std::string> files = {};  // names of the other files of the run
};

// JSON with the keys in the order of the structs.
nlohmann::ordered_json SummaryJson(const RunSummary& summary);
// The same as text, with a final line feed.
std::string FormatSummary(const RunSummary& summary);

// The statistics of each stage.
std::map<std::string, TimeStatistics> SummarizeStages(const StageTimes& times);

// Largest resident memory of this process up to now, MB (10^6 bytes).
double PeakMemoryMb();

}  // namespace hullslam
