#!/usr/bin/env bash
# Checks that clang-format changes no C++ file or kernel. `scripts/lint.sh --fix` applies it.
#   lint_format.sh REPOSITORY
set -euo pipefail
cd "$1"
git ls-files -z '*.cpp' '*.hpp' '*.cl' |
  xargs -0 -P "$(nproc)" -n 32 clang-format --dry-run --Werror
