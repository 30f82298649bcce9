# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Functions for messages, help texts and named steps; the other shell scripts source this file.

# With CDPATH set, `cd` may go to another folder, and it prints the folder's name.
unset CDPATH
# shellcheck disable=SC2034  # the scripts that source this file use it
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
  printf 'error: %s\n' "$1" >&2
  exit 1
}

usage_error() {
  printf 'error: %s; see --help\n' "$1" >&2
  exit 2
}

# Prints the help text: the comment block below the SPDX line of the script that was called.
print_help() {
  awk 'NR > 2 && !/^#/ {exit} NR > 2 {sub(/^# ?/, ""); print}' "$0"
}

# Prints the help text and ends, if the argument asks for it.
help_if_asked() {
  if [ "${1:-}" = -h ] || [ "${1:-}" = --help ]; then
    print_help
    exit 0
  fi
}

# Reads the arguments of a script that only has --help.
read_no_arguments() {
  help_if_asked "$@"
  [ -z "${1:-}" ] || usage_error "unknown argument \"$1\""
}

# Reads the arguments "[FOLDER]" of a script. The variable folder has the default before, and FOLDER
# after it is given.
# shellcheck disable=SC2034  # the scripts that source this file use it
read_folder() {
  case "${1:-}" in
    "" | -*) read_no_arguments "$@" ;;
    *) folder=$1 ;;
  esac
}

# Announces a step. If the script fails before the next step, the error message names this step.
step() {
  current_step="$1"
  trap report_failed_step EXIT
  printf '== %s\n' "$1"
}

report_failed_step() {
  local code=$?
  if [ "$code" -ne 0 ]; then
    printf 'error: step "%s" failed with exit code %d\n' "$current_step" "$code" >&2
  fi
}
