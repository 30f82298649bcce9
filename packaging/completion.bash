# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Completion of all programs of HullSLAM for bash. Options and subcommands are those of --help, and
# everything else is a file. bash-completion loads this file under the name of a program.

_hullslam() {
  local program=$1 word=$2 help
  # `evaluate objects` and the like have options of their own.
  local subcommand=()
  if [ "$COMP_CWORD" -gt 1 ] && [[ "${COMP_WORDS[1]}" =~ ^[a-z]+$ ]]; then
    subcommand=("${COMP_WORDS[1]}")
  fi
  help=$("$program" "${subcommand[@]}" --help 2>/dev/null) || help=$("$program" --help 2>/dev/null)
  if [[ "$word" == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '--[a-z][a-z-]*' <<<"$help" | sort -u)" -- "$word")
  elif [ "$COMP_CWORD" -eq 1 ] && [[ "$help" == *Subcommands:* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(awk '/^Subcommands:/ {on = 1; next} /^$/ {on = 0}
      on {print $1}' <<<"$help")" -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}

complete -F _hullslam "${BASH_SOURCE[0]##*/}"
