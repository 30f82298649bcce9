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

void* RefuseUninitialised(size_t /*bytes*/) {
  throw pybind11::type_error("the object was made without __init__ and cannot be used");
}

// To read a member of an object that was made by __new__ alone, pybind11 makes memory for it whose
// content is undefined. Refuses that for all classes of the module.
void RefuseUninitialisedObjects(const pybind11::module_& module) {
  for (const auto& [name, member] : pybind11::cast<pybind11::dict>(module.attr("__dict__"))) {
    if (PyType_Check(member.ptr()) != 0) {
      auto* const type = reinterpret_cast<PyTypeObject*>(member.ptr());
      if (auto* const info = pybind11::detail::get_type_info(type); info != nullptr) {
        info->operator_new = &RefuseUninitialised;
      }
    }
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
  RefuseUninitialisedObjects(module);
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function([] {
    EndCallsAtExit();
    LiveSystem::CloseAll();
  }));
}

}  // namespace hullslam::python
