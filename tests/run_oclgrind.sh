#!/usr/bin/env bash
# Runs the small kernel tests on oclgrind's simulator, which checks every memory access. Fails if a test fails, if
# oclgrind reports anything (an invalid address, a data race, an invalid call), or if a kernel was never run.
#   run_oclgrind.sh QUADEDGE_TESTS KERNEL_FOLDER
set -euo pipefail
tests="$1" kernels="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
status=0
# Single-threaded, and the instructions are counted in a run of their own, which only shows which kernels ran: the
# counter of oclgrind 21.10 corrupts the heap with several threads and in tests that are tagged [uncounted], and what
# that run says of memory and results is not to be believed.
oclgrind --check-api --data-races --num-threads 1 --log "$folder/log" "$tests" "[oclgrind]" >"$folder/out" || status=$?
grep -avE "^Instructions executed|^ +[0-9,]+ - |^$" "$folder/out" || true
if [ -s "$folder/log" ]; then
  echo "oclgrind reports:"
  head -100 "$folder/log"
  exit 1
fi
oclgrind --inst-counts --num-threads 1 "$tests" "[oclgrind]~[uncounted]" >"$folder/out" 2>&1 || true
cat "$kernels"/*.cl | tr '\n' ' ' |
  grep -oE 'kernel +(__attribute__\(\([^;{]*\)\)\) +|[A-Z_]+ +)?void +[a-z_0-9]+' |
  sed 's/.* //' | sort -u >"$folder/all"
grep -aoE "^Instructions executed for kernel '[a-z_0-9]+'" "$folder/out" | cut -d"'" -f2 | sort -u >"$folder/run"
never="$(comm -23 "$folder/all" "$folder/run")"
if [ -n "$never" ]; then
  echo "kernels that no [oclgrind] test runs:" $never
  exit 1
fi
echo "$(wc -l <"$folder/run") kernels ran"
exit $status
