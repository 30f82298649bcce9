#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/check_format.sh
#
# Checks that every C++ file begins with the SPDX line and that clang-format would not change it. In
# a git checkout only tracked files are checked. `clang-format -i FILE` corrects the format.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$top"

spdx="// SPDX-License-Identifier: GPL-3.0-or-later"

list_files() {
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files -z -- '*.h' '*.cc'
  else
    find include src Examples tests bench python \( -name '*.h' -o -name '*.cc' \) -print0
  fi
}

read_no_arguments "$@"
command -v clang-format >/dev/null || fail "clang-format is not installed; run scripts/setup.sh"

files=()
bad=0
while IFS= read -r -d '' file; do
  [ -e "$file" ] || continue # deleted, but the deletion is not committed yet
  files+=("$file")
  IFS= read -r first <"$file" || first=""
  if [ "$first" != "$spdx" ]; then
    printf '%s:1: error: the first line is not "%s"\n' "$file" "$spdx" >&2
    bad=1
  fi
done < <(list_files)
[ "${#files[@]}" -gt 0 ] || fail "no C++ file found in $top"
printf '%s\0' "${files[@]}" | xargs -0 -n 16 -P 2 clang-format --dry-run --Werror || bad=1
exit "$bad"
