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

# Fails with the reason why an archive is not unpacked. The archive stays on the disk.
refuse() {
  fail "$1: $2; it is not unpacked. The archive is kept: delete it to download it again"
}

# Compares the archive with the known checksum, or adds its checksum to the file of --checksums.
check_sum() {
  local file=$1 known sum
  sum=$(sha256sum -- "$file" | cut -d ' ' -f 1)
  known=$(sed -n "s/^\\([0-9a-f]\\{64\\}\\) [ *]$file\$/\\1/p" "$checksums" | head -n 1)
  if [ -z "$known" ]; then
    printf 'No checksum of %s is known; its SHA-256 is %s\n' "$file" "$sum"
    if [ "$records" = yes ]; then
      printf '%s  %s\n' "$sum" "$file" >>"$checksums"
    fi
  elif [ "$known" != "$sum" ]; then
    refuse "$PWD/$file" "its SHA-256 is $sum, but $checksums lists $known"
  fi
}

# Prints what is wrong with an archive, in one line; nothing if all is well. It must contain only
# folders and plain files below the sequence's own folder, and not be too large.
find_fault() {
  LC_ALL=C tar --list --verbose --numeric-owner --absolute-names --gzip --file "$1" 2>/dev/null |
    awk -v folder="$2" -v most="$max_size" '
      function report(text) { print text; reported = 1; exit }
      # kind and rights, owner, size, date, time, name; a name may contain blanks
      { name = $0; for (i = 1; i < 6; ++i) sub(/^ *[^ ]+ /, "", name); sub(/^\.\//, "", name) }
      !/^[-d]/ { report("it contains links or special files") }
      index(name "/", folder "/") != 1 || name ~ /(^|\/)\.\.(\/|$)/ {
        report("it contains files outside " folder)
      }
      { size += $3; if (size > most * 1e9) report("it would take more than " most " GB") }
      NR > 1000000 { report("it contains more than a million files") }
      END { if (!reported && NR == 0) print "it is empty" }'
}

check_archive() {
  local file=$1 folder=$2 fault code=0
  fault=$(find_fault "$file" "$folder") || code=$?
  [ -z "$fault" ] || [ "$fault" = "it is empty" ] || refuse "$PWD/$file" "$fault"
  if [ "$code" -ne 0 ]; then
    rm -f "$file"
    fail "$PWD/$file was damaged and has been deleted; run again to download it again"
  fi
  [ -z "$fault" ] || refuse "$PWD/$file" "$fault"
}

unpack() {
  local file=$1 folder=$2 work=$3 list
  check_sum "$file"
  check_archive "$file" "$folder"
  rm -rf "$work"
  mkdir "$work"
  if ! tar --extract --gzip --no-same-owner --no-same-permissions --file "$file" \
    --directory "$work"; then
    rm -rf "$work"
    fail "cannot unpack $PWD/$file; the archive is kept"
  fi
  for list in rgb.txt depth.txt groundtruth.txt; do
    if [ ! -s "$work/$folder/$list" ]; then
      rm -rf "$work"
      refuse "$PWD/$file" "it is not a TUM RGB-D sequence, as it has no $folder/$list"
    fi
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
checksums=$top/scripts/tum_sha256.txt
records=no
max_size=20
names=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help)
      print_help
      exit 0
      ;;
    --to | --base | --checksums | --max-size)
      [ -n "${2:-}" ] || usage_error "$1 needs a value"
      case "$1" in
        --to) to=$2 ;;
        --base) base=${2%/} ;;
        --checksums) checksums=$(realpath -m -- "$2") records=yes ;;
        --max-size) max_size=$2 ;;
      esac
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
[[ "$max_size" =~ ^[0-9]{1,6}(\.[0-9]{1,9})?$ ]] ||
  usage_error "--max-size is \"$max_size\"; expected a number of gigabytes"
[ "${#names[@]}" -gt 0 ] || usage_error "no SEQUENCE is given"
command -v curl >/dev/null || fail "curl is not installed; run scripts/setup.sh"
if [ "$records" = yes ]; then
  touch -- "$checksums" || fail "cannot write $checksums"
fi
[ -r "$checksums" ] || fail "cannot read $checksums"
mkdir -p -- "$to" || fail "cannot create the folder $to"
cd -- "$to" || fail "cannot use the folder $to"
for name in "${names[@]}"; do
  fetch "$name"
done
