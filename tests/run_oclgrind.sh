#!/usr/bin/env bash
# Runs the kernel tests of small size on oclgrind's simulator, which sees every memory access. Fails when a test fails or when
# oclgrind reports anything: a wrong address, a data race, a wrong call.
#   run_oclgrind.sh QUADEDGE_TESTS
set -euo pipefail
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
status=0
oclgrind --check-api --data-races --log "$log" "$1" "[oclgrind]" || status=$?
if [ -s "$log" ]; then
  echo "oclgrind reports:"
  head -100 "$log"
  exit 1
fi
exit $status
