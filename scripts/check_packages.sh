#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/check_packages.sh [FOLDER]
#
# Installs the packages of FOLDER (build/packages by default) in a bare Debian 12. There, without this
# source tree, it runs the demo, maps the same sequence with the Python module, and compiles a program
# with pkg-config. Where scripts/make_packages.sh has left its programs, their trajectory must be the
# same bytes. Needs root and mmdebstrap. The root file system is removed at the end.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

folder=$top/build/packages
read_folder "$@"
command -v mmdebstrap >/dev/null || fail "mmdebstrap is missing; apt-get install mmdebstrap"
[ "$(id -u)" -eq 0 ] || fail "needs root, for the root file system of the bare Debian"

root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
debian=$root/debian
in_debian() {
  chroot "$debian" sh -euc "cd /tmp && $1"
}

printf '== bare Debian 12 with the packages\n'
export folder
# shellcheck disable=SC2016  # mmdebstrap's own shell expands the variables; $1 is the root folder
mmdebstrap --variant=apt --include=ca-certificates,g++,pkg-config \
  --customize-hook='mkdir "$1/packages" && cp "$folder"/*hullslam*.deb "$1/packages"' \
  --customize-hook='chroot "$1" sh -c "apt-get update -q && apt-get install -y -q --no-install-recommends /packages/*.deb"' \
  bookworm "$debian"

printf '== demo\n'
in_debian "hullslam-demo demo"
for file in report.html trajectory.txt run.png; do
  [ -s "$debian/tmp/demo/run/$file" ] || fail "the demo has not written $file"
done

for file in man/man1/hullslam-rgbd_tum.1 man/man1/hullslam.1 bash-completion/completions/hullslam-rgbd_tum \
  doc/hullslam/copyright; do
  [ -s "$debian/usr/share/$file" ] || fail "/usr/share/$file is not in the packages"
done

printf '== Python\n'
cp "$top/Examples/library/02_rgbd_with_masks.py" "$top/Examples/library/01_minimal.cc" "$debian/tmp"
in_debian "/usr/bin/python3 02_rgbd_with_masks.py demo/desk demo/desk/masks python.txt"
cmp "$debian/tmp/python.txt" "$debian/tmp/demo/run/trajectory.txt"

printf '== pkg-config\n'
# shellcheck disable=SC2016  # the shell in Debian runs pkg-config
in_debian 'g++ 01_minimal.cc $(pkg-config --cflags --libs hullslam) -o minimal && ./minimal | tail -n 1'

bin=$top/build/package/bin
if [ -x "$bin/rgbd_tum" ]; then
  printf '== same bytes as outside\n'
  "$bin/rgbd_tum" "$debian/tmp/demo/desk" --masks "$debian/tmp/demo/desk/masks" \
    --output "$root/outside" --quiet
  cmp "$root/outside/trajectory.txt" "$debian/tmp/demo/run/trajectory.txt"
fi
printf 'The packages work in a bare Debian 12.\n'
