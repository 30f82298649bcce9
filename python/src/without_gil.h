// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include "hullslam/util/cancellation.h"

namespace hullslam::python {

// Counts the calls that run without the global interpreter lock (GIL). It is made and destroyed
// with the GIL.
//
// When the interpreter exits, a thread that wants the GIL back is ended in the middle of C++ code,
// which ends the whole program with an error. So EndCallsAtExit() waits until all calls have the
// GIL again, and calls after it raise SystemExit, which ends their thread silently.
class CallWithoutGil {
 public:
  CallWithoutGil();
  ~CallWithoutGil();
  CallWithoutGil(const CallWithoutGil&) = delete;
  CallWithoutGil& operator=(const CallWithoutGil&) = delete;
};

// To be called at the exit of the interpreter, with the GIL: asks long calls to end early, and
// waits until all have ended.
void EndCallsAtExit();

// Is requested when the interpreter exits.
const Cancellation& ExitRequest();

// Runs `work` without the GIL, so that other threads of Python run meanwhile. `work` must not use
// any object of Python.
template <typename Work>
auto WithoutGil(const Work& work) {
  const CallWithoutGil call;
  const pybind11::gil_scoped_release release;
  return work();
}

}  // namespace hullslam::python
