// SPDX-License-Identifier: GPL-3.0-or-later
#include "without_gil.h"

#include <atomic>

namespace hullslam::python {
namespace {

// One interpreter has one state, like the GIL itself.
Cancellation exit_request;
std::atomic<int> calls = 0;

}  // namespace

CallWithoutGil::CallWithoutGil() {
  if (exit_request.IsRequested()) {
    PyErr_SetNone(PyExc_SystemExit);
    throw pybind11::error_already_set();
  }
  ++calls;
}

CallWithoutGil::~CallWithoutGil() {
  --calls;
  calls.notify_all();
}

void EndCallsAtExit() {
  exit_request.Request();
  const pybind11::gil_scoped_release release;
  for (int running = calls; running > 0; running = calls) {
    calls.wait(running);
  }
}

const Cancellation& ExitRequest() { return exit_request; }

}  // namespace hullslam::python
