#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/run_demo.sh [FOLDER]
#
# The part of demo.sh after the build; installed as hullslam-demo. Renders the synthetic sequence
# FOLDER/desk (unless it exists), runs RGB-D SLAM on it with object masks, prints accuracy, times and
# the mapped objects, draws FOLDER/run/run.png and overlays.png, and prints where the report is.
# FOLDER is hullslam-demo by default.
set -euo pipefail
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/common.sh"

folder=hullslam-demo
read_folder "$@"

# The programs of the build, or of the installation, in which this script is in
# share/hullslam/scripts.
bin=$top/build/release/bin
if [ -x "$top/../../libexec/hullslam/rgbd_tum" ]; then
  bin=$top/../../libexec/hullslam
fi
sequence=$folder/desk
run=$folder/run

step "render $sequence"
if [ -d "$sequence" ]; then
  printf '%s exists already.\n' "$sequence"
else
  # The folder has another name until rendering is complete, so that a later run does not use the
  # incomplete sequence of an interrupted one.
  mkdir -p "$folder"
  rm -rf "$sequence.partial"
  "$bin/make_synthetic" "$sequence.partial" --scene desk
  mv "$sequence.partial" "$sequence"
fi

step "run"
"$bin/rgbd_tum" "$sequence" --masks "$sequence/masks" --output "$run" --report

step "compare boxes of the objects with the true bodies"
"$bin/hullslam" evaluate objects "$run" --truth "$sequence/groundtruth_objects.json" --upright

step "draw"
"$top/scripts/plot_run.py" "$run" --overlay 6

step "done"
printf 'Open the report in a browser: %s\n' "file://$(readlink -f "$run")/report.html"
