#!/usr/bin/env bash
# Runs the small kernel tests on oclgrind's simulator, which checks every memory access. Fails if a test fails, if
# oclgrind reports anything (an invalid address, a data race, an invalid call), or if a kernel was never run: a library
# preloaded before OpenCL's loader names the launches, since oclgrind's own counter takes as long again as the check.
#   run_oclgrind.sh QUADEDGE_TESTS KERNEL_FOLDER LOST_DEVICE
set -euo pipefail
tests="$1" kernels="$2" preloaded="$3" driver=/usr/lib/oclgrind/liboclgrind-rt-icd.so
[ -e "$driver" ] || { echo "$driver is missing; scripts/test.sh installs oclgrind"; exit 1; }
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
status=0
# What the command oclgrind does, but as the only driver of the loader: its own library would come before ours.
echo "$driver" >"$folder/oclgrind.icd"
OCL_ICD_VENDORS="$folder/oclgrind.icd" OCLGRIND_CHECK_API=1 OCLGRIND_DATA_RACES=1 OCLGRIND_NUM_THREADS=1 \
  OCLGRIND_LOG="$folder/log" QUADEDGE_TEST_KERNELS="$folder/launched" LD_PRELOAD="$preloaded" \
  "$tests" "[oclgrind]" || status=$?
if [ -s "$folder/log" ]; then
  echo "oclgrind reports:"
  head -100 "$folder/log"
  exit 1
fi
[ $status -eq 0 ] || exit $status
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
