#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/performance.sh SEQUENCE [MASKS]
#
# Builds and measures speed and memory, and prints all figures: every program in bench/, and then
# runs of rgbd_tum on SEQUENCE (a folder in TUM's format), without MASKS and with them: threaded in
# real time, threaded as fast as possible, and sequential. The time of cv::ORB on images of SEQUENCE
# is measured before and after each run, and the time of tracking is printed as a multiple of it,
# because times of different computers cannot be compared. The runs are in build/performance.
#
# No other program should run on the computer at the same time.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

help_if_asked "$@"
case "${1:-}" in
  "") usage_error "SEQUENCE is missing" ;;
  -*) usage_error "unknown option \"$1\"" ;;
esac
[ $# -le 2 ] || usage_error "unknown argument \"$3\""
[ -f "$1/rgb.txt" ] || usage_error "$1: there is no rgb.txt in it"
sequence=$(realpath "$1")
masks=
if [ $# -eq 2 ]; then
  [ -e "$2" ] || usage_error "$2: there is no such file or folder"
  masks=$(realpath "$2")
fi
cd "$top"
bin=build/release/bin
results=build/performance

step "build"
cmake --preset release
benches=()
for source in bench/*_bench.cc; do
  benches+=("$(basename "$source" .cc)")
done
cmake --build --preset release -j "$(nproc)" --target rgbd_tum "${benches[@]}"
mkdir -p "$results"

# Twenty images, evenly chosen.
mapfile -t images < <(awk '!/^#/ {print $2}' "$sequence/rgb.txt" |
  awk -v folder="$sequence" '{name[NR] = folder "/" $1}
    END {for (i = 0; i < 20; ++i) print name[1 + int(i * NR / 20)]}')

for bench in "${benches[@]}"; do
  step "$bench"
  case "$bench" in
    extraction_bench) "$bin/$bench" "${images[@]}" ;;
    loop_bench | place_bench) echo "measures recognition, not time; its source says how to run it" ;;
    *) "$bin/$bench" ;;
  esac
done

# measure NAME [OPTION...]: a run between two measurements of cv::ORB.
measure() {
  local name="$1"
  shift
  local yardstick=("$bin/extraction_bench" "${images[@]}" --benchmark_filter=BesideOrb
    --benchmark_format=json)
  "${yardstick[@]}" >"$results/$name.before.json" 2>/dev/null
  "$bin/rgbd_tum" "$sequence" "$@" --output "$results/$name" --quiet
  "${yardstick[@]}" >"$results/$name.after.json" 2>/dev/null
  /usr/bin/python3 - "$results/$name" <<'END'
import json
import sys

folder = sys.argv[1]
yardsticks = [json.load(open(f"{folder}.{when}.json"))["benchmarks"][0] for when in ("before", "after")]
orb = sum(yardstick["orb_ms"] for yardstick in yardsticks) / 2
summary = json.load(open(f"{folder}/summary.json"))
timing = summary["timing"]
track = timing["track_ms"]
print(f"tracking: median {track['median']:.2f} ms = {track['median'] / orb:.2f} x cv::ORB ({orb:.2f} ms), "
      f"p95 {track['p95']:.2f} ms = {track['p95'] / track['median']:.2f} x median")
print(f"whole run: {timing['frames_per_second']:.1f} frames/s, {summary['memory']['peak_mb']:.0f} MB, "
      f"{summary['map']['keyframes']} keyframes, ATE {summary['trajectory']['ate_rmse_m'] or 0:.4f} m")
for stage, times in timing["stages_ms"].items():
    print(f"  {stage:26} median {times['median']:8.2f}  p95 {times['p95']:8.2f}  max {times['max']:8.2f} ms")
END
}

for with in "" ${masks:+masks}; do
  options=()
  if [ -n "$with" ]; then
    options=(--masks "$masks")
  fi
  step "real time, threaded${with:+, with masks}"
  measure "realtime${with:+_masks}" --threaded --realtime "${options[@]}"
  step "as fast as possible, threaded${with:+, with masks}"
  measure "threaded${with:+_masks}" --threaded "${options[@]}"
  step "sequential${with:+, with masks}"
  measure "sequential${with:+_masks}" "${options[@]}"
done
