// SPDX-License-Identifier: GPL-3.0-or-later
#include "short_errors.h"

#include <string>

namespace hullslam::python {
namespace {

namespace py = pybind11;

// The C function of pybind11 that all its Python functions call.
PyCFunctionWithKeywords dispatcher = nullptr;

std::string TypesOf(PyObject* arguments, PyObject* keywords) {
  std::string types;
  const auto add = [&types](const std::string& name, const py::handle& value) {
    types += (types.empty() ? "" : ", ") + name + Py_TYPE(value.ptr())->tp_name;
  };
  for (const py::handle value : py::reinterpret_borrow<py::tuple>(arguments)) {
    add("", value);
  }
  if (keywords != nullptr) {
    for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(keywords)) {
      add(std::string(py::str(name)) + ": ", value);
    }
  }
  return types;
}

void ShortenError(PyObject* arguments, PyObject* keywords) {
  py::error_already_set error;
  std::string text = py::str(error.value());
  const size_t values = text.find("\nInvoked with: ");
  if (values == std::string::npos) {
    error.restore();
    return;
  }
  text.resize(values);
  text += "\nCalled with: " + TypesOf(arguments, keywords);
  PyErr_SetString(PyExc_TypeError, text.c_str());
}

PyObject* Call(PyObject* self, PyObject* arguments, PyObject* keywords) {
  PyObject* const result = dispatcher(self, arguments, keywords);
  if (result == nullptr && PyErr_ExceptionMatches(PyExc_TypeError) != 0) {
    ShortenError(arguments, keywords);
  }
  return result;
}

void Redirect(const py::object& member) {
  PyObject* const function = PyInstanceMethod_Check(member.ptr()) != 0
                                 ? PyInstanceMethod_GET_FUNCTION(member.ptr())
                                 : member.ptr();
  if (PyCFunction_Check(function) == 0) {
    return;
  }
  auto* const built_in = reinterpret_cast<PyCFunctionObject*>(function);
  if (built_in->m_self == nullptr || PyCapsule_CheckExact(built_in->m_self) == 0) {
    return;  // not of pybind11
  }
  const auto is = reinterpret_cast<PyCFunctionWithKeywords>(
      reinterpret_cast<void (*)()>(built_in->m_ml->ml_meth));
  if (is != &Call) {
    dispatcher = is;
    built_in->m_ml->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&Call));
  }
}

}  // namespace

void ShortenTypeErrors(const py::module_& module) {
  for (const auto& [name, member] : py::cast<py::dict>(module.attr("__dict__"))) {
    Redirect(py::reinterpret_borrow<py::object>(member));
    if (PyType_Check(member.ptr()) != 0) {
      for (const py::handle inner : py::list(member.attr("__dict__"))) {
        Redirect(member.attr(inner));
      }
    }
  }
}

}  // namespace hullslam::python
