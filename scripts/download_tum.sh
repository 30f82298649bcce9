#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/download_tum.sh [--to DIR] [--base URL] [--checksums FILE] [--max-size GB] SEQUENCE...
#
# Downloads sequences of the TUM RGB-D benchmark (CC BY 4.0) and unpacks each into
# DIR/rgbd_dataset_<name>. SEQUENCE is for example freiburg1_xyz, fr1/xyz or
# rgbd_dataset_freiburg1_xyz. An interrupted download continues where it stopped. A sequence that
# exists already is not downloaded again.
#
#   --to DIR          folder for the sequences (default: the working directory)
#   --base URL        address of the folders freiburg1, freiburg2 and freiburg3
#                     (default: https://cvg.cit.tum.de/rgbd/dataset)
#   --checksums FILE  SHA-256 sums of archives, in the form of sha256sum. An archive that is listed
#                     is compared, the sum of any other is added to FILE. Without this option,
#                     archives are compared with scripts/tum_sha256.txt, and nothing is added.
#   --max-size GB     largest size of an unpacked sequence (default: 20)
#
# Exit codes: 0 done, 1 a download failed or an archive was refused, 2 bad usage.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
. "$(dirname "${BASH_SOURCE[0]}")/download_common.sh"

# Prints the name of a sequence in the form freiburg1_xyz, whichever accepted form was given.
plain_name() {
  local name=${1#rgbd_dataset_}
  name=${name/\//_}
  [[ "$name" == fr[123]_* ]] && name="freiburg${name#fr}"
  [[ "$name" =~ ^freiburg[123]_[a-z0-9_]+$ ]] ||
    usage_error "\"$1\" is not a TUM sequence; expected a name like freiburg1_xyz or fr1/xyz"
  printf '%s' "$name"
}

folder_of() {
  printf 'rgbd_dataset_%s' "$1"
}

complete() { :; }

fetch() {
  local name=$1 folder=$2
  fetch_sequence "$folder.tgz" "$base/${name%%_*}/$folder.tgz" "$folder" "$folder" \
    "a TUM RGB-D sequence" rgb.txt depth.txt groundtruth.txt
  printf '%s: %d colour images\n' "$PWD/$folder" "$(grep -cv '^#' "$folder/rgb.txt")"
}

base=https://cvg.cit.tum.de/rgbd/dataset
# shellcheck disable=SC2034  # download_all uses it
checksums=$top/scripts/tum_sha256.txt
download_all "$@"
