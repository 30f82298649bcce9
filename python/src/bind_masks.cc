// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "hullslam/frame/mask_image.h"
#include "module.h"
#include "types.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

void CheckCount(const char* name, size_t count, size_t expected) {
  if (count != expected) {
    throw InputError(std::string(name) + " has " + std::to_string(count) +
                     " entries, expected one for each of the " + std::to_string(expected) +
                     " masks");
  }
}

// The scores of `count` masks, 1 where none are given.
std::vector<double> ScoresOf(std::optional<std::vector<double>> scores, size_t count) {
  if (!scores) {
    return std::vector<double>(count, 1.0);
  }
  CheckCount("scores", scores->size(), count);
  return std::move(*scores);
}

MaskList FromStack(const py::object& stack, const std::vector<std::string>& classes,
                   std::optional<std::vector<double>> given_scores) {
  const StackSpan view = StackOf(stack, "the stack of masks");
  const std::vector<cv::Mat>& images = view.images;
  CheckCount("classes", classes.size(), images.size());
  const std::vector<double> scores = ScoresOf(std::move(given_scores), images.size());
  return WithoutGil([&] {
    MaskList list;
    for (size_t i = 0; i < images.size(); ++i) {
      InstanceMask mask = MaskFromImage(images[i], classes[i], scores[i]);
      ValidateMasks({&mask, 1}, images[i].cols, images[i].rows);
      if (!mask.outlines.empty()) {
        list.masks.push_back(std::move(mask));
      }
    }
    if (!images.empty()) {
      list.size = images.front().size();
    }
    return list;
  });
}

MaskList FromLabels(const py::object& labels, const std::map<int, std::string>& classes,
                    const std::map<int, double>& scores) {
  const PixelSpan view = PlaneOf(labels, "the image of labels", {"uint8", "uint16", "int32"});
  std::map<int, InstanceClass> instances;
  for (const auto& [number, label] : classes) {
    const auto score = scores.find(number);
    instances[number] = {.label = label, .score = score != scores.end() ? score->second : 1.0};
  }
  return WithoutGil([&] {
    return MaskList{.masks = MasksFromLabels(view.image, instances), .size = view.image.size()};
  });
}

MaskList FromOutlines(const std::vector<py::object>& outlines,
                      const std::vector<std::string>& classes,
                      std::optional<std::vector<double>> given_scores) {
  CheckCount("classes", classes.size(), outlines.size());
  const std::vector<double> scores = ScoresOf(std::move(given_scores), outlines.size());
  MaskList list;
  for (size_t i = 0; i < outlines.size(); ++i) {
    const std::string name = "outline " + std::to_string(i);
    const py::array_t<double> points = ToNumbers(outlines[i], name, 2);
    if (points.shape(0) < 3 || points.shape(1) != 2) {
      throw InputError(name + " has the shape " + std::string(py::str(points.attr("shape"))) +
                       ", expected (3 or more points, 2)");
    }
    std::vector<Eigen::Vector2d> outline;
    for (py::ssize_t row = 0; row < points.shape(0); ++row) {
      outline.emplace_back(points.at(row, 0), points.at(row, 1));
    }
    list.masks.push_back({.label = classes[i], .score = scores[i], .outlines = {outline}});
  }
  return list;
}

py::list OutlinesOf(const MaskList& list) {
  py::list all;
  for (const InstanceMask& mask : list.masks) {
    py::list parts;
    for (const std::vector<Eigen::Vector2d>& outline : mask.outlines) {
      parts.append(ToArray(outline));
    }
    all.append(std::move(parts));
  }
  return all;
}

}  // namespace

void BindMasks(py::module_& module) {
  py::class_<MaskList>(
      module, "Masks",
      "The masks of the objects in one image, in its raw pixels. They are kept as\n"
      "outlines; masks without an area of 1 px^2 are left out.")
      .def(py::init(&FromStack), py::arg("stack"), py::arg("classes"),
           py::arg("scores") = py::none(),
           "stack: (N, height, width) bool or uint8, not 0 at the pixels of object i.\n"
           "classes: N names. scores: N numbers from 0 to 1, or None for 1.\n"
           "Raises InputError for another type, shape or number of entries.")
      .def_static(
          "from_labels", &FromLabels, py::arg("labels"), py::arg("classes"),
          py::arg("scores") = std::map<int, double>(),
          "labels: (height, width) uint8, uint16 or int32: the number of the instance that\n"
          "a pixel shows, or 0. classes: the name of each number. scores: its score.")
      .def_static("from_outlines", &FromOutlines, py::arg("outlines"), py::arg("classes"),
                  py::arg("scores") = py::none(),
                  "outlines: N arrays (points, 2) of raw pixels x, y; the centre of the first\n"
                  "pixel is (0, 0).")
      .def("__len__", [](const MaskList& list) { return list.masks.size(); })
      .def_property_readonly(
          "classes",
          [](const MaskList& list) {
            std::vector<std::string> classes;
            for (const InstanceMask& mask : list.masks) {
              classes.push_back(mask.label);
            }
            return classes;
          },
          "N names.")
      .def_property_readonly(
          "scores",
          [](const MaskList& list) {
            std::vector<double> scores;
            for (const InstanceMask& mask : list.masks) {
              scores.push_back(mask.score);
            }
            return scores;
          },
          "N numbers from 0 to 1.")
      .def_property_readonly("outlines", &OutlinesOf,
                             "For each mask the outlines of its parts, the largest first: arrays\n"
                             "(points, 2) of raw pixels.")
      .def("__repr__", [](const MaskList& list) {
        return "<hullslam.Masks of " + std::to_string(list.masks.size()) + " objects>";
      });
}

}  // namespace hullslam::python
