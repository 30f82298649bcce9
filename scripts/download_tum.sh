#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: scripts/download_tum.sh [--to DIR] [--base URL] SEQUENCE...
#
# Downloads sequences of the TUM RGB-D benchmark (CC BY 4.0) and unpacks each into
# DIR/rgbd_dataset_<name>. SEQUENCE is for example freiburg1_xyz, fr1/xyz or
# rgbd_dataset_freiburg1_xyz. An interrupted download continues where it stopped. A sequence that
# exists already is not downloaded again.
#
#   --to DIR    folder for the sequences (default: the working directory)
#   --base URL  address of the folders freiburg1, freiburg2 and freiburg3
#               (default: https://cvg.cit.tum.de/rgbd/dataset)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# Prints the name of a sequence in the form freiburg1_xyz, whichever accepted form was given.
plain_name() {
  local name=${1#rgbd_dataset_}
  name=${name/\//_}
  [[ "$name" == fr[123]_* ]] && name="freiburg${name#fr}"
  [[ "$name" =~ ^freiburg[123]_[a-z0-9_]+$ ]] ||
    usage_error "\"$1\" is not a TUM sequence; expected a name like freiburg1_xyz or fr1/xyz"
  printf '%s' "$name"
}

# The file is named *.part until the download is complete. If the server cannot resume a download
# (curl exit code 33) or reports that nothing is left to send (HTTP 416), all of it is requested
# again.
download() {
  local url=$1 file=$2 code=0 status
  local options=(--fail --location --show-error --connect-timeout 30 --retry 3 --output "$file.part")
  [ -t 2 ] && options+=(--progress-bar) || options+=(--silent)
  if [ -s "$file.part" ]; then
    printf 'Resuming %s\n' "$url"
    status=$(curl "${options[@]}" --write-out '%{http_code}' --continue-at - "$url") || code=$?
    if [ "$code" -eq 33 ] || [ "$status" = 416 ]; then
      rm -f "$file.part"
    elif [ "$code" -ne 0 ]; then
      fail "the download of $url was interrupted (curl: $code); run again to resume it"
    fi
  fi
  if [ ! -s "$file.part" ]; then
    printf 'Downloading %s\n' "$url"
    curl "${options[@]}" "$url" || fail "cannot download $url (curl: $?); run again to retry"
  fi
  mv "$file.part" "$file"
}

# Fails unless the archive contains only folders and plain files below the sequence's own folder.
check_archive() {
  local file=$1 folder=$2 names kinds
  if ! names=$(tar --list --gzip --absolute-names --file "$file" 2>/dev/null) ||
    ! kinds=$(LC_ALL=C tar --list --verbose --gzip --file "$file" 2>/dev/null | cut -c 1); then
    rm -f "$file"
    fail "$file was damaged and has been deleted; run again to download it again"
  fi
  if grep -qv '^[-d]' <<<"$kinds"; then
    fail "$file contains links or special files; it is not unpacked"
  fi
  if grep -Eqv "^(\./)?$folder(/|\$)" <<<"$names" || grep -Eq '(^|/)\.\.(/|$)' <<<"$names"; then
    fail "$file contains files outside $folder; it is not unpacked"
  fi
}

unpack() {
  local file=$1 folder=$2 work=$3 list
  check_archive "$file" "$folder"
  rm -rf "$work"
  mkdir "$work"
  tar --extract --gzip --no-same-owner --no-same-permissions --file "$file" --directory "$work" ||
    fail "cannot unpack $file into $work"
  for list in rgb.txt depth.txt groundtruth.txt; do
    [ -s "$work/$folder/$list" ] ||
      fail "$file is not a TUM RGB-D sequence: it has no $folder/$list"
  done
  mv "$work/$folder" "$folder"
  rm -rf "$work" "$file"
}

fetch() {
  local name=$1 folder="rgbd_dataset_$1"
  if [ -d "$folder" ]; then
    printf '%s exists already.\n' "$PWD/$folder"
    return
  fi
  [ -s "$folder.tgz" ] || download "$base/${name%%_*}/$folder.tgz" "$folder.tgz"
  unpack "$folder.tgz" "$folder" "$folder.unpacking"
  printf '%s: %d colour images\n' "$PWD/$folder" "$(grep -cv '^#' "$folder/rgb.txt")"
}

base=https://cvg.cit.tum.de/rgbd/dataset
to=.
names=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help)
      print_help
      exit 0
      ;;
    --to | --base)
      [ -n "${2:-}" ] || usage_error "$1 needs a value"
      [ "$1" = --to ] && to=$2 || base=${2%/}
      shift 2
      ;;
    -*) usage_error "unknown option \"$1\"" ;;
    *)
      name=$(plain_name "$1")
      names+=("$name")
      shift
      ;;
  esac
done
[ "${#names[@]}" -gt 0 ] || usage_error "no SEQUENCE is given"
command -v curl >/dev/null || fail "curl is not installed; run scripts/setup.sh"
mkdir -p "$to" && cd "$to" || fail "cannot use the folder $to"
for name in "${names[@]}"; do
  fetch "$name"
done
