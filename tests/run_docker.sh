#!/usr/bin/env bash
# Builds the container of the Dockerfile and runs the program in it; skipped (exit code 77) without a container engine.
#   run_docker.sh REPOSITORY
set -euo pipefail
repository="$1"
for engine in docker podman none; do
  if [ "$engine" = none ]; then
    echo "SKIPPED: neither docker nor podman can run containers here"
    exit 77
  fi
  "$engine" info >/dev/null 2>&1 && break
done
"$engine" build --tag quadedge-test:source --target source "$repository"
"$engine" build --tag quadedge-test "$repository"
"$engine" run --rm quadedge-test demo --size 320x200 --frames 2
"$engine" run --rm --entrypoint python quadedge-test -c 'import quadedge; assert quadedge.devices()'
"$engine" run --rm quadedge-test:source scripts/run.sh --help
"$engine" image rm quadedge-test quadedge-test:source >/dev/null
