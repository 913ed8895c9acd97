#!/usr/bin/env bash
# Checks format, structure, kernels and clang-tidy, as the tests do.
#   scripts/lint.sh           format and structure: seconds
#   scripts/lint.sh --all     clang-tidy and the kernels too: minutes; needs what scripts/test.sh builds
#   scripts/lint.sh --fix     formats all code; with --all, clang-tidy fixes what it can
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
fix="" all=""
for option in "$@"; do
  case "$option" in
    --fix) fix=yes ;;
    --all) all=yes ;;
    *) sed -n '2,5s/^# //p' "${BASH_SOURCE[0]}"; exit 2 ;;
  esac
done

status=0
python=build/venv/bin/python  # scripts/test.sh makes it
if [ ! -x "$python" ]; then
  python=python3
  python3 -c 'import lizard' 2>/dev/null || checks="includes lines twins references"
fi
if [ -n "$all" ] && [ -n "$fix" ]; then
  "$python" tests/lint_tidy.py . build --all --fix || status=1
fi
if [ -n "$fix" ]; then
  git ls-files -z '*.cpp' '*.hpp' '*.cl' | xargs -0 clang-format -i
else
  tests/lint_format.sh . || status=1
fi

# shellcheck disable=SC2086  # a list of words
"$python" tests/lint_structure.py . ${checks:-} || status=1
"$python" tests/lint_locale.py . || status=1

if [ -n "$all" ]; then
  tests/lint_kernels.sh . build/tests/list_programs || status=1
  [ -n "$fix" ] || "$python" tests/lint_tidy.py . build --all || status=1
fi
exit $status
