# bash completion for quadedge, from the help that the program itself prints.
_quadedge() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} help words='' command=()
  ((COMP_CWORD > 1)) && command=("${COMP_WORDS[1]}")
  [[ ${COMP_WORDS[1]} == evaluate ]] && ((COMP_CWORD > 2)) && command+=("${COMP_WORDS[2]}")
  help=$("${COMP_WORDS[0]}" "${command[@]}" --help-all 2>/dev/null || "${COMP_WORDS[0]}" "${command[@]}" --help 2>/dev/null)
  if [[ $before == -* ]]; then  # the words that an option allows: --format auto|kitti=auto
    words=$(sed -nE "s/^ +(-[a-z],)?$before ([a-z0-9-]+(\|[a-z0-9-]+)+)(=.*)?\$/\2/p" <<<"$help" | tr '|' ' ')
  fi
  if [[ -z $words && $current == -* ]]; then
    words=$(sed -nE 's/^ +((-[a-z]),)?(--[a-z_.-]+).*/\2 \3/p' <<<"$help")
  elif [[ -z $words ]]; then
    words=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -o default -F _quadedge quadedge  # where there are no words, file names
