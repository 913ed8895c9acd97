#!/usr/bin/env bash
# Runs the small kernel tests on oclgrind's simulator, which checks every memory access. Fails if a test fails, if
# oclgrind reports anything (an invalid address, a data race, an invalid call), or if a kernel was never run: the same
# tests name their launches on the usual device, since oclgrind's own counter takes as long again as the check.
#   run_oclgrind.sh QUADEDGE_TESTS KERNEL_FOLDER LOST_DEVICE
set -euo pipefail
tests="$1" kernels="$2" preloaded="$3"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
status=0
env -u QUADEDGE_TEST_CACHE oclgrind --check-api --data-races --num-threads 1 --log "$folder/log" "$tests" "[oclgrind]" \
  >"$folder/out" || status=$?
cat "$folder/out"
if [ -s "$folder/log" ]; then
  echo "oclgrind reports:"
  head -100 "$folder/log"
  exit 1
fi
QUADEDGE_TEST_KERNELS="$folder/launched" LD_PRELOAD="$preloaded" "$tests" "[oclgrind]" >"$folder/out"
cat "$kernels"/*.cl | tr '\n' ' ' |
  grep -oE 'kernel +(__attribute__\(\([^;{]*\)\)\) +|[A-Z_]+ +)?void +[a-z_0-9]+' |
  sed 's/.* //' | sort -u >"$folder/all"
sort -u "$folder/launched" >"$folder/run"
never="$(comm -23 "$folder/all" "$folder/run")"
if [ -n "$never" ]; then
  echo "kernels that no [oclgrind] test runs:" $never
  exit 1
fi
echo "$(wc -l <"$folder/run") kernels ran"
exit $status
