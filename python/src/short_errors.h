// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace hullslam::python {

// Makes all functions of the module name only the types of arguments that do not fit. pybind11
// prints their values, which are whole images here.
void ShortenTypeErrors(const pybind11::module_& module);

}  // namespace hullslam::python
