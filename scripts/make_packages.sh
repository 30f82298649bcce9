#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/make_packages.sh [FOLDER]
#
# Builds HullSLAM as the Debian packages that packaging/cpack.cmake lists.
# Installs what the build needs, builds in build/package, and copies the packages to FOLDER
# (build/packages by default).
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "$top"

folder=build/packages
read_folder "$@"

step "setup"
scripts/setup.sh

step "build"
cmake --preset release -B build/package -D CMAKE_INSTALL_PREFIX=/usr -D BUILD_SHARED_LIBS=ON \
  -D HULLSLAM_MAN_PAGES=ON -D HULLSLAM_BUILD_TESTS=OFF -D HULLSLAM_BUILD_BENCH=OFF
cmake --build build/package -j "$(nproc)"

step "package"
rm -f build/package/*.deb
(cd build/package && cpack)
mkdir -p "$folder"
rm -f "$folder"/*hullslam*.deb
mv build/package/*.deb "$folder"

step "done"
ls "$folder"
printf 'Install them with: apt-get install %s/*.deb\n' "$(readlink -f "$folder")"
