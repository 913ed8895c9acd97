#!/usr/bin/env bash
# clang checks every program that the stages build: common.cl, layouts.cl and the files of one program({...}) call, with the defaults of
# their compile-time parameters. A kernel file that no stage builds is an error too.
#   lint_kernels.sh REPOSITORY
set -euo pipefail
cd "$1"
status=0
used="common.cl layouts.cl"
while read -r files; do
  arguments=(-include kernels/common.cl -include kernels/layouts.cl)
  last=""
  for file in $files; do
    [ -n "$last" ] && arguments+=(-include "kernels/$last")
    last="$file"
  done
  used+=" $files"
  echo "common.cl layouts.cl $files"
  clang -x cl -cl-std=CL1.2 -target spir64 -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Wno-unused-function -Werror \
    "${arguments[@]}" "kernels/$last" || status=1
done < <(grep -rhoE 'program\(\{[^}]*\}' host | grep -oE '"[^{}]*"' | tr -d '",' | sort -u)
for file in kernels/*.cl; do
  case " $used " in
    *" $(basename "$file") "*) ;;
    *) echo "$file: no stage builds it"; status=1 ;;
  esac
done
exit $status
