# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Completion of all programs of HullSLAM for bash. Options and commands are those of --help, and
# everything else is a file. bash-completion loads this file under the name of a program.

_hullslam() {
  local program=$1 word=$2 help usage
  # `hullslam evaluate` and `hullslam evaluate objects` have options and commands of their own.
  local commands=() i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ "${COMP_WORDS[i]}" =~ ^[a-z][a-z-]*$ ]] || break
    commands+=("${COMP_WORDS[i]}")
  done
  while ! help=$("$program" "${commands[@]}" --help 2>/dev/null); do
    [ "${#commands[@]}" -gt 0 ] || break
    unset "commands[-1]"
  done
  usage=$(grep -m 1 '^Usage:' <<<"$help")
  if [[ "$word" == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '--[a-z][a-z-]*' <<<"$help" | sort -u)" -- "$word")
  elif [ "$COMP_CWORD" -eq $((${#commands[@]} + 1)) ] && [[ "$usage" == *COMMAND* ]]; then
    # Commands are on indented lines below a heading that is not "Options:".
    mapfile -t COMPREPLY < <(compgen -W "$(awk '/^[A-Z].*:$/ {on = $0 != "Options:"; next} /^$/ {on = 0}
      on {print $1}' <<<"$help")" -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}

complete -F _hullslam "${BASH_SOURCE[0]##*/}"
