#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/demo.sh
#
# Demonstrates HullSLAM from a fresh clone: installs packages, builds, renders the synthetic
# sequence build/demo/desk (unless it exists), and runs RGB-D SLAM on it with object masks. Then it
# prints accuracy, times and the mapped objects, draws build/demo/run/run.png and overlays.png, and
# prints where the report is, which a browser opens.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$top"

read_no_arguments "$@"

step "setup"
scripts/setup.sh

step "build"
cmake --preset release
cmake --build --preset release -j "$(nproc)" --target rgbd_tum hullslam_program make_synthetic

step "demo"
scripts/run_demo.sh build/demo
