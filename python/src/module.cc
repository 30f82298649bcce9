// SPDX-License-Identifier: GPL-3.0-or-later
#include "module.h"

#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "live_system.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

// Reading a map is only cancelled when the interpreter exits.
void TranslateCancelled(std::exception_ptr error) {
  try {
    if (error) {
      std::rethrow_exception(error);
    }
  } catch (const ReadingCancelled&) {
    PyErr_SetNone(PyExc_SystemExit);
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = HULLSLAM_VERSION;
  // The documentation of this class is set in hullslam/__init__.py.
  pybind11::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  pybind11::register_exception_translator(TranslateCancelled);
  BindSettings(module);
  BindTrajectories(module);
  BindMasks(module);
  BindSequences(module);
  BindMap(module);
  BindSystem(module);
  BindKnownPoseMapper(module);
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function([] {
    EndCallsAtExit();
    LiveSystem::CloseAll();
  }));
}

}  // namespace hullslam::python
