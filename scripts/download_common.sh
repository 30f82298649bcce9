# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# What the scripts download_*.sh share: options, downloads that can be resumed, and checks of
# archives before they are unpacked. They source common.sh before this file.

# Says what an exit code of curl means, if the user can do something about it.
meaning() {
  case "$1" in
    6 | 7 | 28) printf 'curl: %d; is there a network connection?' "$1" ;;
    22) printf 'curl: 22; the server does not have this file' ;;
    23) printf 'curl: 23; the file cannot be written, is the disk full?' ;;
    *) printf 'curl: %d' "$1" ;;
  esac
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
      fail "the download of $url was interrupted ($(meaning "$code")); run again to resume it"
    fi
  fi
  if [ ! -s "$file.part" ]; then
    printf 'Downloading %s\n' "$url"
    curl "${options[@]}" "$url" || fail "cannot download $url ($(meaning $?)); run again to retry"
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
# folders and plain files, below the folder $2 unless that is empty, and not be too large.
find_fault() {
  LC_ALL=C tar --list --verbose --numeric-owner --absolute-names --gzip --file "$1" 2>/dev/null |
    awk -v folder="$2" -v most="$max_size" '
      function report(text) { print text; reported = 1; exit }
      # kind and rights, owner, size, date, time, name; a name may contain blanks
      { name = $0; for (i = 1; i < 6; ++i) sub(/^ *[^ ]+ /, "", name); sub(/^\.\//, "", name) }
      !/^[-d]/ { report("it contains links or special files") }
      (folder != "" && index(name "/", folder "/") != 1) || name ~ /^\/|(^|\/)\.\.(\/|$)/ {
        report("it contains files outside " (folder == "" ? "its own folder" : folder))
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

# Unpacks a checked archive into the new folder $3.
unpack_into() {
  local file=$1 folder=$2 work=$3
  check_sum "$file"
  check_archive "$file" "$folder"
  rm -rf "$work"
  mkdir "$work"
  if ! tar --extract --gzip --no-same-owner --no-same-permissions --file "$file" \
    --directory "$work"; then
    rm -rf "$work"
    fail "cannot unpack $PWD/$file; the archive is kept"
  fi
}

# Downloads the archive $1 from the URL $2 and unpacks its folder $3 (empty: all of it) as $4, which is $5
# and must have the files and folders $6.... `complete`, a function of the script, may add files.
fetch_sequence() {
  local file=$1 url=$2 inner=$3 folder=$4 kind=$5 needed
  local work=$folder.unpacking
  local made=$work${inner:+/$inner}
  [ -s "$file" ] || download "$url" "$file"
  unpack_into "$file" "$inner" "$work"
  for needed in "${@:6}"; do
    if [ ! -d "$made/$needed" ] && [ ! -s "$made/$needed" ]; then
      rm -rf "$work"
      refuse "$PWD/$file" "it is not $kind, as it has no ${inner:+$inner/}$needed"
    fi
  done
  complete "$made"
  mv "$made" "$folder"
  rm -rf "$work" "$file"
}

# Reads the options and the names, and calls fetch for each name as plain_name prints it, unless its
# folder, which folder_of prints, exists. The variables base and checksums have the defaults of the script.
# shellcheck disable=SC2034  # fetch uses base
download_all() {
  to=.
  records=no
  max_size=20
  names=()
  while [ $# -gt 0 ]; do
    help_if_asked "$1"
    case "$1" in
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
    if [ -d "$(folder_of "$name")" ]; then
      printf '%s exists already.\n' "$PWD/$(folder_of "$name")"
    else
      fetch "$name" "$(folder_of "$name")"
    fi
  done
}
