// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "arrays.h"
#include "hullslam/segmentation/segmenter.h"
#include "hullslam/util/error.h"
#include "live_system.h"
#include "module.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

// hullslam.Segmenter. Calls of several threads wait for each other.
class SharedSegmenter {
 public:
  SharedSegmenter(const std::filesystem::path& network, const SegmenterOptions& options)
      : segmenter_(WithoutGil([&] { return std::make_unique<Segmenter>(network, options); })) {}

  MaskList Segment(const py::object& image) {
    const PixelSpan view = ImageOf(image, "the image", {});
    return WithoutGil(
        [&] { return MaskList{.masks = Segment(view.image), .size = view.image.size()}; });
  }
  std::vector<InstanceMask> Segment(const cv::Mat& image) {
    const std::lock_guard lock(mutex_);
    return segmenter_->Segment(image);
  }

  const std::vector<std::string>& class_names() const { return segmenter_->class_names(); }
  std::string Describe() const { return segmenter_->Describe(); }

 private:
  std::unique_ptr<Segmenter> segmenter_;
  std::mutex mutex_;
};

void Attach(const std::shared_ptr<SharedSegmenter>& segmenter, LiveSystem& system, bool wait) {
  const auto make = [segmenter](const cv::Mat& image) -> std::optional<std::vector<InstanceMask>> {
    try {
      return segmenter->Segment(image);
    } catch (const InputError&) {
      return std::nullopt;
    }
  };
  WithoutGil(
      [&] { system.MakeMasks(wait ? LateMasks::Pace::kWait : LateMasks::Pace::kNeverWait, make); });
}

std::shared_ptr<SharedSegmenter> MakeSegmenter(const std::filesystem::path& network,
                                               double min_score, std::vector<std::string> classes,
                                               const std::optional<std::filesystem::path>& names,
                                               int size, int threads, bool boxes) {
  return std::make_shared<SharedSegmenter>(
      network, SegmenterOptions{.min_score = min_score,
                                .classes = std::move(classes),
                                .names = names.value_or(std::filesystem::path()),
                                .size = size,
                                .threads = threads,
                                .use_boxes = boxes});
}

}  // namespace

void BindSegmenter(py::module_& module) {
  py::class_<SharedSegmenter, std::shared_ptr<SharedSegmenter>>(
      module, "Segmenter",
      "A network for instance segmentation (YOLOv8-seg, YOLO11-seg, YOLOv5-seg in ONNX)\n"
      "that makes the masks of images. docs/segmentation.md tells how to get one.")
      .def(py::init(&MakeSegmenter), py::arg("network"), py::kw_only(), py::arg("min_score") = 0.25,
           py::arg("classes") = std::vector<std::string>(), py::arg("names") = py::none(),
           py::arg("size") = 0, py::arg("threads") = 0, py::arg("boxes") = false,
           "min_score: least score of an instance. classes: only these; empty for all.\n"
           "names: a file with the name of one class per line, or None for those in the file\n"
           "of the network. size: longer side of the image that the network sees, px; 0 for\n"
           "the one of its input. threads: of OpenCV; 0 leaves them as they are. boxes: accept a\n"
           "network that finds no masks. Raises InputError for a file that is no such network.")
      .def("segment", py::overload_cast<const py::object&>(&SharedSegmenter::Segment),
           py::arg("image"),
           "The masks of an image, best score first. image: uint8, (height, width) or\n"
           "(height, width, 3 or 4) with blue first.")
      .def("attach", &Attach, py::arg("system"), py::kw_only(), py::arg("wait") = true,
           "From now on, makes the masks of the keyframes that this System tracks without masks,\n"
           "until it is reset. wait: track() waits for them; False: a thread makes them, and they\n"
           "are added when they are ready. An image that the network fails on gets none.")
      .def_property_readonly("class_names", &SharedSegmenter::class_names,
                             "The names of the classes by their numbers.")
      .def("__repr__", [](const SharedSegmenter& segmenter) {
        return "hullslam.Segmenter(" + segmenter.Describe() + ")";
      });
}

}  // namespace hullslam::python
