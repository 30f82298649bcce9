#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/test.sh [--all] [--preset NAME]...
#
# Installs packages, builds and runs the tests with each of the given presets, one after the other.
# Without --all, the tests with the label "slow" are left out. NAME is release (default), debug, asan,
# tsan or tidy. The preset tidy runs clang-tidy on every file while it builds, and runs no tests.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$top"

presets=()
selection=(--label-exclude slow)
while [ $# -gt 0 ]; do
  help_if_asked "$1"
  case "$1" in
    --all)
      selection=()
      shift
      ;;
    --preset)
      case "${2:-}" in
        release | debug | asan | tsan | tidy) presets+=("$2") ;;
        *) usage_error "--preset is \"${2:-}\"; expected release, debug, asan, tsan or tidy" ;;
      esac
      shift 2
      ;;
    *) usage_error "unknown argument \"$1\"" ;;
  esac
done
[ "${#presets[@]}" -gt 0 ] || presets=(release)
jobs=$(nproc)

step "setup"
scripts/setup.sh
for preset in "${presets[@]}"; do
  step "configure ($preset)"
  cmake --preset "$preset"
  step "build ($preset)"
  cmake --build --preset "$preset" -j "$jobs"
  if [ "$preset" != tidy ]; then
    step "test ($preset)"
    ctest --preset "$preset" -j "$jobs" "${selection[@]}"
  fi
done
