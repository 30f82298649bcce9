// SPDX-License-Identifier: GPL-3.0-or-later
#include "module.h"

#include <array>
#include <string>
#include <utility>

#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "live_system.h"
#include "short_errors.h"
#include "without_gil.h"

namespace hullslam::python {
namespace {

// Messages of the library name the options of the programs. Those of Python name its arguments.
std::string NameArguments(std::string message) {
  static constexpr std::array<std::pair<const char*, const char*>, 11> kNames{{
      {"--settings FILE", "Settings(FILE)"},
      {"--vocabulary FILE|none", "vocabulary=FILE or None"},
      {"--fps N", "fps=N"},
      {"--fps", "fps"},
      {"--masks-format", "format"},
      {"--associations", "associations"},
      {"--preset", "preset"},
      {"--names FILE", "names=FILE"},
      {"--classes", "classes"},
      {"--min-score", "min_score"},
      {"--boxes", "boxes=True"},
  }};
  for (const auto& [option, argument] : kNames) {
    for (size_t at = message.find(option); at != std::string::npos; at = message.find(option)) {
      message.replace(at, std::string(option).size(), argument);
    }
  }
  return message;
}

void TranslateInputError(std::exception_ptr error) {
  try {
    if (error) {
      std::rethrow_exception(error);
    }
  } catch (const InputError& input_error) {
    const auto type = pybind11::module_::import("hullslam._core").attr("InputError");
    PyErr_SetString(type.ptr(), NameArguments(input_error.what()).c_str());
  }
}

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
  pybind11::register_exception_translator(TranslateInputError);
  pybind11::register_exception_translator(TranslateCancelled);
  BindSettings(module);
  BindTrajectories(module);
  BindMasks(module);
  BindSequences(module);
  BindRuns(module);
  BindMap(module);
  BindSystem(module);
  BindSegmenter(module);
  BindKnownPoseMapper(module);
  RefuseUninitialisedObjects(module);
  ShortenTypeErrors(module);
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function([] {
    EndCallsAtExit();
    LiveSystem::CloseAll();
  }));
}

}  // namespace hullslam::python
