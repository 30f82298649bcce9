#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/download_icl.sh [--to DIR] [--base URL] [--checksums FILE] [--max-size GB] SEQUENCE...
#
# Downloads sequences of ICL-NUIM, in the package of PNG images that is like TUM RGB-D, and unpacks
# each into DIR/<archive's name>, from where rgbd_icl and mono_icl read it. SEQUENCE is for example
# office_traj0, living_room_traj2, or living_room_traj2n for the one with noise. traj0_frei_png, the
# archive's own name, is office_traj0. An interrupted download continues where it stopped. A
# sequence that exists already is not downloaded again.
#
#   --to DIR          folder for the sequences (default: the working directory)
#   --base URL        address of the archives; the true trajectories are in its folder VaFRIC
#                     (default: https://www.doc.ic.ac.uk/~ahanda)
#   --checksums FILE  SHA-256 sums of archives, in the form of sha256sum. An archive that is listed
#                     is compared, the sum of any other is added to FILE. Without this option,
#                     archives are compared with scripts/icl_sha256.txt, and nothing is added.
#   --max-size GB     largest size of an unpacked sequence (default: 20)
#
# Exit codes: 0 done, 1 a download failed or an archive was refused, 2 bad usage.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
. "$(dirname "${BASH_SOURCE[0]}")/download_common.sh"

# Prints the name of an archive without its ending. Those of the office have no prefix.
plain_name() {
  local name=${1%_frei_png}
  name=${name#office_}
  [[ "$name" =~ ^(living_room_)?traj[0-3]n?$ ]] ||
    usage_error "\"$1\" is not a sequence of ICL-NUIM; expected office_traj0 to office_traj3 or \
living_room_traj0 to living_room_traj3, with n at the end for those with noise"
  printf '%s_frei_png' "$name"
}

folder_of() {
  printf '%s' "$1"
}

# Adds the true trajectory to the unpacked sequence $1, unless it has one.
complete() {
  local truth=${name%_frei_png}
  truth=${truth/living_room_traj/livingRoom}.gt.freiburg
  compgen -G "$1/*.gt.freiburg" >/dev/null || download "$base/VaFRIC/$truth" "$1/$truth"
}

# The archives have no folder of their own: rgb, depth and associations.txt are at the top.
fetch() {
  local name=$1 folder=$2
  fetch_sequence "$folder.tar.gz" "$base/$folder.tar.gz" "" "$folder" "a sequence of ICL-NUIM" \
    rgb depth associations.txt
  printf '%s: %d pairs of images\n' "$PWD/$folder" "$(grep -c . "$folder/associations.txt")"
}

base=https://www.doc.ic.ac.uk/~ahanda
# shellcheck disable=SC2034  # download_all uses it
checksums=$top/scripts/icl_sha256.txt
download_all "$@"
