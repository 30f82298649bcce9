// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/util/id.h"

namespace hullslam::python {
namespace py = pybind11;

// Pixels of a numpy array. `image` does not own them, so `array` must live as long as `image`. It
// is the array of the caller if its layout fits, else a copy.
struct PixelSpan {
  py::array array;
  cv::Mat image;
};

// In the functions below, `size` is the camera's, which is checked before anything is copied;
// an empty size is not checked.

// A colour or grey image: uint8, of shape (height, width) or (height, width, 3 or 4). Throws
// InputError that starts with `name` for anything else.
PixelSpan ImageOf(const py::object& pixels, const std::string& name, cv::Size size);
// A depth image (height, width): uint16 in units of 1 / DepthMapFactor metres, or float32 in
// metres. None gives an empty image.
PixelSpan SpanOfDepth(const py::object& pixels, cv::Size size);
// An image of one channel (height, width) whose type has one of these names: "bool", "uint8" ...
PixelSpan PlaneOf(const py::object& pixels, const std::string& name,
                  const std::vector<std::string>& types, cv::Size size = {});
// The objects of a stack (count, height, width) of bool or uint8, one image per object.
struct StackSpan {
  py::list planes;  // arrays of the pixels of `images`, which they keep alive
  std::vector<cv::Mat> images;
};
StackSpan StackOf(const py::object& pixels, const std::string& name);

// An array that shares the pixels of the image and keeps them alive.
py::array ToArray(const cv::Mat& image);
// The homogeneous matrix (4, 4) of a transform.
py::array_t<double> ToArray(const Rigid3& b_from_a);
// (3,)
py::array_t<double> ToArray(const Eigen::Vector3d& vector);
// (count, 2)
py::array_t<double> ToArray(const std::vector<Eigen::Vector2d>& points);

// Numbers of the caller as doubles. Throws InputError that starts with `name` unless they have the
// expected number of dimensions and are finite.
py::array_t<double> ToNumbers(const py::object& numbers, const std::string& name, int dimensions);
// The rigid transform of a homogeneous matrix (4, 4), row by row. Throws InputError that starts
// with `name` if its upper left part is no rotation or its last row is not (0, 0, 0, 1).
Rigid3 ToPose(const double* matrix, const std::string& name);
// The same for an array of the caller, whose shape is checked.
Rigid3 ToPose(const py::object& matrix, const std::string& name);

// The number of an id for Python; -1 for an invalid one.
template <typename Tag>
int64_t ToNumber(Id<Tag> id) {
  return id.IsValid() ? static_cast<int64_t>(id.value) : -1;
}

}  // namespace hullslam::python
