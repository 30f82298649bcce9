// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "live_system.h"
#include "module.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

namespace fs = std::filesystem;

SystemOptions OptionsOf(const SettingsTable& settings, const std::string& mode,
                        const std::optional<fs::path>& vocabulary, uint64_t seed) {
  SystemOptions options = settings.options;
  options.sensor = Choose<SensorKind>("mode", mode,
                                      {{"rgbd", SensorKind::kRgbd},
                                       {"mono", SensorKind::kMonocular},
                                       {"stereo", SensorKind::kStereo}});
  options.seed = seed;
  if (vocabulary) {
    options.vocabulary = std::make_shared<const Vocabulary>(
        ReadVocabulary(*vocabulary == "default" ? FindDefaultVocabulary() : *vocabulary));
  }
  return options;
}

SystemStart MakeStart(const SystemOptions& options, const std::optional<fs::path>& map,
                      const std::string& session, bool localization) {
  SystemStart start{.session_name = session, .localization_only = localization};
  if (map) {
    start.map = ReadMap(*map, options, &ExitRequest());
  }
  return start;
}

// One mask for all images, as SystemOptions::mask_all; None: empty.
cv::Mat MaskOfAll(const py::object& pixels, const std::string& name, const PinholeCamera& camera) {
  if (pixels.is_none()) {
    return {};
  }
  return PlaneOf(pixels, name, {"bool", "uint8"}, {camera.width, camera.height}).image.clone();
}

std::unique_ptr<LiveSystem> MakeSystem(const SettingsTable& settings, const std::string& mode,
                                       const std::string& pipeline,
                                       const std::optional<fs::path>& vocabulary,
                                       const std::optional<fs::path>& map,
                                       const std::string& session, bool localization, uint64_t seed,
                                       const py::object& mask_all, const py::object& mask_all_right,
                                       const py::object& start_pose) {
  const PinholeCamera& camera = settings.options.camera;
  const cv::Mat mask = MaskOfAll(mask_all, "mask_all", camera);
  const cv::Mat right_mask = MaskOfAll(mask_all_right, "mask_all_right", camera);
  const auto first =
      start_pose.is_none() ? std::nullopt : std::optional(ToPose(start_pose, "start_pose"));
  const auto kind = Choose<PipelineKind>("pipeline", pipeline,
                                         {{"sequential", PipelineKind::kSequential},
                                          {"threaded", PipelineKind::kThreaded},
                                          {"realtime", PipelineKind::kRealtime}});
  return WithoutGil([&] {
    SystemOptions options = OptionsOf(settings, mode, vocabulary, seed);
    options.mask_all = mask;
    options.mask_all_right = right_mask;
    SystemStart start = MakeStart(options, map, session, localization);
    start.world_from_cam = first;
    return std::make_unique<LiveSystem>(options, kind, std::move(start));
  });
}

std::vector<InstanceMask> MasksOf(const MaskList* masks, const cv::Mat& image) {
  if (masks == nullptr) {
    return {};
  }
  if (!masks->size.empty() && masks->size != image.size()) {
    throw InputError("the masks are " + std::to_string(masks->size.width) + "x" +
                     std::to_string(masks->size.height) + " px, expected the size of the image, " +
                     std::to_string(image.cols) + "x" + std::to_string(image.rows) + " px");
  }
  return masks->masks;
}

std::optional<MotionPrior> MotionOf(const py::object& motion, const py::object& covariance) {
  if (motion.is_none() != covariance.is_none()) {
    throw InputError("motion and motion_covariance are given together or not at all");
  }
  if (motion.is_none()) {
    return std::nullopt;
  }
  MotionPrior prior{.cam_from_last_cam = ToPose(motion, "motion")};
  const py::array_t<double> numbers = ToNumbers(covariance, "motion_covariance", 2);
  if (numbers.shape(0) != 6 || numbers.shape(1) != 6) {
    throw InputError("motion_covariance has not the shape (6, 6)");
  }
  for (py::ssize_t i = 0; i < 36; ++i) {
    prior.covariance(i / 6, i % 6) = numbers.at(i / 6, i % 6);
  }
  return prior;
}

FrameReport Track(LiveSystem& system, const py::object& image, const py::object& depth,
                  const MaskList* masks, const py::object& right, const MaskList* masks_right,
                  double timestamp, const py::object& motion, const py::object& motion_covariance) {
  const PinholeCamera& camera = system.options().camera;
  const cv::Size size(camera.width, camera.height);
  const PixelSpan pixels = ImageOf(image, "the image", size);
  const PixelSpan depths = SpanOfDepth(depth, size);
  const PixelSpan rights = right.is_none() ? PixelSpan() : ImageOf(right, "the right image", size);
  std::vector<InstanceMask> instances = MasksOf(masks, pixels.image);
  std::vector<InstanceMask> in_right = MasksOf(masks_right, pixels.image);
  const std::optional<MotionPrior> prior = MotionOf(motion, motion_covariance);
  std::vector<std::string> warnings;
  FrameReport report = WithoutGil([&] {
    FrameReport of_frame = system.Track(timestamp, pixels.image, {depths.image, rights.image},
                                        std::move(instances), std::move(in_right), prior);
    warnings = system.TakeWarnings();
    return of_frame;
  });
  for (const std::string& warning : warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) {
      throw py::error_already_set();
    }
  }
  return report;
}

bool AddMasks(LiveSystem& system, int64_t frame, const MaskList& masks) {
  const PinholeCamera& camera = system.options().camera;
  if (!masks.size.empty() && masks.size != cv::Size(camera.width, camera.height)) {
    throw InputError("the masks are " + std::to_string(masks.size.width) + "x" +
                     std::to_string(masks.size.height) + " px, expected the size of the image, " +
                     std::to_string(camera.width) + "x" + std::to_string(camera.height) + " px");
  }
  return WithoutGil([&] { return system.AddMasks(frame, masks.masks); });
}

void NameObject(LiveSystem& system, int64_t id, const std::string& name) {
  WithoutGil([&] { system.EditObject(id, [&](System& s, ObjectId o) { s.NameObject(o, name); }); });
}

void LockObject(LiveSystem& system, int64_t id, bool locked) {
  WithoutGil(
      [&] { system.EditObject(id, [&](System& s, ObjectId o) { s.LockObject(o, locked); }); });
}

void SetObjectSize(LiveSystem& system, int64_t id, double longest_side) {
  WithoutGil([&] {
    system.EditObject(id, [&](System& s, ObjectId o) { s.SetObjectSize(o, longest_side); });
  });
}

void DeleteObject(LiveSystem& system, int64_t id) {
  WithoutGil([&] { system.EditObject(id, [](System& s, ObjectId o) { s.DeleteObject(o); }); });
}

// Signals such as Ctrl+C's are kept until the call returns, which they make return early.
void Finish(LiveSystem& system) {
  bool is_interrupted = false;
  WithoutGil([&] {
    system.Finish([&] {
      const py::gil_scoped_acquire gil;
      is_interrupted = is_interrupted || PyErr_CheckSignals() != 0;
      return is_interrupted || ExitRequest().IsRequested();
    });
  });
  if (is_interrupted) {
    throw py::error_already_set();
  }
}

void LoadMap(LiveSystem& system, const fs::path& path, const std::string& session,
             bool localization) {
  WithoutGil([&] { system.Restart(MakeStart(system.options(), path, session, localization)); });
}

void SaveMap(const LiveSystem& system, const fs::path& path) {
  WithoutGil([&] {
    const auto map = system.Get([](const System& s) { return s.map(); });
    if (map == nullptr) {
      throw InputError(path.string() + ": there is no map yet, because no keyframe was made");
    }
    WriteMap(path, *map, MapSettingsOf(system.options()));
  });
}

template <typename Read>
auto Get(const LiveSystem& system, const Read& read) {
  return WithoutGil([&] { return system.Get(read); });
}

MapView MapOf(const LiveSystem& system) {
  auto map = Get(system, [](const System& s) { return s.map(); });
  return {.map = map != nullptr ? std::move(map) : std::make_shared<const Map>(),
          .camera = system.options().camera};
}

py::dict TimesOf(const LiveSystem& system) {
  const StageTimes stages = Get(system, [](const System& s) { return s.times(); });
  py::dict times;
  for (const auto& [stage, samples] : stages.samples()) {
    times[py::str(stage)] =
        py::array_t<double>(static_cast<py::ssize_t>(samples.size()), samples.data());
  }
  return times;
}

py::dict CountsOf(const LiveSystem& system) {
  const ObjectCounts counts = Get(system, [](const System& s) { return s.object_counts(); });
  py::dict result;
  result["detections"] = counts.detections;
  result["frames_with_masks"] = counts.frames_with_masks;
  result["frames_without_masks"] = counts.frames_without_masks;
  result["rejections"] = counts.rejections;
  return result;
}

void BindProperties(py::class_<LiveSystem>& system) {
  system
      .def_property_readonly("map", &MapOf,
                             "A snapshot: Map. It is empty before the first keyframe.")
      .def_property_readonly(
          "trajectory",
          [](const LiveSystem& s) {
            return PoseList{Get(s, [](const System& system) { return system.trajectory(); })};
          },
          "The poses of all tracked frames in the current map: Trajectory.")
      .def_property(
          "localization",
          [](const LiveSystem& s) {
            return Get(s, [](const System& system) { return system.is_localization_only(); });
          },
          [](LiveSystem& s, bool is_on) { WithoutGil([&] { s.SetLocalizationOnly(is_on); }); },
          "Whether poses are found in the map without adding keyframes to it. May be switched\n"
          "between two frames, once there is a map.")
      .def_property_readonly(
          "times", &TimesOf,
          "The durations of each stage, ms: dict of (calls,) arrays. `frame` is\n"
          "building a frame, `pose` tracking it, and `track` the sum of the two.")
      .def_property_readonly("object_counts", &CountsOf,
                             "Numbers of detections and of frames with and without masks, and the\n"
                             "numbers of rejected masks and objects by reason: dict.");
}

}  // namespace

void BindSystem(py::module_& module) {
  BindTrackResult(module);
  py::class_<LiveSystem> system(
      module, "System",
      "SLAM as one object: images in, poses and map out.\n\n"
      "Calls from several threads take turns. The global interpreter lock is released while a\n"
      "call works.");
  system
      .def(py::init(&MakeSystem), py::arg("settings"), py::arg("mode") = "rgbd", py::kw_only(),
           py::arg("pipeline") = "sequential", py::arg("vocabulary") = fs::path("default"),
           py::arg("map") = py::none(), py::arg("session") = "", py::arg("localization") = false,
           py::arg("seed") = 0, py::arg("mask_all") = py::none(),
           py::arg("mask_all_right") = py::none(), py::arg("start_pose") = py::none(),
           "settings: Settings. mode: 'rgbd', 'mono' for a camera without depth, or 'stereo' for\n"
           "a rectified pair of cameras, whose left one the settings describe with Camera.bf.\n"
           "pipeline: 'sequential' gives the same bits every time; 'threaded' maps in a thread of\n"
           "its own; 'realtime' never waits for it, for live cameras.\n"
           "vocabulary: path of a vocabulary of visual words for loops and relocalisation;\n"
           "'default': the one that comes with HullSLAM; None: none.\n"
           "map: path of a map of earlier runs to go on with. session: the name of this run in\n"
           "the map. localization: True to find poses in `map` without changing it.\n"
           "seed: seed of all random choices.\n"
           "mask_all, mask_all_right: (height, width) bool or uint8, or None: pixels that are 0\n"
           "are ignored in all images, or in all right images of a stereo camera.\n"
           "start_pose: (4, 4) world_from_cam of the first image of a new map, m, or None: the\n"
           "world is the frame of this camera.")
      .def("track", &Track, py::arg("image"), py::arg("depth") = py::none(),
           py::arg("masks") = py::none(), py::kw_only(), py::arg("right") = py::none(),
           py::arg("masks_right") = py::none(), py::arg("timestamp"),
           py::arg("motion") = py::none(), py::arg("motion_covariance") = py::none(),
           "Finds the pose of the camera in the next frame: TrackResult.\n\n"
           "image: (height, width) uint8, or (height, width, 3 or 4) with blue first, as OpenCV\n"
           "reads images (red first with the setting Camera.RGB). It is copied only if its rows\n"
           "are not contiguous, as in image[:, ::-1], and must not be changed meanwhile.\n"
           "depth: (height, width) uint16 in units of 1 / DepthMapFactor metres, or float32 in\n"
           "metres, registered to the image; 0 or not finite where it is not known. Only in the\n"
           "mode 'rgbd'.\n"
           "masks: Masks of the objects in the image, or None.\n"
           "right: the right image, as `image`, rectified with it. Only in the mode 'stereo'.\n"
           "masks_right: Masks of the objects in the right image, or None.\n"
           "timestamp: s, larger than in the frame before.\n"
           "motion: (4, 4) cam_from_last_cam since the frame before, m, by wheels or an inertial\n"
           "sensor, or None. Not in the mode 'mono'.\n"
           "motion_covariance: (6, 6) of its error (rotation in rad, translation in m, in the\n"
           "axes of the camera now): positive definite.\n"
           "Raises InputError for anything else, also for pairs that are swapped, the same or not\n"
           "rectified, and for float32 depth that cannot be metres; a refused frame changes\n"
           "nothing. Warns of input that can be used but hardly is what was meant.")
      .def(
          "await_masks",
          [](LiveSystem& s, bool is_on) { WithoutGil([&] { s.AwaitMasks(is_on); }); },
          py::arg("is_on"),
          "From now on, frames that are tracked without masks await masks by add_masks(): a\n"
          "keyframe of such a frame says nothing about objects until then. reset() switches\n"
          "this off.")
      .def("add_masks", &AddMasks, py::arg("frame"), py::arg("masks"),
           "Adds the masks of a frame (TrackResult.frame) that were made after it was tracked, at\n"
           "most 2 s of time stamps later. If they show an object that is not mapped and no\n"
           "keyframe with masks is near in time, it becomes a keyframe unless it is one. Returns\n"
           "False for a frame that awaits no masks (any more).")
      .def("name_object", &NameObject, py::arg("id"), py::arg("name"),
           "Gives an object of the map (MapObject.id) a name of at most 100 bytes of UTF-8, which\n"
           "saved maps keep; '' removes it. May be called between two frames, also with a loaded\n"
           "map and with `localization`; with threads, the map shows it a little later. Raises\n"
           "InputError after finish(), for an unknown object and for another name.")
      .def("lock_object", &LockObject, py::arg("id"), py::arg("locked") = true,
           "Locks an object: it keeps its shape, its place relative to the world around it and\n"
           "its id, whatever is seen; a candidate is mapped first. May be called and raises as\n"
           "name_object().")
      .def("set_object_size", &SetObjectSize, py::arg("id"), py::arg("longest_side"),
           "Says how long the longest side of an object is, 0.001 to 100 m. Saved maps keep it; 0\n"
           "takes it back. A monocular map then gets the metre as its unit, as with\n"
           "objects.sizes, from this moment on if the object has been seen often enough. May be\n"
           "called and raises as name_object().")
      .def("delete_object", &DeleteObject, py::arg("id"),
           "Removes an object and its observations. Later masks of the thing may be mapped as a\n"
           "new object. May be called and raises as name_object().")
      .def("finish", &Finish,
           "Waits until all keyframes are in the map, adjusts the whole map, and computes the\n"
           "poses of all frames again. Ctrl+C ends it early.")
      .def(
          "reset", [](LiveSystem& s) { WithoutGil([&] { s.Reset(); }); },
          "Begins a new run as after construction, also after finish().")
      .def(
          "save_map", &SaveMap, py::arg("path"),
          "Writes the map to a file (docs/maps.md), also during a run. Raises InputError if there\n"
          "is no keyframe yet or the file cannot be written.")
      .def("load_map", &LoadMap, py::arg("path"), py::kw_only(), py::arg("session") = "",
           py::arg("localization") = false,
           "Ends this run without finishing it and begins a new one that goes on with a map of\n"
           "earlier runs. Raises InputError if the map was made with other settings; then the\n"
           "run goes on.");
  BindProperties(system);
}

}  // namespace hullslam::python
