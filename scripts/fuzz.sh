#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/fuzz.sh SECONDS [READER]...
#
# Builds the fuzz targets with the preset fuzz (libFuzzer, AddressSanitizer, UBSan) and runs each for
# SECONDS: all of them, or the given READERs (the names of the folders in tests/fuzz/corpus). As
# many run at the same time as the computer has processors. Prints the executions of each.
#
# The exit code is 1 if there is a finding. Its input is then in build/fuzz/findings/READER. New
# inputs that reach new code are kept in build/fuzz/corpus/READER and used again.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$top"

seconds=
readers=()
while [ $# -gt 0 ]; do
  help_if_asked "$1"
  case "$1" in
    -*) usage_error "unknown argument \"$1\"" ;;
    *)
      if [ -z "$seconds" ]; then
        seconds="$1"
      else
        [ -d "tests/fuzz/corpus/$1" ] || usage_error "no reader \"$1\" in tests/fuzz/corpus"
        readers+=("$1")
      fi
      shift
      ;;
  esac
done
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || usage_error "SECONDS is \"$seconds\"; expected an integer > 0"
if [ "${#readers[@]}" -eq 0 ]; then
  for folder in tests/fuzz/corpus/*/; do
    readers+=("$(basename "$folder")")
  done
fi

step "build"
cmake --preset fuzz
cmake --build --preset fuzz -j "$(nproc)"

step "fuzz"
build=$top/build/fuzz

# Limits: 25 s and 2 GB for an input, 200 kB for its length.
run_reader() {
  local reader="$1" code=0
  mkdir -p "$build/corpus/$reader" "$build/findings/$reader"
  "$build/bin/fuzz_$reader" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=2048 \
    -max_len=200000 -print_final_stats=1 -artifact_prefix="$build/findings/$reader/" \
    "$build/corpus/$reader" "$top/tests/fuzz/corpus/$reader" >"$build/$reader.log" 2>&1 || code=$?
  local executions
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$reader.log")
  if [ "$code" -eq 0 ]; then
    printf '%-14s %10s executions\n' "$reader" "${executions:-?}"
  else
    printf '%-14s finding, see %s\n' "$reader" "$build/$reader.log"
    return 1
  fi
}
export -f run_reader
export build top seconds
printf '%s\n' "${readers[@]}" | xargs -P "$(nproc)" -I{} bash -c 'run_reader {}' || exit 1
