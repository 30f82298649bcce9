// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace hullslam::python {

// Each of these adds the classes and functions of one topic to the module.
void BindSettings(pybind11::module_& module);
void BindTrajectories(pybind11::module_& module);
void BindMasks(pybind11::module_& module);
void BindSegmenter(pybind11::module_& module);
void BindSequences(pybind11::module_& module);
void BindRuns(pybind11::module_& module);
void BindMap(pybind11::module_& module);
void BindTrackResult(pybind11::module_& module);
void BindSystem(pybind11::module_& module);
void BindKnownPoseMapper(pybind11::module_& module);

}  // namespace hullslam::python
