#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/check_shell.sh [FILE...]
#
# Runs shellcheck on the given shell scripts, by default on scripts/*.sh and .ci/run.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

help_if_asked "$@"
case "${1:-}" in
  -*) usage_error "unknown option \"$1\"" ;;
esac
command -v shellcheck >/dev/null || fail "shellcheck is not installed; run scripts/setup.sh"
[ $# -gt 0 ] || set -- "$top"/scripts/*.sh "$top/.ci/run"
exec shellcheck --external-sources --source-path=SCRIPTDIR "$@"
