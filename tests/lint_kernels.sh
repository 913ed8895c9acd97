#!/usr/bin/env bash
# Checks with clang every program that the stages build, with the options of every variant: the common files and its
# own. A kernel file that no program contains is an error too, and so is a kernel that uses local memory without
# reqd_work_group_size: drivers differ in what they count as its local memory.
#   lint_kernels.sh REPOSITORY LIST_PROGRAMS
set -euo pipefail
list_programs="$(realpath "$2")"
cd "$1"
programs="$("$list_programs" kernels)"
check() {  # OPTION... FILE...: what follows the last option are the files, of which the last one is compiled
  local arguments=() last="" word
  for word in $front; do arguments+=(-include "kernels/$word"); done
  for word in "$@"; do
    case "$word" in
      -D*) arguments+=("$word") ;;
      -*) ;;
      *)
        [ -n "$last" ] && arguments+=(-include "kernels/$last")
        last="$word"
        ;;
    esac
  done
  clang -x cl -cl-std=CL1.2 -target spir64 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra \
    -Wno-unused-function -Werror -D__OPENCL_VERSION__=120 "${arguments[@]}" "kernels/$last" ||
    { echo "failed: $*"; return 1; }
}
export -f check
front="common.cl"
[ -f kernels/layouts.cl ] && front+=" layouts.cl"
export front

status=0
echo "$programs"
# Each line holds the arguments of one program: options and files have no spaces.
xargs -P "$(nproc)" -d '\n' -n 1 bash -c 'set -f; check $1' _ <<<"$programs" || status=1
awk '/^kernel / { fixed = /^kernel ([A-Z_]+|__attribute__\(\(reqd_work_group_size.*) void/ }
  /^ +local / && !fixed { print FILENAME ":" FNR ": local memory without reqd_work_group_size"; bad = 1 }
  /^}/ { fixed = 1 }
  END { exit bad }' kernels/*.cl || status=1
for file in kernels/*.cl; do
  case " $front " in
    *" $(basename "$file") "*) ;;
    *) grep -qE " $(basename "$file")( |$)" <<<"$programs" || { echo "$file: no stage builds it"; status=1; } ;;
  esac
done
exit $status
