#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/train_default_vocabulary.sh [--levels L] [--work DIR] FR1_XYZ OUT
#
# Trains the default vocabulary, Vocabulary/hullslam.bow, and writes it to OUT. FR1_XYZ is the folder
# of TUM's sequence freiburg1_xyz (scripts/download_tum.sh freiburg1_xyz). The programs must be built
# in build/release.
#
# Images: every 8th of the first half of FR1_XYZ, and every 6th of synthetic sequences of 300 frames
# with the scenes desk, room and lowtexture and the seeds 1000 to 1003. The other half of FR1_XYZ and
# other seeds are left for judging.
#
#   --levels L    levels of the tree (default: 5)
#   --work DIR    folder for the synthetic sequences (2 GB); those that exist in it are used again
#                 (default: a temporary folder)
#
# Exit codes: 0 done, 1 a program failed, 2 bad usage.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

help_if_asked "$@"

levels=5
work=
while [ $# -gt 2 ]; do
  case "$1" in
    --levels) levels=$2; shift 2 ;;
    --work) work=$2; shift 2 ;;
    *) usage_error "unknown argument: $1" ;;
  esac
done
[ $# -eq 2 ] || usage_error "expected FR1_XYZ and OUT"
[ -f "$1/rgb.txt" ] || usage_error "$1/rgb.txt is missing; expected the folder of a TUM sequence"
programs="$top/build/release/bin"
[ -x "$programs/hullslam" ] || fail "$programs/hullslam is missing; build it first"
if [ -z "$work" ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi

# The images of a sequence by time, one path per line.
images() {
  awk -v folder="$1" '!/^#/ && NF >= 2 { print folder "/" $2 }' "$1/rgb.txt"
}

half=$(($(images "$1" | wc -l) / 2))
mapfile -t list < <(images "$1" | awk -v half="$half" 'NR <= half && NR % 8 == 1')
for scene in desk room lowtexture; do
  for seed in 1000 1001 1002 1003; do
    sequence="$work/$scene$seed"
    [ -d "$sequence" ] ||
      "$programs/make_synthetic" "$sequence" --scene "$scene" --seed "$seed" --frames 300 --quiet
    mapfile -t -O "${#list[@]}" list < <(images "$sequence" | awk 'NR % 6 == 1')
  done
done
"$programs/hullslam" train-vocabulary "${list[@]}" --output "$2" --branching 10 --levels "$levels" --seed 0
