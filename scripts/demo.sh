#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/demo.sh
#
# From a fresh clone to pictures: sets up, builds, renders the synthetic sequence build/demo/desk
# (once), runs RGB-D SLAM with its object masks, prints how exact and how quick it was and which
# objects it mapped, and draws build/demo/run/run.png and overlays.png.
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
  printf '%s is there already.\n' "$sequence"
else
  # Under another name until it is whole, so that an interrupted one is not taken for the sequence.
  mkdir -p build/demo
  rm -rf "$sequence.partial"
  "$bin/make_synthetic" "$sequence.partial" --scene desk
  mv "$sequence.partial" "$sequence"
fi

step "run"
"$bin/rgbd_tum" "$sequence" --masks "$sequence/masks" --output "$run"

step "objects, against the truth"
"$bin/evaluate" objects "$run" --groundtruth "$sequence/groundtruth_objects.json"

step "draw"
scripts/plot_run.py "$run" --groundtruth "$sequence/groundtruth.txt" --overlay 6 \
  --sequence "$sequence"
