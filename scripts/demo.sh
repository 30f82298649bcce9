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

case "${1:-}" in
  "") ;;
  -h | --help)
    print_help
    exit 0
    ;;
  *) usage_error "unknown argument \"$1\"" ;;
esac

bin=build/release/bin
sequence=build/demo/desk
run=build/demo/run

step "setup"
scripts/setup.sh

step "build"
cmake --preset release
cmake --build --preset release -j "$(nproc)" --target rgbd_tum evaluate make_synthetic

step "render $sequence"
if [ -d "$sequence" ]; then
  printf '%s exists already.\n' "$sequence"
else
  # The folder has another name until rendering is complete, so that a later run does not use the
  # incomplete sequence of an interrupted one.
  mkdir -p build/demo
  rm -rf "$sequence.partial"
  "$bin/make_synthetic" "$sequence.partial" --scene desk
  mv "$sequence.partial" "$sequence"
fi

step "run"
"$bin/rgbd_tum" "$sequence" --masks "$sequence/masks" --output "$run" --report

step "compare objects with ground truth"
"$bin/evaluate" objects "$run" --groundtruth "$sequence/groundtruth_objects.json"

step "draw"
scripts/plot_run.py "$run" --groundtruth "$sequence/groundtruth.txt" --overlay 6 \
  --sequence "$sequence"

step "done"
printf 'Open the report in a browser: %s\n' "file://$top/$run/report.html"
