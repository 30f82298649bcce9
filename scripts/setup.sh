#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/setup.sh
#
# Installs the Debian 12 packages that Thirdparty/apt-packages.txt lists, as root or with sudo. Does
# nothing if all of them are installed.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

list="$top/Thirdparty/apt-packages.txt"

# On another system than Debian 12 a note is printed, but the script goes on: the system may have
# all packages.
check_system() {
  local system="unknown" name="an unknown system"
  if [ -r /etc/os-release ]; then
    system=$(. /etc/os-release && printf '%s %s' "${ID:-}" "${VERSION_ID:-}")
    name=$(. /etc/os-release && printf '%s' "${PRETTY_NAME:-${ID:-unknown}}")
  fi
  if [ "$system" != "debian 12" ]; then
    printf 'note: HullSLAM is built and tested on Debian 12; this is %s. ' "$name" >&2
    printf 'CMake will check the versions of the libraries.\n' >&2
  fi
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "dpkg-query or apt-get is missing; install the equivalents of the packages in $list by hand"
  fi
}

read_packages() {
  sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$list"
}

# Prints those packages from stdin that are not installed.
missing_packages() {
  local package status
  while read -r package; do
    status=$(dpkg-query -W -f='[${db:Status-Status}]' "$package" 2>/dev/null || true)
    [[ "$status" == *"[installed]"* ]] || printf '%s\n' "$package"
  done
}

install_packages() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "not root and sudo is missing; run as root: apt-get install --no-install-recommends $*"
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update || fail "apt-get update failed"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "$@" || fail "apt-get could not install: $*"
}

read_no_arguments "$@"
[ -r "$list" ] || fail "cannot read $list"
check_system
mapfile -t missing < <(read_packages | missing_packages)
if [ "${#missing[@]}" -eq 0 ]; then
  printf 'All %d packages are installed.\n' "$(read_packages | wc -l)"
else
  printf 'Installing: %s\n' "${missing[*]}"
  install_packages "${missing[@]}"
fi
