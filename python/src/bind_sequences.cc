// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "hullslam/datasets/dataset.h"
#include "hullslam/datasets/input_checks.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/sequences/tum_sequence.h"
#include "module.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

// The frames of a data set and the camera that their images must fit.
struct FrameList {
  ImageSequence sequence;
  std::vector<MaskFrame> names;
  PinholeCamera camera;
  SensorKind sensor = SensorKind::kRgbd;
  std::vector<std::string> notes = {};  // what was found, if open() has found it
  std::mutex loading;                   // ImageSequence::load is called by one thread at a time
};

constexpr std::array<std::pair<const char*, SensorKind>, 3> kModes = {
    {{"rgbd", SensorKind::kRgbd},
     {"mono", SensorKind::kMonocular},
     {"stereo", SensorKind::kStereo}}};

struct SequenceFrame {
  ImageInput input;
  std::string name;
};

// The mask files of the frames of a sequence.
struct MaskFiles {
  std::unique_ptr<const MaskSource> source;
  std::vector<MaskFrame> frames;
  cv::Size size;                 // of the images as read
  std::vector<ImageWarp> warps;  // ImageSequence::warps
};

// Python's rule for indices: negative ones count from the end.
size_t ToIndex(py::ssize_t index, size_t count) {
  const auto size = static_cast<py::ssize_t>(count);
  if (index < -size || index >= size) {
    throw py::index_error("there are " + std::to_string(count) + " frames");
  }
  return static_cast<size_t>(index < 0 ? index + size : index);
}

// The iterator that Python makes for every class with indices.
py::object Iterate(const py::object& list) {
  return py::reinterpret_steal<py::object>(PySeqIter_New(list.ptr()));
}

std::unique_ptr<FrameList> MakeList(ImageSequence sequence, const SettingsTable& settings) {
  auto list = std::make_unique<FrameList>();
  list->names = MaskFrames(sequence);
  list->sequence = std::move(sequence);
  list->camera = settings.options.camera;
  return list;
}

std::unique_ptr<FrameList> OpenTum(const std::filesystem::path& folder,
                                   const SettingsTable& settings, bool depth,
                                   const std::optional<std::filesystem::path>& associations) {
  return WithoutGil([&] {
    return MakeList(
        OpenTumSequence(folder, {.associations = associations.value_or(std::filesystem::path()),
                                 .use_depth = depth,
                                 .frames_per_second = settings.options.frames_per_second}),
        settings);
  });
}

std::unique_ptr<FrameList> OpenIcl(const std::filesystem::path& folder,
                                   const SettingsTable& settings, bool depth) {
  return WithoutGil([&] {
    const SystemOptions& options = settings.options;
    return MakeList(
        OpenIclSequence(folder, options.camera, options.depth, {.use_depth = depth}).images,
        settings);
  });
}

std::unique_ptr<FrameList> OpenEuroc(const std::filesystem::path& folder,
                                     const SettingsTable& settings) {
  return WithoutGil([&] { return MakeList(OpenEurocSequence(folder).images, settings); });
}

std::unique_ptr<FrameList> OpenImages(const std::filesystem::path& path,
                                      const SettingsTable& settings, std::optional<double> fps) {
  return WithoutGil(
      [&] { return MakeList(OpenImageStream(path, {.frames_per_second = fps}).images, settings); });
}

// The images of whatever is at the path, as they are stored.
std::unique_ptr<FrameList> OpenStored(const std::filesystem::path& path) {
  return WithoutGil([&] { return MakeList(hullslam::OpenImages(path), {}); });
}

// What open() in __init__.py returns, whose arguments it has.
std::pair<std::unique_ptr<FrameList>, SettingsTable> OpenAny(
    const std::filesystem::path& path, const std::optional<std::filesystem::path>& settings,
    const std::optional<std::string>& mode, const std::string& preset,
    const std::vector<std::string>& overrides, const DatasetChoices& choices) {
  std::optional<SensorKind> sensor;
  if (mode) {
    sensor = Choose<SensorKind>("mode", *mode, {kModes.begin(), kModes.end()});
  }
  return WithoutGil([&] {
    const FoundDataset found = FindDataset(path, sensor);
    OpenedDataset opened =
        OpenDataset(*found.dataset, {.path = path,
                                     .sensor = found.sensor,
                                     .settings = settings.value_or(std::filesystem::path()),
                                     .preset = preset,
                                     .overrides = overrides,
                                     .choices = choices});
    SettingsTable table{.options = std::move(opened.settings.options),
                        .warnings = std::move(opened.settings.notes.warnings)};
    std::unique_ptr<FrameList> list = MakeList(std::move(opened.sequence), table);
    list->sensor = found.sensor;
    list->notes = std::move(opened.notes);
    list->notes.insert(list->notes.begin(), found.note);
    return std::pair(std::move(list), std::move(table));
  });
}

SequenceFrame Load(FrameList& list, py::ssize_t index) {
  const size_t i = ToIndex(index, list.sequence.frames.size());
  return WithoutGil([&] {
    const std::lock_guard lock(list.loading);
    return SequenceFrame{list.sequence.load(list.sequence.frames[i], list.camera),
                         list.names[i].stem};
  });
}

cv::Mat LoadColour(FrameList& list, py::ssize_t index) {
  const size_t i = ToIndex(index, list.sequence.frames.size());
  return WithoutGil([&] {
    const std::lock_guard lock(list.loading);
    return list.sequence.load_colour(list.sequence.frames[i]);
  });
}

MaskFiles OpenMaskFiles(const std::filesystem::path& path, const FrameList& list,
                        const std::string& format) {
  return WithoutGil([&] {
    MaskFiles files{.source = nullptr,
                    .frames = list.names,
                    .size = SizeAsRead(list.sequence, list.camera),
                    .warps = list.sequence.warps};
    files.source = OpenMasks({path, format, files.size.width, files.size.height}, files.frames);
    return files;
  });
}

MaskList ReadMasks(const MaskFiles& files, py::ssize_t index) {
  const size_t i = ToIndex(index, files.frames.size());
  return WithoutGil([&] {
    MaskList list{.masks = files.source->Read(files.frames[i]).masks, .size = files.size};
    if (!files.warps.empty()) {
      FitMasks(files.warps, ImageSide::kLeft, list.masks);
      list.size = {};
    }
    return list;
  });
}

std::vector<std::string> CheckInput(FrameList& list, const SettingsTable& settings,
                                    const MaskFiles* masks) {
  return WithoutGil([&] {
    const std::lock_guard lock(list.loading);
    std::vector<std::string> warnings = CheckDepth(list.sequence, list.camera);
    const auto add = [&](const std::vector<std::string>& more) {
      warnings.insert(warnings.end(), more.begin(), more.end());
    };
    const auto read = [&](size_t frame) {
      return masks == nullptr ? std::vector<InstanceMask>()
                              : masks->source->Read(masks->frames.at(frame)).masks;
    };
    add(CheckMaskPlaces(list.sequence, list.camera, read));
    add(CheckClasses(settings.options, [&] {
      std::set<std::string> labels;
      for (size_t frame = 0; frame < list.names.size(); ++frame) {
        for (const InstanceMask& mask : read(frame)) {
          labels.insert(mask.label);
        }
      }
      return labels;
    }));
    return warnings;
  });
}

void BindFrame(py::module_& module) {
  py::class_<SequenceFrame>(module, "SequenceFrame", "One decoded frame of a sequence.")
      .def_property_readonly(
          "timestamp", [](const SequenceFrame& f) { return f.input.timestamp; }, "Time stamp, s.")
      .def_readonly("name", &SequenceFrame::name,
                    "The name of the colour image without folder and extension.")
      .def_property_readonly(
          "image", [](const SequenceFrame& f) { return ToArray(f.input.grey); },
          "(height, width) uint8, grey.")
      .def_property_readonly(
          "depth",
          [](const SequenceFrame& f) -> py::object {
            return f.input.depth.empty() ? py::object(py::none()) : ToArray(f.input.depth);
          },
          "(height, width) uint16 in units of 1 / DepthMapFactor metres, or float32 in metres;\n"
          "None without depth.")
      .def_property_readonly(
          "right",
          [](const SequenceFrame& f) -> py::object {
            return f.input.right.empty() ? py::object(py::none()) : ToArray(f.input.right);
          },
          "(height, width) uint8, the right image of a stereo camera, rectified as `image`; None\n"
          "without one.");
}

}  // namespace

void BindSequences(py::module_& module) {
  BindFrame(module);
  py::class_<FrameList>(module, "ImageSequence",
                        "The frames of a data set, which are decoded one by one.")
      .def("__len__", [](const FrameList& list) { return list.sequence.frames.size(); })
      .def("__getitem__", &Load, py::arg("index"),
           "Decodes a frame. Raises InputError for an image that is broken or does not have the\n"
           "size of the settings.")
      .def("__iter__", [](const py::object& list) { return Iterate(list); })
      .def(
          "colour",
          [](FrameList& list, py::ssize_t index) { return ToArray(LoadColour(list, index)); },
          py::arg("index"),
          "Decodes the image of a frame in colour: (height, width, 3) uint8, blue first.")
      .def_property_readonly(
          "names",
          [](const FrameList& list) {
            std::vector<std::string> names;
            for (const MaskFrame& frame : list.names) {
              names.push_back(frame.stem);
            }
            return names;
          },
          "The name of each image without folder and extension, as SequenceFrame.name: list of "
          "str.")
      .def_property_readonly(
          "files",
          [](const FrameList& list) {
            std::vector<std::filesystem::path> files;
            for (const FramePaths& frame : list.sequence.frames) {
              files.push_back(frame.image);
            }
            return files;
          },
          "The file of each image: list of pathlib.Path. Images of a video or a recording have\n"
          "none, only a name.")
      .def_property_readonly(
          "timestamps",
          [](const FrameList& list) {
            py::array_t<double> stamps(static_cast<py::ssize_t>(list.sequence.frames.size()));
            for (size_t i = 0; i < list.sequence.frames.size(); ++i) {
              stamps.mutable_data()[i] = list.sequence.frames[i].timestamp;
            }
            return stamps;
          },
          "(N,) float64, s.")
      .def_property_readonly(
          "mode",
          [](const FrameList& list) {
            return std::ranges::find(kModes, list.sensor,
                                     &std::pair<const char*, SensorKind>::second)
                ->first;
          },
          "'rgbd', 'mono' or 'stereo': the mode of a System for these frames, as open() has\n"
          "found it.")
      .def_readonly("notes", &FrameList::notes,
                    "What open() has found: list of str; empty without it.")
      .def_property_readonly(
          "warnings", [](const FrameList& list) { return list.sequence.warnings; },
          "Faults in the files that do not end a run: list of str.")
      .def("check", &CheckInput, py::arg("settings"), py::arg("masks") = py::none(),
           "What can be used but is probably not what was meant: list of str. Depth that is not\n"
           "registered to the colour images, masks (MaskFiles) of other images, classes in the\n"
           "settings that no mask has. Decodes a few frames. Raises InputError for masks of\n"
           "rectified images.")
      .def_property_readonly(
          "groundtruth",
          [](const FrameList& list) -> std::optional<PoseList> {
            std::optional<Trajectory> truth = ReadGroundtruth(list.sequence);
            return truth ? std::optional(PoseList{std::move(*truth)}) : std::nullopt;
          },
          "The true Trajectory; None if the data set has none.");
  module.def("open_dataset", &OpenAny, py::arg("path"), py::arg("settings"), py::arg("mode"),
             py::arg("preset"), py::arg("overrides"), py::arg("choices"),
             "hullslam.open() without its conveniences.");
  module.def("open_tum", &OpenTum, py::arg("folder"), py::arg("settings"), py::kw_only(),
             py::arg("depth") = true, py::arg("associations") = py::none(),
             "Opens a sequence in TUM's format (docs/datasets.md).\n\n"
             "depth: False for a monocular run, whose frames have no depth.\n"
             "associations: a file of pairs of images; None: they are paired by time.\n"
             "Raises InputError with file and line for whatever is wrong with the folder.");
  module.def("open_icl", &OpenIcl, py::arg("folder"), py::arg("settings"), py::kw_only(),
             py::arg("depth") = true,
             "Opens a sequence of ICL-NUIM, with the settings of config/ICL.yaml.\n\n"
             "depth: False for a monocular run, whose frames have no depth.");
  module.def("open_euroc", &OpenEuroc, py::arg("folder"), py::arg("settings"),
             "Opens the left camera of a sequence of EuRoC. Its settings are from\n"
             "Settings(folder / 'mav0/cam0/sensor.yaml').");
  module.def(
      "open_stored_images", &OpenStored, py::arg("path"),
      "Opens the images of whatever is at a path, as hullslam segment does: a sequence of any\n"
      "kind, of a stereo camera its left images, a recording, a video or a folder. They come\n"
      "as they are stored, and without a camera: only `names`, `files` and `colour` can be used.");
  module.def("open_images", &OpenImages, py::arg("path"), py::arg("settings"), py::kw_only(),
             py::arg("fps") = py::none(),
             "Opens a video or a folder of images without depth. Frames of a video must be read\n"
             "in order.\n\n"
             "fps: frames per second; None: the time stamps of the video, 30 for a folder.");
  py::class_<MaskFiles>(module, "MaskFiles", "The mask files of a sequence, read one by one.")
      .def("__len__", [](const MaskFiles& files) { return files.frames.size(); })
      .def("__getitem__", &ReadMasks, py::arg("index"),
           "The Masks of the frame with this index; empty if it has no file or entry.")
      .def("__iter__", [](const py::object& files) { return Iterate(files); })
      .def_property_readonly(
          "format", [](const MaskFiles& files) { return files.source->format(); },
          "The name of the format, such as 'yolo-seg'.");
  module.def("open_masks", &OpenMaskFiles, py::arg("path"), py::arg("sequence"), py::kw_only(),
             py::arg("format") = "",
             "Opens masks in one of the formats of docs/masks.md: a folder or a JSON file.\n\n"
             "sequence: the ImageSequence that the masks belong to; their files are found by the\n"
             "names of its images. format: one of the names of docs/masks.md; detected if empty.");
}

}  // namespace hullslam::python
