#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/check_packages.sh [FOLDER]
#
# Installs the packages of FOLDER (build/packages by default) in a bare Debian 12 and runs the demo
# there, without this source tree. Needs root and mmdebstrap. The root file system is removed at the
# end.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

folder=$top/build/packages
read_folder "$@"
command -v mmdebstrap >/dev/null || fail "mmdebstrap is missing; apt-get install mmdebstrap"
[ "$(id -u)" -eq 0 ] || fail "needs root, for the root file system of the bare Debian"

root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
printf '== bare Debian 12 with the packages\n'
# shellcheck disable=SC2016  # mmdebstrap's own shell expands $1, the root folder
mmdebstrap --variant=apt --include=ca-certificates \
  --customize-hook='mkdir -p "$1/packages"' \
  --customize-hook="copy-in $folder/*.deb /packages" \
  --customize-hook='chroot "$1" sh -c "apt-get update -q && apt-get install -y -q --no-install-recommends /packages/*.deb"' \
  bookworm "$root/debian"

printf '== demo\n'
chroot "$root/debian" sh -c 'cd /tmp && hullslam-demo demo'
for file in run/report.html run/trajectory.txt run/run.png; do
  [ -s "$root/debian/tmp/demo/$file" ] || fail "the demo has not written $file"
done
sha256sum "$root/debian/tmp/demo/run/trajectory.txt" | cut -d " " -f 1
printf 'The packages work in a bare Debian 12.\n'
