// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "hullslam/util/error.h"
#include "images/image_file.h"

namespace hullslam::python {
namespace {

std::string TypeName(const py::object& object) {
  return py::str(py::type::of(object).attr("__name__"));
}

std::string ShapeOf(const py::array& array) { return py::str(array.attr("shape")); }

// The caller's object as an array, which is the object itself if it is one.
py::array AsArray(const py::object& object, const std::string& name) {
  if (object.is_none()) {
    throw InputError(name +
                     " is None, expected a numpy array; cv2.imread gives None for a file that is "
                     "not there or cannot be read");
  }
  py::array array = py::array::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw InputError(name + " is a " + TypeName(object) + ", expected a numpy array");
  }
  return array;
}

std::string Join(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) {
    joined += (joined.empty() ? "" : " or ") + word;
  }
  return joined;
}

void CheckType(const py::array& array, const std::string& name,
               const std::vector<std::string>& types) {
  const bool is_known = std::ranges::any_of(
      types, [&](const std::string& type) { return array.dtype().equal(py::dtype(type)); });
  if (!is_known) {
    throw InputError(name + " has the type " + std::string(py::str(array.dtype())) + ", expected " +
                     Join(types));
  }
}

int DepthOf(const py::array& array) {
  switch (array.dtype().kind()) {
    case 'f':
      return CV_32F;
    case 'i':
      return CV_32S;
    default:
      return array.itemsize() == 2 ? CV_16U : CV_8U;
  }
}

// Whether OpenCV can read the array where it is: the pixels of a row follow one another, and rows
// lie at a constant distance, one below the other.
bool HasImageLayout(const py::array& array, int channels) {
  const py::ssize_t pixel = array.itemsize() * channels;
  const bool is_aligned = (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
  const bool has_packed_channels =
      array.ndim() < 3 || channels == 1 || array.strides(2) == array.itemsize();
  const bool has_packed_rows = array.shape(1) == 1 || array.strides(1) == pixel;
  const bool has_rows = array.shape(0) == 1 || (array.strides(0) >= pixel * array.shape(1) &&
                                                array.strides(0) % array.itemsize() == 0);
  return is_aligned && has_packed_channels && has_packed_rows && has_rows;
}

// `array` has two or three dimensions.
PixelSpan View(py::array array, const std::string& name, cv::Size size = {}) {
  const auto height = static_cast<uint64_t>(array.shape(0));
  const auto width = static_cast<uint64_t>(array.shape(1));
  if (height < 1 || width < 1 || height > kMostImageSide || width > kMostImageSide ||
      height * width > kMostImagePixels) {
    throw InputError(fmt::format(
        "{} has the shape {}, expected a height and a width from 1 to {} px, and up to {} million "
        "px together",
        name, ShapeOf(array), kMostImageSide, kMostImagePixels / 1'000'000));
  }
  if (!size.empty() && (array.shape(0) != size.height || array.shape(1) != size.width)) {
    throw InputError(fmt::format("{} is {}x{} px, expected Camera.width x Camera.height, {}x{} px",
                                 name, width, height, size.width, size.height));
  }
  const int channels = array.ndim() == 3 ? static_cast<int>(array.shape(2)) : 1;
  if (!HasImageLayout(array, channels)) {
    constexpr int kAligned = py::detail::npy_api::NPY_ARRAY_ALIGNED_;
    array = py::array::ensure(array, int{py::array::c_style} | kAligned);
    if (!array) {
      throw py::error_already_set();
    }
  }
  const auto rows = static_cast<int>(array.shape(0));
  const auto step =
      static_cast<size_t>(rows > 1 ? array.strides(0) : py::ssize_t{cv::Mat::AUTO_STEP});
  // OpenCV only reads these pixels, which may belong to an array that must not be written.
  cv::Mat image(rows, static_cast<int>(array.shape(1)), CV_MAKETYPE(DepthOf(array), channels),
                const_cast<void*>(array.data()), step);
  return {std::move(array), std::move(image)};
}

}  // namespace

PixelSpan ImageOf(const py::object& pixels, const std::string& name, cv::Size size) {
  py::array array = AsArray(pixels, name);
  CheckType(array, name, {"uint8"});
  const bool is_grey = array.ndim() == 2;
  const bool is_colour = array.ndim() == 3 && (array.shape(2) == 3 || array.shape(2) == 4);
  if (!is_grey && !is_colour) {
    throw InputError(name + " has the shape " + ShapeOf(array) +
                     ", expected (height, width) or (height, width, 3 or 4)");
  }
  return View(std::move(array), name, size);
}

PixelSpan SpanOfDepth(const py::object& pixels, cv::Size size) {
  return pixels.is_none() ? PixelSpan()
                          : PlaneOf(pixels, "the depth image", {"uint16", "float32"}, size);
}

PixelSpan PlaneOf(const py::object& pixels, const std::string& name,
                  const std::vector<std::string>& types, cv::Size size) {
  py::array array = AsArray(pixels, name);
  CheckType(array, name, types);
  if (array.ndim() != 2) {
    throw InputError(name + " has the shape " + ShapeOf(array) + ", expected (height, width)");
  }
  return View(std::move(array), name, size);
}

StackSpan StackOf(const py::object& pixels, const std::string& name) {
  const py::array stack = AsArray(pixels, name);
  CheckType(stack, name, {"bool", "uint8"});
  if (stack.ndim() != 3) {
    throw InputError(name + " has the shape " + ShapeOf(stack) +
                     ", expected (objects, height, width)");
  }
  StackSpan view;
  py::list planes;  // each may be a copy of its own
  for (py::ssize_t i = 0; i < stack.shape(0); ++i) {
    PixelSpan plane = View(py::array(stack[py::int_(i)]), name);
    view.images.push_back(std::move(plane.image));
    planes.append(std::move(plane.array));
  }
  view.planes = std::move(planes);
  return view;
}

py::array ToArray(const cv::Mat& image) {
  const char* type = "uint8";
  if (image.depth() == CV_16U) {
    type = "uint16";
  } else if (image.depth() == CV_32F) {
    type = "float32";
  }
  const py::capsule owner(new cv::Mat(image),
                          [](void* pixels) { delete static_cast<cv::Mat*>(pixels); });
  std::vector<py::ssize_t> shape = {image.rows, image.cols};
  std::vector<py::ssize_t> steps = {static_cast<py::ssize_t>(image.step[0]),
                                    static_cast<py::ssize_t>(image.elemSize())};
  if (image.channels() > 1) {
    shape.push_back(image.channels());
    steps.push_back(static_cast<py::ssize_t>(image.elemSize1()));
  }
  return {py::dtype(type), shape, steps, image.data, owner};
}

py::array_t<double> ToArray(const Rigid3& b_from_a) {
  py::array_t<double> matrix({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> values(matrix.mutable_data());
  values.setIdentity();
  values.topRows<3>() = b_from_a.ToMatrix();
  return matrix;
}

py::array_t<double> ToArray(const Eigen::Vector3d& vector) {
  return py::array_t<double>(3, vector.data());
}

py::array_t<double> ToArray(const std::vector<Eigen::Vector2d>& points) {
  py::array_t<double> rows({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  double* value = rows.mutable_data();
  for (const Eigen::Vector2d& point : points) {
    *value++ = point.x();
    *value++ = point.y();
  }
  return rows;
}

py::array_t<double> ToNumbers(const py::object& numbers, const std::string& name, int dimensions) {
  py::array array = AsArray(numbers, name);
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw InputError(name + " has the type " + std::string(py::str(array.dtype())) +
                     ", expected numbers");
  }
  auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!values) {
    throw py::error_already_set();
  }
  if (values.ndim() != dimensions) {
    throw InputError(name + " has the shape " + ShapeOf(values) + ", expected " +
                     std::to_string(dimensions) + " dimension(s)");
  }
  if (!std::all_of(values.data(), values.data() + values.size(),
                   [](double value) { return std::isfinite(value); })) {
    throw InputError(name + " has a value that is not finite");
  }
  return values;
}

Rigid3 ToPose(const double* matrix, const std::string& name) {
  constexpr double kTolerance = 1e-3;  // allows for matrices of single precision
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> values(matrix);
  const Eigen::Matrix3d rotation = values.topLeftCorner<3, 3>();
  const bool is_rotation =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
          kTolerance &&
      rotation.determinant() > 0.0;
  if (!is_rotation) {
    throw InputError(name + " has no rotation in its upper left 3x3 part");
  }
  if (!values.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0), kTolerance)) {
    throw InputError(name + " has a last row other than 0 0 0 1");
  }
  return {Eigen::Quaterniond(rotation).normalized(), values.topRightCorner<3, 1>()};
}

Rigid3 ToPose(const py::object& matrix, const std::string& name) {
  const py::array_t<double> values = ToNumbers(matrix, name, 2);
  if (values.shape(0) != 4 || values.shape(1) != 4) {
    throw InputError(name + " has the shape " + ShapeOf(values) + ", expected (4, 4)");
  }
  return ToPose(values.data(), name);
}

}  // namespace hullslam::python
