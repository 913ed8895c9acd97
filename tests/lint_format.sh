#!/usr/bin/env bash
# clang-format leaves every tracked C++ file and kernel as it is. `scripts/lint.sh --fix` applies it.
#   lint_format.sh REPOSITORY
set -euo pipefail
cd "$1"
git ls-files -z '*.cpp' '*.hpp' '*.cl' |
  xargs -0 -P "$(nproc)" -n 32 clang-format --dry-run --Werror
